#include "server/jobs/postgres_job_store.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "server/base/identifiers.hpp"
#include "server/jobs/postgres_connections.hpp"

namespace symcell::server {
namespace {

constexpr const char* kColumns =
    "sequence, id, state, created_ms, started_ms, finished_ms, model_format, model_name, "
    "options_json, error_code, error_json, model_bytes, result_bytes, lost_workers, model_sha256, "
    "statistics_sha256, client, weight, attempt, owner, most_running, model_kept, request_id, "
    "traceparent, webhook, phase, fraction, elements, quality";
// A server tells the others that a job has changed.
constexpr const char* kTell = "SELECT pg_notify('symcell_jobs', $1)";
constexpr const char* kDay = "(symcell_now_ms() / 86400000)";
constexpr std::chrono::seconds kCountInterval{1};
constexpr int kFullCountEvery = 30;  // intervals
constexpr std::chrono::seconds kReconnectPause{1};

std::optional<std::int64_t> optional_time(const pqxx::field& field) {
  if (field.is_null()) return std::nullopt;
  return field.as<std::int64_t>();
}

Job read_job(const pqxx::row& row) {
  Job job;
  job.sequence = row[0].as<std::int64_t>();
  job.id = row[1].as<std::string>();
  const auto state = job_state_from_name(row[2].as<std::string>());
  if (!state) throw std::runtime_error("the job database holds an unknown state");
  job.state = *state;
  job.created_ms = row[3].as<std::int64_t>();
  job.started_ms = optional_time(row[4]);
  job.finished_ms = optional_time(row[5]);
  job.finished_clock_ms = job.finished_ms;
  const auto format = model_format_of_name(row[6].as<std::string>());
  if (!format) throw std::runtime_error("the job database holds an unknown model format");
  job.model_format = *format;
  job.model_name = row[7].as<std::string>();
  job.options_json = row[8].as<std::string>();
  job.error_code = row[9].as<std::string>();
  job.error_json = row[10].as<std::string>();
  job.model_bytes = row[11].as<std::int64_t>();
  job.result_bytes = row[12].as<std::int64_t>();
  job.lost_workers = row[13].as<std::int32_t>();
  job.model_sha256 = row[14].as<std::string>();
  job.statistics_sha256 = row[15].as<std::string>();
  job.client = row[16].as<std::string>();
  job.weight = row[17].as<std::int32_t>();
  job.attempt = row[18].as<std::int32_t>();
  job.owner = row[19].as<std::string>();
  job.most_running = row[20].as<std::int64_t>();
  job.model_kept = row[21].as<bool>();
  job.request_id = row[22].as<std::string>();
  job.traceparent = row[23].as<std::string>();
  job.webhook = row[24].as<std::string>();
  Progress progress;
  progress.phase = static_cast<Phase>(row[25].as<int>());
  progress.fraction = row[26].as<double>();
  progress.elements = static_cast<std::uint64_t>(row[27].as<std::int64_t>());
  progress.quality_reached = row[28].as<double>();
  job.progress = progress;
  return job;
}

std::vector<Job> read_jobs(const pqxx::result& rows) {
  std::vector<Job> jobs;
  jobs.reserve(rows.size());
  for (const auto& row : rows) jobs.push_back(read_job(row));
  return jobs;
}

std::optional<Job> first_job(const pqxx::result& rows) {
  if (rows.empty()) return std::nullopt;
  return read_job(rows[0]);
}

std::string select(const std::string& rest) {
  return std::string("SELECT ") + kColumns + " FROM symcell_jobs " + rest;
}

std::optional<Job> find_job(pqxx::work& transaction, const std::string& id, bool lock) {
  return first_job(
      transaction.exec_params(select(lock ? "WHERE id = $1 FOR UPDATE" : "WHERE id = $1"), id));
}

std::optional<InsertOutcome> known_key(pqxx::work& transaction, const IdempotencyKey& key) {
  const auto rows = transaction.exec_params(
      "SELECT digest, job_id FROM symcell_idempotency_keys WHERE owner = $1 AND key = $2",
      key.owner, key.key);
  if (rows.empty()) return std::nullopt;
  const bool same = rows[0][0].as<std::string>() == key.digest;
  auto job = find_job(transaction, rows[0][1].as<std::string>(), false);
  if (!job) throw std::runtime_error("an idempotency key without its job");
  return InsertOutcome{same ? InsertResult::kReplayed : InsertResult::kConflict, *job};
}

std::int64_t one_number(const pqxx::result& rows) {
  return rows[0][0].as<std::int64_t>();
}

// See SqliteJobStore for what turns are.
double next_turn(pqxx::work& transaction, const Job& job) {
  const auto rows = transaction.exec_params(
      "SELECT GREATEST(COALESCE((SELECT MAX(turn) FROM symcell_jobs WHERE state = 'running'), "
      "(SELECT MIN(turn) FROM symcell_jobs WHERE state = 'queued'), 0), "
      "COALESCE((SELECT MAX(turn) FROM symcell_jobs WHERE state = 'queued' AND client = $1), 0))",
      job.client);
  return rows[0][0].as<double>() + 1.0 / std::max(1, job.weight);
}

// Counts the job's bytes; false: that is more than the day has. Locks the day's row, so that two
// servers cannot both take the rest.
bool spend(pqxx::work& transaction, const Job& job, std::int64_t bytes_per_day) {
  const auto rows = transaction.exec_params(
      std::string("INSERT INTO symcell_key_usage AS u (owner, day, jobs, bytes) VALUES ($1, ") +
          kDay +
          ", 1, $2) ON CONFLICT (owner, day) DO UPDATE SET jobs = u.jobs + 1, "
          "bytes = u.bytes + excluded.bytes RETURNING bytes",
      job.owner, job.model_bytes);
  return one_number(rows) <= bytes_per_day;
}

// Nothing of what was done so far shall last.
struct TakenBack {
  InsertOutcome outcome;
};

class Listener final : public pqxx::notification_receiver {
 public:
  Listener(pqxx::connection_base& connection, std::function<void(std::string_view id)> heard)
      : pqxx::notification_receiver(connection, "symcell_jobs"), heard_(std::move(heard)) {}

