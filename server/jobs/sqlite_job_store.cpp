#include "server/jobs/sqlite_job_store.hpp"

#include <SQLiteCpp/SQLiteCpp.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <string>

#include "server/jobs/sqlite_connection.hpp"
#include "server/jobs/sqlite_log.hpp"
#include "server/jobs/sqlite_rows.hpp"
#include "server/jobs/sqlite_schema.hpp"

namespace symcell::server {
namespace {

// Most that the clock of the store goes on between two servers. A machine whose clock was set a month
// ahead would else take every job for a month old; so jobs of a server that was down for longer are
// kept for longer.
constexpr std::int64_t kMostDownMs = std::int64_t{24} * 3600 * 1000;
// How long a look at the store's health waits for those that write.
constexpr std::chrono::milliseconds kHealthPatience{250};

// The waiting job whose turn it is, of those whose client may run one more.
constexpr const char* kWhoseTurn =
    " FROM jobs AS j INDEXED BY jobs_waiting WHERE j.state = 'queued' AND (j.most_running = 0 OR "
    "j.most_running > (SELECT COUNT(*) FROM jobs AS r INDEXED BY jobs_running_by_client "
    "WHERE r.state = 'running' AND r.client = j.client)) ORDER BY j.turn, j.sequence LIMIT 1";

std::int64_t day_of(std::int64_t ms) {
  constexpr std::int64_t kDayMs = std::int64_t{24} * 3600 * 1000;
  return ms / kDayMs;
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
    // A commit goes to the log alone; `wal` puts it on the disk, for all who wait together.
    database.exec("PRAGMA synchronous = NORMAL");
    database.exec("PRAGMA foreign_keys = ON");
    migrate_job_database(database);
    load_totals();
    start_clock();
    name_directory(directory_id);
    wal = std::make_unique<SqliteLog>(file, database);
    wal->reach();
  }

  void name_directory(const std::string& directory_id) {
    if (directory_id.empty()) return;
    Prepared name(database,
                  "INSERT OR IGNORE INTO properties (name, value) VALUES ('directory_id', ?)");
    name.bind(1, directory_id);
    name.exec();
  }

  // Runs `work` with the connection that writes, one at a time. What it commits lasts only from the next
  // make_durable() on.
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
    Prepared set(database,
                 "INSERT INTO properties (name, value) VALUES (?, ?) "
                 "ON CONFLICT (name) DO UPDATE SET value = excluded.value");
    set.bind(1, name);
    set.bind(2, std::to_string(value));
    set.exec();
  }

