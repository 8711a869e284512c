#include "server/jobs/sqlite_job_store.hpp"

#include <SQLiteCpp/SQLiteCpp.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <string>

#include "server/jobs/sqlite_schema.hpp"

namespace symcell::server {
namespace {

// Most that the clock of the store goes on between two servers. A machine whose clock was set a month
// ahead would else take every job for a month old; so jobs of a server that was down for longer are
// kept for longer.
constexpr std::int64_t kMostDownMs = std::int64_t{24} * 3600 * 1000;
// How long a look at the store's health waits for those that write.
constexpr std::chrono::milliseconds kHealthPatience{250};

constexpr const char* kColumns =
    "sequence, id, state, created_ms, started_ms, finished_ms, model_format, model_name, "
    "options_json, error_code, error_json, model_bytes, result_bytes, lost_workers, "
    "finished_clock_ms, model_sha256, statistics_sha256, client, weight, attempt, "
    "owner, most_running, model_kept, request_id, traceparent, webhook";

// The waiting job whose turn it is, of those whose client may run one more.
constexpr const char* kWhoseTurn =
    " FROM jobs AS j INDEXED BY jobs_waiting WHERE j.state = 'queued' AND (j.most_running = 0 OR "
    "j.most_running > (SELECT COUNT(*) FROM jobs AS r INDEXED BY jobs_running_by_client "
    "WHERE r.state = 'running' AND r.client = j.client)) ORDER BY j.turn, j.sequence LIMIT 1";

std::int64_t day_of(std::int64_t ms) {
  constexpr std::int64_t kDayMs = std::int64_t{24} * 3600 * 1000;
  return ms / kDayMs;
}

// Commits that a power failure may undo: a start that is lost leaves its job queued, as a start of the
// server would anyhow. Whatever is committed after it makes it last.
class Unsynchronised {
 public:
  explicit Unsynchronised(SQLite::Database& database) : database_(database) {
    database_.exec("PRAGMA synchronous = NORMAL");
  }
  ~Unsynchronised() {
    // Cannot fail: it sets a flag of the connection.
    database_.tryExec("PRAGMA synchronous = FULL");
  }
  Unsynchronised(const Unsynchronised&) = delete;
  Unsynchronised& operator=(const Unsynchronised&) = delete;