  void operator()(const std::string& payload, int /*backend*/) override { heard_(payload); }

 private:
  std::function<void(std::string_view id)> heard_;
};

}  // namespace

struct PostgresJobStore::Impl {
  explicit Impl(const std::string& url) : connections(url) {}

  ~Impl() {
    stopping = true;
    listening = false;
    if (listener.joinable()) listener.join();
    if (counter.joinable()) counter.join();
  }

  void count(bool all) {
    const auto rows = connections.transact([&](pqxx::work& transaction) {
      return transaction.exec(
          std::string(
              "SELECT state, COUNT(*), COALESCE(SUM(model_bytes + result_bytes), 0)::bigint "
              "FROM symcell_jobs ") +
          (all ? "" : "WHERE state IN ('queued', 'running') ") + "GROUP BY state");
    });
    StoreTotals found;
    std::array<std::int64_t, 5> bytes{};
    for (const auto& row : rows) {
      const auto state = job_state_from_name(row[0].as<std::string>());
      if (!state) continue;
      found.by_state[static_cast<std::size_t>(*state)] = row[1].as<std::int64_t>();
      bytes[static_cast<std::size_t>(*state)] = row[2].as<std::int64_t>();
    }
    const std::lock_guard lock(counting);
    for (const JobState state : kAllJobStates) {
      const auto i = static_cast<std::size_t>(state);
      if (!all && is_finished(state)) continue;
      totals.by_state[i] = found.by_state[i];
      bytes_by_state[i] = bytes[i];
    }
    totals.bytes = 0;
    for (const std::int64_t of_state : bytes_by_state) totals.bytes += of_state;
  }

  void keep_counting() {
    int round = 0;
    while (!stopping) {
      std::this_thread::sleep_for(kCountInterval);
      try {
        count(++round % kFullCountEvery == 0);
      } catch (const std::exception&) {
        // What was counted last stands; who needs the store now is told.
      }
    }
  }

  void keep_listening(const std::function<void(std::string_view id)>& changed) {
    while (listening) {
      try {
        const auto connection = connections.open();
        const Listener receiver(*connection, changed);
        // Whatever happened while nobody listened.
        changed({});
        while (listening) connection->await_notification(1, 0);
      } catch (const std::exception&) {
        std::this_thread::sleep_for(kReconnectPause);
      }
    }
  }