  [[nodiscard]] std::optional<std::int64_t> property(const char* name) {
    Prepared query(database, "SELECT CAST(value AS INTEGER) FROM properties WHERE name = ?");
    query.bind(1, name);
    if (!query.step()) return std::nullopt;
    return query.column(0).getInt64();
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
    Prepared query(database,
                   "SELECT state, COUNT(*), SUM(model_bytes + result_bytes) FROM jobs "
                   "GROUP BY state");
    while (query.step()) {
      const auto state = job_state_from_name(query.column(0).getString());
      if (!state) throw std::runtime_error("the job database holds an unknown state");
      totals.by_state[static_cast<std::size_t>(*state)] = query.column(1).getInt64();
      totals.bytes += query.column(2).getInt64();
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

  static ClientUsage usage(SqliteConnection& database,
                           std::string_view client,
                           std::int64_t time_ms) {
    Prepared query(database,
                   "SELECT (SELECT COUNT(*) FROM jobs INDEXED BY jobs_waiting_by_client "
                   "WHERE state = 'queued' AND client = ?1), "
                   "(SELECT COUNT(*) FROM jobs INDEXED BY jobs_running_by_client "
                   "WHERE state = 'running' AND client = ?1), "
                   "COALESCE((SELECT bytes FROM key_usage WHERE owner = ?1 AND day = ?2), 0), "
                   "COALESCE((SELECT jobs FROM key_usage WHERE owner = ?1 AND day = ?2), 0)");
    query.bind(1, std::string(client));
    query.bind(2, day_of(time_ms));
    query.step();
    return {.queued = query.column(0).getInt64(),
            .running = query.column(1).getInt64(),
            .bytes_today = query.column(2).getInt64(),
            .jobs_today = query.column(3).getInt64()};
  }

  // Counts the job's bytes; false: that would be more than the day has.
  static bool spend(SqliteConnection& database, const Job& job, std::int64_t bytes_per_day) {
    const ClientUsage used = usage(database, job.owner, job.created_ms);
    if (job.model_bytes > bytes_per_day - used.bytes_today) return false;
    Prepared count(database,
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
  static double next_turn(SqliteConnection& database, const std::string& client, int weight) {
    Prepared query(
        database,
        "SELECT MAX(COALESCE("
        "(SELECT MAX(turn) FROM jobs INDEXED BY jobs_running WHERE state = 'running'), "
        "(SELECT MIN(turn) FROM jobs INDEXED BY jobs_waiting WHERE state = 'queued'), 0), "
        "COALESCE((SELECT MAX(turn) FROM jobs INDEXED BY jobs_waiting_by_client "
        "WHERE state = 'queued' AND client = ?), 0))");
    query.bind(1, client);
    query.step();
    return query.column(0).getDouble() + 1.0 / std::max(1, weight);
  }

  std::mutex counting;  // guards `totals`
  StoreTotals totals;

  std::timed_mutex writing;  // guards `database`
  SqliteConnection database;
  std::mutex reading;  // guards `reader`
  SqliteConnection reader;

  // Of the transaction that runs.
  void copy_files(const std::string& id, const std::vector<FileCopy>& copies) {
    for (const FileCopy& copy : copies) {
      Prepared keep(database, "INSERT INTO file_copies (job_id, name, bytes) VALUES (?, ?, ?)");
      keep.bind(1, id);
      keep.bind(2, copy.name);
      keep.bind_blob(3, copy.bytes);
      keep.exec();
      copied_bytes += copy.bytes.size();
    }
  }

  std::atomic<std::uint64_t> copied_bytes{0};  // in file_copies, at most

  static std::optional<Job> find(SqliteConnection& database, std::string_view id) {
    Prepared query(database, std::string("SELECT ") + kJobColumns + " FROM jobs WHERE id = ?");
    query.bind(1, std::string(id));
    if (!query.step()) return std::nullopt;
    return read_job(query);
  }

  static std::optional<InsertOutcome> known_key(SqliteConnection& database,
                                                const IdempotencyKey& key) {
    Prepared query(database,
                   "SELECT digest, job_id FROM idempotency_keys WHERE owner = ? AND key = ?");
    query.bind(1, key.owner);
    query.bind(2, key.key);
    if (!query.step()) return std::nullopt;
    const bool same = query.column(0).getString() == key.digest;
    const auto job = find(database, query.column(1).getString());
    if (!job) throw std::runtime_error("an idempotency key without its job");
    return InsertOutcome{same ? InsertResult::kReplayed : InsertResult::kConflict, *job};
  }

  std::unique_ptr<SqliteLog> wal;  // last: it uses `database` until it goes
};

SqliteJobStore::SqliteJobStore(const std::filesystem::path& file,
                               const std::string& directory_id,
                               MachineClocks clocks)
    : impl_(std::make_unique<Impl>(file, directory_id, std::move(clocks))) {
}

SqliteJobStore::~SqliteJobStore() = default;

InsertOutcome SqliteJobStore::insert(const Job& job,
                                     const std::optional<IdempotencyKey>& key,
                                     const Admission& admission,
                                     const std::vector<FileCopy>& copies) {
  return impl_->write([&](SqliteConnection& database) -> InsertOutcome {
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
    Prepared insert(database,
                    "INSERT INTO jobs (id, state, created_ms, model_format, model_name, "
                    "options_json, model_bytes, model_sha256, client, weight, turn, "
                    "owner, most_running, request_id, traceparent, webhook) "
                    "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    insert.bind(1, job.id);
    insert.bind(2, std::string(job_state_name(job.state)));
    insert.bind(3, job.created_ms);
    insert.bind(4, std::string(model_format_info(job.model_format).name));
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
      Prepared remember(
          database,
          "INSERT INTO idempotency_keys (owner, key, digest, job_id) VALUES (?, ?, ?, ?)");
      remember.bind(1, key->owner);
      remember.bind(2, key->key);
      remember.bind(3, key->digest);
      remember.bind(4, job.id);
      remember.exec();
    }
    impl_->copy_files(job.id, copies);
    transaction.commit();
    impl_->count(job.state, 1, job.model_bytes);
    return {InsertResult::kInserted, stored};
  });
}

ClientUsage SqliteJobStore::usage(std::string_view client, std::int64_t time_ms) {
  return impl_->read(
      [&](SqliteConnection& database) { return Impl::usage(database, client, time_ms); });
}

std::optional<Job> SqliteJobStore::claim(std::int64_t time_ms) {
  return impl_->write([&](SqliteConnection& database) -> std::optional<Job> {
    if (impl_->queued() == 0) return std::nullopt;
    SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
    Prepared query(database, std::string("SELECT ") + kJobColumns + kWhoseTurn);
    if (!query.step()) return std::nullopt;
    Job job = read_job(query);
    job.state = JobState::kRunning;
    job.started_ms = std::max(time_ms, job.created_ms);
    ++job.attempt;
    Prepared start(database,
                   "UPDATE jobs SET state = 'running', started_ms = ?, attempt = ? WHERE id = ?");
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
  return impl_->read([&](SqliteConnection& database) { return Impl::known_key(database, key); });
}

std::optional<Job> SqliteJobStore::find(std::string_view id) {
  return impl_->read([&](SqliteConnection& database) { return Impl::find(database, id); });
}

std::vector<Job> SqliteJobStore::list(const JobFilter& filter) {
  std::string sql = std::string("SELECT ") + kJobColumns + " FROM jobs WHERE sequence < ?";
  if (filter.state) sql += " AND state = ?";
  if (filter.owner) sql += " AND owner = ?";
  sql += " ORDER BY sequence DESC LIMIT ?";
  return impl_->read([&](SqliteConnection& database) {
    Prepared query(database, sql);
    query.bind(1, filter.before_sequence.value_or(std::numeric_limits<std::int64_t>::max()));
    int next = 2;
    if (filter.state) query.bind(next++, std::string(job_state_name(*filter.state)));
    if (filter.owner) query.bind(next++, *filter.owner);
    query.bind(next, static_cast<std::int64_t>(filter.limit));
    return read_jobs(query);
  });
}

std::vector<Job> SqliteJobStore::unfinished() {
  return impl_->read([&](SqliteConnection& database) {
    Prepared query(database,
                   std::string("SELECT ") + kJobColumns +
                       " FROM jobs WHERE state IN ('queued', 'running') ORDER BY sequence");
    return read_jobs(query);
  });
}

std::vector<Job> SqliteJobStore::oldest_finished(std::size_t limit) {
  return impl_->read([&](SqliteConnection& database) {
    Prepared query(database, std::string("SELECT ") + kJobColumns +
                                 " FROM jobs WHERE finished_clock_ms IS NOT NULL ORDER BY "
                                 "finished_clock_ms, sequence LIMIT ?");
    query.bind(1, static_cast<std::int64_t>(limit));
    return read_jobs(query);
  });
}

std::optional<Job> SqliteJobStore::apply(std::string_view id,
                                         JobEvent event,
                                         const JobChange& change) {
  return impl_->write([&](SqliteConnection& database) -> std::optional<Job> {
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

    Prepared update(database,
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
      Prepared tell(database, "INSERT INTO deliveries (job_id, tries, due_ms) VALUES (?, 0, ?)");
      tell.bind(1, job->id);
      tell.bind(2, impl_->clock_ms());
      tell.exec();
    }
    impl_->copy_files(job->id, change.copies);
    transaction.commit();
    impl_->count(state_before, -1, 0);
    impl_->count(job->state, 1, job->result_bytes - bytes_before);
    return job;
  });
}

void SqliteJobStore::make_durable() {
  impl_->wal->reach();
}

std::uint64_t SqliteJobStore::copied_bytes() {
  return impl_->copied_bytes;
}

std::int64_t SqliteJobStore::newest_copy() {
  return impl_->read([](SqliteConnection& database) {
    return database.execAndGet("SELECT COALESCE(MAX(number), 0) FROM file_copies").getInt64();
  });
}

std::optional<FileCopy> SqliteJobStore::copy_after(std::int64_t number) {
  return impl_->read([&](SqliteConnection& database) -> std::optional<FileCopy> {
    Prepared query(database,
                   "SELECT number, job_id, name, bytes FROM file_copies WHERE number > ? "
                   "ORDER BY number LIMIT 1");
    query.bind(1, number);
    if (!query.step()) return std::nullopt;
    return FileCopy{query.column(2).getString(), query.column(3).getString(),
                    query.column(1).getString(), query.column(0).getInt64()};
  });
}

void SqliteJobStore::forget_copies(std::int64_t number) {
  impl_->write([&](SqliteConnection& database) {
    SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
    Prepared forget(database, "DELETE FROM file_copies WHERE number <= ?");
    forget.bind(1, number);
    forget.exec();
    Prepared left(database, "SELECT COALESCE(SUM(LENGTH(bytes)), 0) FROM file_copies");
    left.step();
    impl_->copied_bytes = static_cast<std::uint64_t>(left.column(0).getInt64());
    left.reset();
    transaction.commit();
  });
}

std::optional<std::int64_t> SqliteJobStore::oldest_waiting_ms() {
  return impl_->read([&](SqliteConnection& database) -> std::optional<std::int64_t> {
    Prepared query(database,
                   "SELECT created_ms FROM jobs WHERE state = 'queued' ORDER BY sequence LIMIT 1");
    if (!query.step()) return std::nullopt;
    return query.column(0).getInt64();
  });
}

std::vector<Job> SqliteJobStore::spent_models(std::int64_t before_clock_ms, std::size_t limit) {
  return impl_->read([&](SqliteConnection& database) {
    Prepared query(database,
                   std::string("SELECT ") + kJobColumns +
                       " FROM jobs INDEXED BY jobs_with_spent_models WHERE state IN ('failed', "
                       "'cancelled') AND model_kept = 1 AND finished_clock_ms < ? ORDER BY "
                       "finished_clock_ms LIMIT ?");
    query.bind(1, before_clock_ms);
    query.bind(2, static_cast<std::int64_t>(limit));
    return read_jobs(query);
  });
}

void SqliteJobStore::forget_model(std::string_view id) {
  impl_->write([&](SqliteConnection& database) {
    SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
    const auto job = Impl::find(database, id);
    if (!job || !job->model_kept) return;
    Prepared update(database, "UPDATE jobs SET model_kept = 0, model_bytes = 0 WHERE id = ?");
    update.bind(1, std::string(id));
    update.exec();
    transaction.commit();
    impl_->count(job->state, 0, -job->model_bytes);
  });
}

std::optional<Delivery> SqliteJobStore::claim_delivery(std::chrono::milliseconds patience) {
  return impl_->write([&](SqliteConnection& database) -> std::optional<Delivery> {
    SQLite::Transaction transaction(database, SQLite::TransactionBehavior::DEFERRED);
    Prepared query(database,
                   "SELECT d.job_id, j.webhook, d.tries FROM deliveries AS d JOIN jobs AS j "
                   "ON j.id = d.job_id WHERE d.due_ms <= ? ORDER BY d.due_ms LIMIT 1");
    query.bind(1, impl_->clock_ms());
    if (!query.step()) return std::nullopt;
    Delivery delivery{query.column(0).getString(), query.column(1).getString(),
                      query.column(2).getInt()};
    query.reset();
    Prepared update(database, "UPDATE deliveries SET due_ms = ? WHERE job_id = ?");
    update.bind(1, impl_->clock_ms() + patience.count());
    update.bind(2, delivery.job_id);
    update.exec();
    transaction.commit();
    return delivery;
  });
}

void SqliteJobStore::delivered(std::string_view job_id) {
  impl_->write([&](SqliteConnection& database) {
    Prepared done(database, "DELETE FROM deliveries WHERE job_id = ?");
    done.bind(1, std::string(job_id));
    done.exec();
  });
}

void SqliteJobStore::delivery_failed(std::string_view job_id,
                                     std::optional<std::chrono::milliseconds> pause) {
  if (!pause) return delivered(job_id);
  impl_->write([&](SqliteConnection& database) {
    Prepared again(database,
                   "UPDATE deliveries SET tries = tries + 1, due_ms = ? WHERE job_id = ?");
    again.bind(1, impl_->clock_ms() + pause->count());
    again.bind(2, std::string(job_id));
    again.exec();
  });
}

void SqliteJobStore::count_lost_worker(std::string_view id) {
  impl_->write([&](SqliteConnection& database) {
    Prepared update(database, "UPDATE jobs SET lost_workers = lost_workers + 1 WHERE id = ?");
    update.bind(1, std::string(id));
    update.exec();
  });
}

bool SqliteJobStore::erase(std::string_view id) {
  return impl_->write([&](SqliteConnection& database) {
    SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
    const auto job = Impl::find(database, id);
    if (!job) return false;
    Prepared erase(database, "DELETE FROM jobs WHERE id = ?");
    erase.bind(1, std::string(id));
    erase.exec();
    Prepared remember(database, "INSERT OR IGNORE INTO erased (id) VALUES (?)");
    remember.bind(1, std::string(id));
    remember.exec();
    transaction.commit();
    impl_->count(job->state, -1, -(job->model_bytes + job->result_bytes));
    return true;
  });
}

bool SqliteJobStore::was_erased(std::string_view id) {
  return impl_->read([&](SqliteConnection& database) {
    Prepared query(database, "SELECT 1 FROM erased WHERE id = ?");
    query.bind(1, std::string(id));
    return query.step();
  });
}

std::vector<std::string> SqliteJobStore::erased_up_to(std::int64_t mark) {
  return impl_->read([&](SqliteConnection& database) {
    Prepared query(database, "SELECT id FROM erased WHERE rowid <= ?");
    query.bind(1, mark);
    std::vector<std::string> ids;
    while (query.step()) ids.push_back(query.column(0).getString());
    return ids;
  });
}

std::int64_t SqliteJobStore::tidy(std::int64_t mark) {
  return impl_->write([&](SqliteConnection& database) {
    SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
    Prepared forget(database, "DELETE FROM erased WHERE rowid <= ?");
    forget.bind(1, mark);
    forget.exec();
    // Days that no limit looks at any more.
    constexpr std::int64_t kDaysKept = 40;
    Prepared old(database, "DELETE FROM key_usage WHERE day < ?");
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
  impl_->read([](SqliteConnection& database) {
    static_cast<void>(database.execAndGet("SELECT COUNT(*) FROM (SELECT 1 FROM jobs LIMIT 1)"));
  });
  std::unique_lock lock(impl_->writing, kHealthPatience);
  if (!lock) throw StoreError(StoreError::Kind::kBusy, "writes to the job database do not end");
  translate_sqlite_errors([&] {
    SqliteConnection& database = impl_->database;
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
  lock.unlock();
  impl_->wal->reach();
}

}  // namespace symcell::server