 private:
  SQLite::Database& database_;
};

std::string format_name(ModelFormat format) {
  return std::string(model_format_info(format).name);
}

ModelFormat format_from_name(const std::string& name) {
  if (const auto format = model_format_of_name(name)) return *format;
  throw std::runtime_error("the job database holds an unknown model format: " + name);
}

std::optional<std::int64_t> optional_time(const SQLite::Column& column) {
  if (column.isNull()) return std::nullopt;
  return column.getInt64();
}

Job read_job(SQLite::Statement& row) {
  Job job;
  job.sequence = row.getColumn(0).getInt64();
  job.id = row.getColumn(1).getString();
  const auto state = job_state_from_name(row.getColumn(2).getString());
  if (!state) throw std::runtime_error("the job database holds an unknown state");
  job.state = *state;
  job.created_ms = row.getColumn(3).getInt64();
  job.started_ms = optional_time(row.getColumn(4));
  job.finished_ms = optional_time(row.getColumn(5));
  job.model_format = format_from_name(row.getColumn(6).getString());
  job.model_name = row.getColumn(7).getString();
  job.options_json = row.getColumn(8).getString();
  job.error_code = row.getColumn(9).getString();
  job.error_json = row.getColumn(10).getString();
  job.model_bytes = row.getColumn(11).getInt64();
  job.result_bytes = row.getColumn(12).getInt64();
  job.lost_workers = row.getColumn(13).getInt();
  job.finished_clock_ms = optional_time(row.getColumn(14));
  job.model_sha256 = row.getColumn(15).getString();
  job.statistics_sha256 = row.getColumn(16).getString();
  job.client = row.getColumn(17).getString();
  job.weight = row.getColumn(18).getInt();
  job.attempt = row.getColumn(19).getInt();
  job.owner = row.getColumn(20).getString();
  job.most_running = row.getColumn(21).getInt64();
  job.model_kept = row.getColumn(22).getInt() != 0;
  job.request_id = row.getColumn(23).getString();
  job.traceparent = row.getColumn(24).getString();
  job.webhook = row.getColumn(25).getString();
  return job;
}

std::vector<Job> read_jobs(SQLite::Statement& query) {
  std::vector<Job> jobs;
  while (query.executeStep()) jobs.push_back(read_job(query));
  return jobs;
}

}  // namespace

struct SqliteJobStore::Impl {
  Impl(const std::filesystem::path& file, const std::string& directory_id, MachineClocks machine)
      : clocks(std::move(machine)),
        database(create_job_database(file).string(),
                 SQLite::OPEN_READWRITE | SQLite::OPEN_NOFOLLOW),
        reader(file.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_NOFOLLOW) {
    reader.setBusyTimeout(kSqliteBusyPatienceMs);
    database.setBusyTimeout(kSqliteBusyPatienceMs);
    database.exec("PRAGMA journal_mode = WAL");
    // FULL: a commit is on the disk when it returns; an accepted job is never lost.
    database.exec("PRAGMA synchronous = FULL");
    database.exec("PRAGMA foreign_keys = ON");
    migrate_job_database(database);
    load_totals();
    start_clock();
    if (directory_id.empty()) return;
    SQLite::Statement name(
        database, "INSERT OR IGNORE INTO properties (name, value) VALUES ('directory_id', ?)");
    name.bind(1, directory_id);
    name.exec();
  }

  // Runs `work` with the connection that writes, one at a time.
  template <class Work>
  auto write(const Work& work) {
    const std::lock_guard lock(writing);
    return translate_sqlite_errors([&] { return work(database); });
  }
  // The same with the connection that reads: a write that waits for a lock holds nobody up.
  template <class Work>
  auto read(const Work& work) {
    const std::lock_guard lock(reading);
    return translate_sqlite_errors([&] { return work(reader); });
  }

  void set_property(const char* name, std::int64_t value) {
    SQLite::Statement set(database,
                          "INSERT INTO properties (name, value) VALUES (?, ?) "
                          "ON CONFLICT (name) DO UPDATE SET value = excluded.value");
    set.bind(1, name);
    set.bind(2, std::to_string(value));
    set.exec();
  }

  [[nodiscard]] std::optional<std::int64_t> property(const char* name) {
    SQLite::Statement query(database,
                            "SELECT CAST(value AS INTEGER) FROM properties WHERE name = ?");
    query.bind(1, name);
    if (!query.executeStep()) return std::nullopt;
    return query.getColumn(0).getInt64();
  }

  void start_clock() {
    const auto noted = property("clock_ms");
    const auto wall = property("clock_noted_at_ms");
    const std::int64_t now = clocks.wall();
    const std::int64_t down = wall ? std::clamp<std::int64_t>(now - *wall, 0, kMostDownMs) : 0;
    clock_base = noted ? *noted + down : now;
    steady_base = clocks.steady();
    note_clock();
  }

  [[nodiscard]] std::int64_t clock_ms() const {
    return clock_base + (clocks.steady() - steady_base);
  }

  void note_clock() {
    set_property("clock_ms", clock_ms());
    set_property("clock_noted_at_ms", clocks.wall());
  }

  const MachineClocks clocks;
  std::int64_t clock_base = 0;  // at steady_base
  std::int64_t steady_base = 0;

  // Counted once, and from then on with every change: a count over all jobs for every job that comes
  // would cost the more the more are stored.
  void load_totals() {
    SQLite::Statement query(database,
                            "SELECT state, COUNT(*), SUM(model_bytes + result_bytes) FROM jobs "
                            "GROUP BY state");
    while (query.executeStep()) {
      const auto state = job_state_from_name(query.getColumn(0).getString());
      if (!state) throw std::runtime_error("the job database holds an unknown state");
      totals.by_state[static_cast<std::size_t>(*state)] = query.getColumn(1).getInt64();
      totals.bytes += query.getColumn(2).getInt64();
    }
  }