  PostgresConnections connections;
  const std::string server = make_random_hex();  // whose runs are its own
  std::mutex counting;                           // guards the next two
  StoreTotals totals;
  std::array<std::int64_t, 5> bytes_by_state{};
  std::atomic<bool> stopping{false};
  std::atomic<bool> listening{false};
  std::thread listener;
  std::thread counter;
};

PostgresJobStore::PostgresJobStore(const std::string& url, const std::string& directory_id)
    : impl_(std::make_unique<Impl>(url)) {
  migrate_postgres(impl_->connections);
  const std::string known = impl_->connections.transact([&](pqxx::work& transaction) {
    transaction.exec_params(
        "INSERT INTO symcell_properties (name, value) VALUES ('directory_id', $1) "
        "ON CONFLICT DO NOTHING",
        directory_id);
    return transaction
        .exec("SELECT value FROM symcell_properties WHERE name = 'directory_id'")[0][0]
        .as<std::string>();
  });
  if (known != directory_id) {
    throw std::runtime_error("the job database belongs to another data directory (" + known +
                             ", and this one is " + directory_id +
                             "): all servers of a database share one --data-dir");
  }
  impl_->count(true);
  impl_->counter = std::thread([this] { impl_->keep_counting(); });
}

PostgresJobStore::~PostgresJobStore() = default;

InsertOutcome PostgresJobStore::insert(const Job& job,
                                       const std::optional<IdempotencyKey>& key,
                                       const Admission& admission,
                                       const std::vector<FileCopy>& /*copies*/) {
  try {
    return impl_->connections.transact([&](pqxx::work& transaction) -> InsertOutcome {
      if (key) {
        if (auto known = known_key(transaction, *key)) return *known;
      }
      // Servers that insert at the same moment may overshoot by one each.
      if (one_number(transaction.exec(
              "SELECT COUNT(*) FROM symcell_jobs WHERE state = 'queued'")) >= admission.queued ||
          one_number(transaction.exec_params(
              "SELECT COUNT(*) FROM symcell_jobs WHERE state = 'queued' AND client = $1",
              job.client)) >= admission.queued_of_client) {
        return {InsertResult::kQueueFull, {}};
      }
      if (!job.owner.empty() && !spend(transaction, job, admission.bytes_per_day)) {
        throw TakenBack{{InsertResult::kBytesSpent, {}}};
      }
      auto stored = first_job(transaction.exec_params(
          std::string("INSERT INTO symcell_jobs (id, state, created_ms, model_format, model_name, "
                      "options_json, model_bytes, model_sha256, client, weight, turn, owner, "
                      "most_running, request_id, traceparent, webhook) VALUES ($1, 'queued', "
                      "symcell_now_ms(), $2, $3, $4, $5, $6, $7, $8, $9, $10, $11, $12, $13, $14) "
                      "RETURNING ") +
              kColumns,
          job.id, std::string(model_format_info(job.model_format).name), job.model_name,
          job.options_json, job.model_bytes, job.model_sha256, job.client, job.weight,
          next_turn(transaction, job), job.owner, job.most_running, job.request_id, job.traceparent,
          job.webhook));
      if (key) {
        const auto taken = transaction.exec_params(
            "INSERT INTO symcell_idempotency_keys (owner, key, digest, job_id) "
            "VALUES ($1, $2, $3, $4) ON CONFLICT DO NOTHING",
            key->owner, key->key, key->digest, job.id);
        if (taken.affected_rows() == 0) {
          // The same request came to another server at the same moment, and was faster.
          const auto known = known_key(transaction, *key);
          throw TakenBack{known ? *known : InsertOutcome{InsertResult::kConflict, {}}};
        }
      }
      transaction.exec_params(kTell, job.id);
      return {InsertResult::kInserted, *stored};
    });
  } catch (TakenBack& taken_back) {
    return std::move(taken_back.outcome);
  } catch (const StoreError&) {
    // The connection may have broken after the commit: whoever believed that nothing was stored
    // would take the model away.
    if (auto there = find(job.id)) return {InsertResult::kInserted, *there};
    throw;
  }
}

std::optional<InsertOutcome> PostgresJobStore::find_key(const IdempotencyKey& key) {
  return impl_->connections.transact(
      [&](pqxx::work& transaction) { return known_key(transaction, key); });
}

std::optional<Job> PostgresJobStore::find(std::string_view id) {
  return impl_->connections.transact(
      [&](pqxx::work& transaction) { return find_job(transaction, std::string(id), false); });
}

std::vector<Job> PostgresJobStore::list(const JobFilter& filter) {
  return impl_->connections.transact([&](pqxx::work& transaction) {
    std::string where = "WHERE sequence < $1";
    if (filter.state) {
      where += " AND state = " + transaction.quote(std::string(job_state_name(*filter.state)));
    }
    if (filter.owner) where += " AND owner = " + transaction.quote(*filter.owner);
    return read_jobs(transaction.exec_params(
        select(where + " ORDER BY sequence DESC LIMIT " + std::to_string(filter.limit)),
        filter.before_sequence.value_or(std::numeric_limits<std::int64_t>::max())));
  });
}

std::vector<Job> PostgresJobStore::unfinished() {
  return impl_->connections.transact([&](pqxx::work& transaction) {
    return read_jobs(
        transaction.exec(select("WHERE state IN ('queued', 'running') ORDER BY sequence")));
  });
}

std::vector<Job> PostgresJobStore::oldest_finished(std::size_t limit) {
  return impl_->connections.transact([&](pqxx::work& transaction) {
    return read_jobs(transaction.exec(
        select("WHERE finished_ms IS NOT NULL ORDER BY finished_ms, sequence LIMIT " +
               std::to_string(limit))));
  });
}

ClientUsage PostgresJobStore::usage(std::string_view client, std::int64_t /*time_ms*/) {
  return impl_->connections.transact([&](pqxx::work& transaction) -> ClientUsage {
    const auto rows = transaction.exec_params(
        std::string("SELECT "
                    "(SELECT COUNT(*) FROM symcell_jobs WHERE state = 'queued' AND client = $1), "
                    "(SELECT COUNT(*) FROM symcell_jobs WHERE state = 'running' AND client = $1), "
                    "COALESCE((SELECT bytes FROM symcell_key_usage WHERE owner = $1 AND day = ") +
            kDay +
            "), 0), COALESCE((SELECT jobs FROM symcell_key_usage WHERE owner = $1 AND day = " +
            kDay + "), 0)",
        std::string(client));
    return {rows[0][0].as<std::int64_t>(), rows[0][1].as<std::int64_t>(),
            rows[0][2].as<std::int64_t>(), rows[0][3].as<std::int64_t>()};
  });
}

std::optional<Job> PostgresJobStore::claim(std::int64_t /*time_ms*/) {
  return impl_->connections.transact([&](pqxx::work& transaction) -> std::optional<Job> {
    // Found first, then changed: as a subquery of the update the search might be done again. Whom
    // another server just takes is passed over.
    const auto found = transaction.exec(
        "SELECT j.id FROM symcell_jobs AS j WHERE j.state = 'queued' AND (j.most_running = 0 OR "
        "j.most_running > (SELECT COUNT(*) FROM symcell_jobs AS r WHERE r.state = 'running' AND "
        "r.client = j.client)) ORDER BY j.turn, j.sequence LIMIT 1 FOR UPDATE SKIP LOCKED");
    if (found.empty()) return std::nullopt;
    auto job = first_job(transaction.exec_params(
        std::string("UPDATE symcell_jobs SET state = 'running', "
                    "started_ms = GREATEST(symcell_now_ms(), created_ms), attempt = attempt + 1, "
                    "server = $2, leased_until_ms = symcell_now_ms() + $3, "
                    "cancel_requested = false, phase = 0, fraction = 0, elements = 0, quality = 0 "
                    "WHERE id = $1 RETURNING ") +
            kColumns,
        found[0][0].as<std::string>(), impl_->server,
        std::int64_t{std::chrono::milliseconds(kLease).count()}));
    transaction.exec_params(kTell, job->id);
    return job;
  });
}

std::vector<RunOrder> PostgresJobStore::keep(const std::vector<RunState>& runs) {
  if (runs.empty()) return {};
  return impl_->connections.transact([&](pqxx::work& transaction) {
    // A renewal that is lost with the database's machine is renewed again, or was for nothing.
    transaction.exec("SET LOCAL synchronous_commit = off");
    std::vector<RunOrder> orders;
    bool told = false;
    for (const RunState& run : runs) {
      const auto rows = transaction.exec_params(
          "UPDATE symcell_jobs SET leased_until_ms = symcell_now_ms() + $3, phase = $4, "
          "fraction = $5, elements = $6, quality = $7 WHERE id = $1 AND attempt = $2 AND "
          "state = 'running' AND server = $8 RETURNING cancel_requested",
          run.id, run.attempt, std::int64_t{std::chrono::milliseconds(kLease).count()},
          static_cast<int>(run.progress.phase), run.progress.fraction,
          static_cast<std::int64_t>(run.progress.elements), run.progress.quality_reached,
          impl_->server);
      if (rows.empty()) {
        orders.push_back({run.id, true, false});
      } else if (rows[0][0].as<bool>()) {
        orders.push_back({run.id, false, true});
      }
      if (!std::exchange(told, true)) transaction.exec_params(kTell, run.id);
    }
    return orders;
  });
}

std::size_t PostgresJobStore::rescue() {
  return impl_->connections.transact([&](pqxx::work& transaction) -> std::size_t {
    const auto rows = transaction.exec(
        "UPDATE symcell_jobs SET state = 'queued', started_ms = NULL WHERE id IN (SELECT id FROM "
        "symcell_jobs WHERE state = 'running' AND leased_until_ms < symcell_now_ms() "
        "FOR UPDATE SKIP LOCKED) RETURNING id");
    for (const auto& row : rows) transaction.exec_params(kTell, row[0].as<std::string>());
    return rows.size();
  });
}

void PostgresJobStore::request_cancel(std::string_view id) {
  impl_->connections.transact([&](pqxx::work& transaction) {
    transaction.exec_params(
        "UPDATE symcell_jobs SET cancel_requested = true WHERE id = $1 AND state = 'running'",
        std::string(id));
    transaction.exec_params(kTell, std::string(id));
  });
}

void PostgresJobStore::listen(const std::function<void(std::string_view id)>& changed) {
  impl_->listening = false;
  if (impl_->listener.joinable()) impl_->listener.join();
  if (!changed) return;
  impl_->listening = true;
  impl_->listener = std::thread([this, changed] { impl_->keep_listening(changed); });
}

std::optional<std::int64_t> PostgresJobStore::oldest_waiting_ms() {
  return impl_->connections.transact([&](pqxx::work& transaction) -> std::optional<std::int64_t> {
    const auto rows = transaction.exec(
        "SELECT created_ms FROM symcell_jobs WHERE state = 'queued' ORDER BY sequence LIMIT 1");
    if (rows.empty()) return std::nullopt;
    return one_number(rows);
  });
}

std::vector<Job> PostgresJobStore::spent_models(std::int64_t before_clock_ms, std::size_t limit) {
  return impl_->connections.transact([&](pqxx::work& transaction) {
    return read_jobs(transaction.exec_params(
        select("WHERE state IN ('failed', 'cancelled') AND model_kept AND finished_ms < $1 ORDER "
               "BY finished_ms LIMIT " +
               std::to_string(limit)),
        before_clock_ms));
  });
}

void PostgresJobStore::forget_model(std::string_view id) {
  impl_->connections.transact([&](pqxx::work& transaction) {
    transaction.exec_params(
        "UPDATE symcell_jobs SET model_kept = false, model_bytes = 0 WHERE id = $1",
        std::string(id));
  });
}

std::optional<Delivery> PostgresJobStore::claim_delivery(std::chrono::milliseconds patience) {
  return impl_->connections.transact([&](pqxx::work& transaction) -> std::optional<Delivery> {
    const auto rows = transaction.exec(
        "SELECT d.job_id, j.webhook, d.tries FROM symcell_deliveries AS d JOIN symcell_jobs AS j "
        "ON "
        "j.id = d.job_id WHERE d.due_ms <= symcell_now_ms() ORDER BY d.due_ms LIMIT 1 "
        "FOR UPDATE OF d SKIP LOCKED");
    if (rows.empty()) return std::nullopt;
    Delivery delivery{rows[0][0].as<std::string>(), rows[0][1].as<std::string>(),
                      rows[0][2].as<std::int32_t>()};
    transaction.exec_params(
        "UPDATE symcell_deliveries SET due_ms = symcell_now_ms() + $2 WHERE job_id = $1",
        delivery.job_id, std::int64_t{patience.count()});
    return delivery;
  });
}

void PostgresJobStore::delivered(std::string_view job_id) {
  impl_->connections.transact([&](pqxx::work& transaction) {
    transaction.exec_params("DELETE FROM symcell_deliveries WHERE job_id = $1",
                            std::string(job_id));
  });
}

void PostgresJobStore::delivery_failed(std::string_view job_id,
                                       std::optional<std::chrono::milliseconds> pause) {
  if (!pause) return delivered(job_id);
  impl_->connections.transact([&](pqxx::work& transaction) {
    transaction.exec_params(
        "UPDATE symcell_deliveries SET tries = tries + 1, due_ms = symcell_now_ms() + $2 "
        "WHERE job_id = $1",
        std::string(job_id), std::int64_t{pause->count()});
  });
}

std::optional<Job> PostgresJobStore::apply(std::string_view id,
                                           JobEvent event,
                                           const JobChange& change) {
  return impl_->connections.transact([&](pqxx::work& transaction) -> std::optional<Job> {
    const auto job = find_job(transaction, std::string(id), true);
    if (!job) return std::nullopt;
    const auto next = next_state(job->state, event);
    if (!next || (change.attempt && *change.attempt != job->attempt)) return std::nullopt;
    std::string times;
    if (event == JobEvent::kStart) {
      times = ", started_ms = GREATEST(symcell_now_ms(), created_ms), attempt = attempt + 1";
    }
    if (event == JobEvent::kRequeue) times = ", started_ms = NULL";
    if (is_finished(*next)) {
      times = ", finished_ms = GREATEST(symcell_now_ms(), COALESCE(started_ms, created_ms))";
    }
    auto changed = first_job(transaction.exec_params(
        "UPDATE symcell_jobs SET state = $2, error_code = $3, error_json = $4, result_bytes = $5, "
        "statistics_sha256 = $6" +
            times + " WHERE id = $1 RETURNING " + kColumns,
        job->id, std::string(job_state_name(*next)), change.error_code, change.error_json,
        change.result_bytes, change.statistics_sha256));
    if (is_finished(*next) && !job->webhook.empty()) {
      transaction.exec_params(
          "INSERT INTO symcell_deliveries (job_id, tries, due_ms) VALUES ($1, 0, symcell_now_ms())",
          job->id);
    }
    transaction.exec_params(kTell, job->id);
    return changed;
  });
}

void PostgresJobStore::count_lost_worker(std::string_view id) {
  impl_->connections.transact([&](pqxx::work& transaction) {
    transaction.exec_params("UPDATE symcell_jobs SET lost_workers = lost_workers + 1 WHERE id = $1",
                            std::string(id));
  });
}

bool PostgresJobStore::erase(std::string_view id) {
  return impl_->connections.transact([&](pqxx::work& transaction) -> bool {
    const auto gone =
        transaction.exec_params("DELETE FROM symcell_jobs WHERE id = $1", std::string(id));
    if (gone.affected_rows() == 0) return false;
    transaction.exec_params(
        "INSERT INTO symcell_erased (id, erased_ms) VALUES ($1, symcell_now_ms()) "
        "ON CONFLICT DO NOTHING",
        std::string(id));
    transaction.exec_params(kTell, std::string(id));
    return true;
  });
}

bool PostgresJobStore::was_erased(std::string_view id) {
  return impl_->connections.transact([&](pqxx::work& transaction) -> bool {
    return !transaction.exec_params("SELECT 1 FROM symcell_erased WHERE id = $1", std::string(id))
                .empty();
  });
}

std::int64_t PostgresJobStore::tidy(std::int64_t mark) {
  impl_->connections.transact([&](pqxx::work& transaction) {
    // A server that still held such a job has let go of it long since.
    transaction.exec("DELETE FROM symcell_erased WHERE erased_ms < symcell_now_ms() - 86400000");
    transaction.exec(std::string("DELETE FROM symcell_key_usage WHERE day < ") + kDay + " - 40");
  });
  return mark;
}

std::int64_t PostgresJobStore::clock_ms() {
  return impl_->connections.transact([&](pqxx::work& transaction) -> std::int64_t {
    return one_number(transaction.exec("SELECT symcell_now_ms()"));
  });
}

StoreTotals PostgresJobStore::totals() {
  const std::lock_guard lock(impl_->counting);
  return impl_->totals;
}

void PostgresJobStore::check_health() {
  impl_->connections.transact([&](pqxx::work& transaction) {
    transaction.exec("SET LOCAL statement_timeout = '1s'");
    transaction.exec(
        "INSERT INTO symcell_properties (name, value) VALUES ('probe', '0') "
        "ON CONFLICT (name) DO UPDATE SET value = excluded.value");
  });
}

}  // namespace symcell::server