  // `bytes`: of model and results.
  void count(JobState state, std::int64_t jobs, std::int64_t bytes) {
    const std::lock_guard lock(counting);
    totals.by_state[static_cast<std::size_t>(state)] += jobs;
    totals.bytes += bytes;
  }

  [[nodiscard]] std::int64_t queued() {
    const std::lock_guard lock(counting);
    return totals.by_state[static_cast<std::size_t>(JobState::kQueued)];
  }

  static ClientUsage usage(SQLite::Database& database,
                           std::string_view client,
                           std::int64_t time_ms) {
    SQLite::Statement query(
        database,
        "SELECT (SELECT COUNT(*) FROM jobs INDEXED BY jobs_waiting_by_client "
        "WHERE state = 'queued' AND client = ?1), "
        "(SELECT COUNT(*) FROM jobs INDEXED BY jobs_running_by_client "
        "WHERE state = 'running' AND client = ?1), "
        "COALESCE((SELECT bytes FROM key_usage WHERE owner = ?1 AND day = ?2), 0), "
        "COALESCE((SELECT jobs FROM key_usage WHERE owner = ?1 AND day = ?2), 0)");
    query.bind(1, std::string(client));
    query.bind(2, day_of(time_ms));
    query.executeStep();
    return {.queued = query.getColumn(0).getInt64(),
            .running = query.getColumn(1).getInt64(),
            .bytes_today = query.getColumn(2).getInt64(),
            .jobs_today = query.getColumn(3).getInt64()};
  }

  // Counts the job's bytes; false: that would be more than the day has.
  static bool spend(SQLite::Database& database, const Job& job, std::int64_t bytes_per_day) {
    const ClientUsage used = usage(database, job.owner, job.created_ms);
    if (job.model_bytes > bytes_per_day - used.bytes_today) return false;
    SQLite::Statement count(database,
                            "INSERT INTO key_usage (owner, day, jobs, bytes) VALUES (?, ?, 1, ?) "
                            "ON CONFLICT (owner, day) DO UPDATE SET jobs = jobs + 1, "
                            "bytes = bytes + excluded.bytes");
    count.bind(1, job.owner);
    count.bind(2, day_of(job.created_ms));
    count.bind(3, job.model_bytes);
    count.exec();
    return true;
  }

  // Turns are times of a virtual clock (start-time fair queueing): it stands at the turn of the job
  // started last, and a client's next job comes 1 / weight after its last one, or after the clock.
  // So who asked for little is served before the long queue of another.
  static double next_turn(SQLite::Database& database, const std::string& client, int weight) {
    SQLite::Statement query(
        database,
        "SELECT MAX(COALESCE("
        "(SELECT MAX(turn) FROM jobs INDEXED BY jobs_running WHERE state = 'running'), "
        "(SELECT MIN(turn) FROM jobs INDEXED BY jobs_waiting WHERE state = 'queued'), 0), "
        "COALESCE((SELECT MAX(turn) FROM jobs INDEXED BY jobs_waiting_by_client "
        "WHERE state = 'queued' AND client = ?), 0))");
    query.bind(1, client);
    query.executeStep();
    return query.getColumn(0).getDouble() + 1.0 / std::max(1, weight);
  }

  std::mutex counting;  // guards `totals`
  StoreTotals totals;

  std::timed_mutex writing;  // guards `database`
  SQLite::Database database;
  std::mutex reading;  // guards `reader`
  SQLite::Database reader;

  static std::optional<Job> find(SQLite::Database& database, std::string_view id) {
    SQLite::Statement query(database,
                            std::string("SELECT ") + kColumns + " FROM jobs WHERE id = ?");
    query.bind(1, std::string(id));
    if (!query.executeStep()) return std::nullopt;
    return read_job(query);
  }

  static std::optional<InsertOutcome> known_key(SQLite::Database& database,
                                                const IdempotencyKey& key) {
    SQLite::Statement query(
        database, "SELECT digest, job_id FROM idempotency_keys WHERE owner = ? AND key = ?");
    query.bind(1, key.owner);
    query.bind(2, key.key);
    if (!query.executeStep()) return std::nullopt;
    const bool same = query.getColumn(0).getString() == key.digest;
    const auto job = find(database, query.getColumn(1).getString());
    if (!job) throw std::runtime_error("an idempotency key without its job");
    return InsertOutcome{same ? InsertResult::kReplayed : InsertResult::kConflict, *job};
  }
};

SqliteJobStore::SqliteJobStore(const std::filesystem::path& file,
                               const std::string& directory_id,
                               MachineClocks clocks)
    : impl_(std::make_unique<Impl>(file, directory_id, std::move(clocks))) {
}

SqliteJobStore::~SqliteJobStore() = default;

InsertOutcome SqliteJobStore::insert(const Job& job,
                                     const std::optional<IdempotencyKey>& key,
                                     const Admission& admission) {
  return impl_->write([&](SQLite::Database& database) -> InsertOutcome {
    SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
    if (key) {
      if (auto known = Impl::known_key(database, *key)) return *known;
    }
    if (impl_->queued() >= admission.queued ||
        Impl::usage(database, job.client, job.created_ms).queued >= admission.queued_of_client) {
      return {InsertResult::kQueueFull, {}};
    }
    if (!job.owner.empty() && !Impl::spend(database, job, admission.bytes_per_day)) {
      return {InsertResult::kBytesSpent, {}};
    }
    SQLite::Statement insert(database,
                             "INSERT INTO jobs (id, state, created_ms, model_format, model_name, "
                             "options_json, model_bytes, model_sha256, client, weight, turn, "
                             "owner, most_running, request_id, traceparent, webhook) "
                             "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    insert.bind(1, job.id);
    insert.bind(2, std::string(job_state_name(job.state)));
    insert.bind(3, job.created_ms);
    insert.bind(4, format_name(job.model_format));
    insert.bind(5, job.model_name);
    insert.bind(6, job.options_json);
    insert.bind(7, job.model_bytes);
    insert.bind(8, job.model_sha256);
    insert.bind(9, job.client);
    insert.bind(10, job.weight);
    insert.bind(11, Impl::next_turn(database, job.client, job.weight));
    insert.bind(12, job.owner);
    insert.bind(13, job.most_running);
    insert.bind(14, job.request_id);
    insert.bind(15, job.traceparent);
    insert.bind(16, job.webhook);
    insert.exec();
    Job stored = job;
    stored.sequence = database.getLastInsertRowid();
    if (key) {
      SQLite::Statement remember(
          database,
          "INSERT INTO idempotency_keys (owner, key, digest, job_id) VALUES (?, ?, ?, ?)");
      remember.bind(1, key->owner);
      remember.bind(2, key->key);
      remember.bind(3, key->digest);
      remember.bind(4, job.id);
      remember.exec();
    }
    transaction.commit();
    impl_->count(job.state, 1, job.model_bytes);
    return {InsertResult::kInserted, stored};
  });
}

ClientUsage SqliteJobStore::usage(std::string_view client, std::int64_t time_ms) {
  return impl_->read(
      [&](SQLite::Database& database) { return Impl::usage(database, client, time_ms); });
}

std::optional<Job> SqliteJobStore::claim(std::int64_t time_ms) {
  return impl_->write([&](SQLite::Database& database) -> std::optional<Job> {
    if (impl_->queued() == 0) return std::nullopt;
    const Unsynchronised fast(database);
    SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
    SQLite::Statement query(database, std::string("SELECT ") + kColumns + kWhoseTurn);
    if (!query.executeStep()) return std::nullopt;
    Job job = read_job(query);
    job.state = JobState::kRunning;
    job.started_ms = std::max(time_ms, job.created_ms);
    ++job.attempt;
    SQLite::Statement start(
        database, "UPDATE jobs SET state = 'running', started_ms = ?, attempt = ? WHERE id = ?");
    start.bind(1, *job.started_ms);
    start.bind(2, job.attempt);
    start.bind(3, job.id);
    start.exec();
    query.reset();
    transaction.commit();
    impl_->count(JobState::kQueued, -1, 0);
    impl_->count(JobState::kRunning, 1, 0);
    return job;
  });
}

std::optional<InsertOutcome> SqliteJobStore::find_key(const IdempotencyKey& key) {
  return impl_->read([&](SQLite::Database& database) { return Impl::known_key(database, key); });
}

std::optional<Job> SqliteJobStore::find(std::string_view id) {
  return impl_->read([&](SQLite::Database& database) { return Impl::find(database, id); });
}

std::vector<Job> SqliteJobStore::list(const JobFilter& filter) {
  std::string sql = std::string("SELECT ") + kColumns + " FROM jobs WHERE sequence < ?";
  if (filter.state) sql += " AND state = ?";
  if (filter.owner) sql += " AND owner = ?";
  sql += " ORDER BY sequence DESC LIMIT " + std::to_string(filter.limit);
  return impl_->read([&](SQLite::Database& database) {
    SQLite::Statement query(database, sql);
    query.bind(1, filter.before_sequence.value_or(std::numeric_limits<std::int64_t>::max()));
    int next = 2;
    if (filter.state) query.bind(next++, std::string(job_state_name(*filter.state)));
    if (filter.owner) query.bind(next, *filter.owner);
    return read_jobs(query);
  });
}

std::vector<Job> SqliteJobStore::unfinished() {
  return impl_->read([&](SQLite::Database& database) {
    SQLite::Statement query(
        database, std::string("SELECT ") + kColumns +
                      " FROM jobs WHERE state IN ('queued', 'running') ORDER BY sequence");
    return read_jobs(query);
  });
}

std::vector<Job> SqliteJobStore::oldest_finished(std::size_t limit) {
  return impl_->read([&](SQLite::Database& database) {
    SQLite::Statement query(database, std::string("SELECT ") + kColumns +
                                          " FROM jobs WHERE finished_clock_ms IS NOT NULL ORDER BY "
                                          "finished_clock_ms, sequence LIMIT " +
                                          std::to_string(limit));
    return read_jobs(query);
  });
}

std::optional<Job> SqliteJobStore::apply(std::string_view id,
                                         JobEvent event,
                                         const JobChange& change) {
  return impl_->write([&](SQLite::Database& database) -> std::optional<Job> {
    SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
    auto job = Impl::find(database, id);
    if (!job) return std::nullopt;
    const auto next = next_state(job->state, event);
    if (!next || (change.attempt && *change.attempt != job->attempt)) return std::nullopt;
    const JobState state_before = job->state;
    const std::int64_t bytes_before = job->result_bytes;
    job->state = *next;
    if (event == JobEvent::kStart) {
      job->started_ms = std::max(change.time_ms, job->created_ms);
      ++job->attempt;
    }
    if (event == JobEvent::kRequeue) job->started_ms.reset();
    if (is_finished(*next)) {
      job->finished_ms = std::max(change.time_ms, job->started_ms.value_or(job->created_ms));
      job->finished_clock_ms = impl_->clock_ms();
    }
    job->error_code = change.error_code;
    job->error_json = change.error_json;
    job->result_bytes = change.result_bytes;
    job->statistics_sha256 = change.statistics_sha256;

    SQLite::Statement update(database,
                             "UPDATE jobs SET state = ?, started_ms = ?, finished_ms = ?, "
                             "error_code = ?, error_json = ?, result_bytes = ?, "
                             "finished_clock_ms = ?, statistics_sha256 = ?, attempt = ? "
                             "WHERE id = ?");
    update.bind(1, std::string(job_state_name(job->state)));
    if (job->started_ms) update.bind(2, *job->started_ms);
    if (job->finished_ms) update.bind(3, *job->finished_ms);
    update.bind(4, job->error_code);
    update.bind(5, job->error_json);
    update.bind(6, job->result_bytes);
    if (job->finished_clock_ms) update.bind(7, *job->finished_clock_ms);
    update.bind(8, job->statistics_sha256);
    update.bind(9, job->attempt);
    update.bind(10, job->id);
    update.exec();
    if (is_finished(*next) && !job->webhook.empty()) {
      SQLite::Statement tell(database,
                             "INSERT INTO deliveries (job_id, tries, due_ms) VALUES (?, 0, ?)");
      tell.bind(1, job->id);
      tell.bind(2, impl_->clock_ms());
      tell.exec();
    }
    transaction.commit();
    impl_->count(state_before, -1, 0);
    impl_->count(job->state, 1, job->result_bytes - bytes_before);
    return job;
  });
}

std::optional<std::int64_t> SqliteJobStore::oldest_waiting_ms() {
  return impl_->read([&](SQLite::Database& database) -> std::optional<std::int64_t> {
    SQLite::Statement query(
        database, "SELECT created_ms FROM jobs WHERE state = 'queued' ORDER BY sequence LIMIT 1");
    if (!query.executeStep()) return std::nullopt;
    return query.getColumn(0).getInt64();
  });
}

std::vector<Job> SqliteJobStore::spent_models(std::int64_t before_clock_ms, std::size_t limit) {
  return impl_->read([&](SQLite::Database& database) {
    SQLite::Statement query(
        database, std::string("SELECT ") + kColumns +
                      " FROM jobs INDEXED BY jobs_with_spent_models WHERE state IN ('failed', "
                      "'cancelled') AND model_kept = 1 AND finished_clock_ms < ? ORDER BY "
                      "finished_clock_ms LIMIT " +
                      std::to_string(limit));
    query.bind(1, before_clock_ms);
    return read_jobs(query);
  });
}

void SqliteJobStore::forget_model(std::string_view id) {
  impl_->write([&](SQLite::Database& database) {
    SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
    const auto job = Impl::find(database, id);
    if (!job || !job->model_kept) return;
    SQLite::Statement update(database,
                             "UPDATE jobs SET model_kept = 0, model_bytes = 0 WHERE id = ?");
    update.bind(1, std::string(id));
    update.exec();
    transaction.commit();
    impl_->count(job->state, 0, -job->model_bytes);
  });
}

std::optional<Delivery> SqliteJobStore::claim_delivery(std::chrono::milliseconds patience) {
  return impl_->write([&](SQLite::Database& database) -> std::optional<Delivery> {
    SQLite::Transaction transaction(database, SQLite::TransactionBehavior::DEFERRED);
    SQLite::Statement query(
        database,
        "SELECT d.job_id, j.webhook, d.tries FROM deliveries AS d JOIN jobs AS j "
        "ON j.id = d.job_id WHERE d.due_ms <= ? ORDER BY d.due_ms LIMIT 1");
    query.bind(1, impl_->clock_ms());
    if (!query.executeStep()) return std::nullopt;
    Delivery delivery{query.getColumn(0).getString(), query.getColumn(1).getString(),
                      query.getColumn(2).getInt()};
    query.reset();
    SQLite::Statement update(database, "UPDATE deliveries SET due_ms = ? WHERE job_id = ?");
    update.bind(1, impl_->clock_ms() + patience.count());
    update.bind(2, delivery.job_id);
    update.exec();
    transaction.commit();
    return delivery;
  });
}

void SqliteJobStore::delivered(std::string_view job_id) {
  impl_->write([&](SQLite::Database& database) {
    SQLite::Statement done(database, "DELETE FROM deliveries WHERE job_id = ?");
    done.bind(1, std::string(job_id));
    done.exec();
  });
}

void SqliteJobStore::delivery_failed(std::string_view job_id,
                                     std::optional<std::chrono::milliseconds> pause) {
  if (!pause) return delivered(job_id);
  impl_->write([&](SQLite::Database& database) {
    SQLite::Statement again(database,
                            "UPDATE deliveries SET tries = tries + 1, due_ms = ? WHERE job_id = ?");
    again.bind(1, impl_->clock_ms() + pause->count());
    again.bind(2, std::string(job_id));
    again.exec();
  });
}

void SqliteJobStore::count_lost_worker(std::string_view id) {
  impl_->write([&](SQLite::Database& database) {
    SQLite::Statement update(database,
                             "UPDATE jobs SET lost_workers = lost_workers + 1 WHERE id = ?");
    update.bind(1, std::string(id));
    update.exec();
  });
}

bool SqliteJobStore::erase(std::string_view id) {
  return impl_->write([&](SQLite::Database& database) {
    SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
    const auto job = Impl::find(database, id);
    if (!job) return false;
    SQLite::Statement erase(database, "DELETE FROM jobs WHERE id = ?");
    erase.bind(1, std::string(id));
    erase.exec();
    SQLite::Statement remember(database, "INSERT OR IGNORE INTO erased (id) VALUES (?)");
    remember.bind(1, std::string(id));
    remember.exec();
    transaction.commit();
    impl_->count(job->state, -1, -(job->model_bytes + job->result_bytes));
    return true;
  });
}

bool SqliteJobStore::was_erased(std::string_view id) {
  return impl_->read([&](SQLite::Database& database) {
    SQLite::Statement query(database, "SELECT 1 FROM erased WHERE id = ?");
    query.bind(1, std::string(id));
    return query.executeStep();
  });
}

std::int64_t SqliteJobStore::tidy(std::int64_t mark) {
  return impl_->write([&](SQLite::Database& database) {
    SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
    SQLite::Statement forget(database, "DELETE FROM erased WHERE rowid <= ?");
    forget.bind(1, mark);
    forget.exec();
    // Days that no limit looks at any more.
    constexpr std::int64_t kDaysKept = 40;
    SQLite::Statement old(database, "DELETE FROM key_usage WHERE day < ?");
    old.bind(1, day_of(impl_->clocks.wall()) - kDaysKept);
    old.exec();
    impl_->note_clock();
    const std::int64_t newest =
        database.execAndGet("SELECT COALESCE(MAX(rowid), 0) FROM erased").getInt64();
    transaction.commit();
    return newest;
  });
}

std::int64_t SqliteJobStore::clock_ms() {
  return impl_->clock_ms();
}

StoreTotals SqliteJobStore::totals() {
  const std::lock_guard lock(impl_->counting);
  return impl_->totals;
}

void SqliteJobStore::check_health() {
  impl_->read([](SQLite::Database& database) {
    static_cast<void>(database.execAndGet("SELECT COUNT(*) FROM (SELECT 1 FROM jobs LIMIT 1)"));
  });
  std::unique_lock lock(impl_->writing, kHealthPatience);
  if (!lock) throw StoreError(StoreError::Kind::kBusy, "writes to the job database do not end");
  translate_sqlite_errors([&] {
    SQLite::Database& database = impl_->database;
    // Whoever asks wants to know now, not to wait until it is well again.
    database.setBusyTimeout(0);
    try {
      database.exec(
          "INSERT INTO properties (name, value) VALUES ('probe', '0') "
          "ON CONFLICT (name) DO UPDATE SET value = 1 - value");
    } catch (...) {
      database.setBusyTimeout(kSqliteBusyPatienceMs);
      throw;
    }
    database.setBusyTimeout(kSqliteBusyPatienceMs);
  });
}

}  // namespace symcell::server
