// The tables in PostgreSQL, and their versions.
#include <array>
#include <stdexcept>
#include <string>

#include "server/jobs/postgres_connections.hpp"

namespace symcell::server {
namespace {

// One entry a schema version; entry i takes version i to version i + 1. Never edited, only added to.
constexpr std::array kMigrations = {
    R"sql(
CREATE FUNCTION symcell_now_ms() RETURNS bigint LANGUAGE sql VOLATILE AS
  $$ SELECT (extract(epoch FROM clock_timestamp()) * 1000)::bigint $$;
CREATE TABLE symcell_properties (name text PRIMARY KEY, value text NOT NULL);
CREATE TABLE symcell_jobs (
  sequence bigserial PRIMARY KEY,
  id text NOT NULL UNIQUE,
  state text NOT NULL,
  created_ms bigint NOT NULL,
  started_ms bigint,
  finished_ms bigint,
  model_format text NOT NULL,
  model_name text NOT NULL,
  options_json text NOT NULL,
  error_code text NOT NULL DEFAULT '',
  error_json text NOT NULL DEFAULT '',
  model_bytes bigint NOT NULL,
  result_bytes bigint NOT NULL DEFAULT 0,
  lost_workers integer NOT NULL DEFAULT 0,
  model_sha256 text NOT NULL,
  statistics_sha256 text NOT NULL DEFAULT '',
  client text NOT NULL,
  weight integer NOT NULL,
  turn double precision NOT NULL,
  attempt integer NOT NULL DEFAULT 0,
  owner text NOT NULL,
  most_running bigint NOT NULL,
  model_kept boolean NOT NULL DEFAULT true,
  request_id text NOT NULL,
  traceparent text NOT NULL,
  webhook text NOT NULL,
  server text NOT NULL DEFAULT '',
  leased_until_ms bigint NOT NULL DEFAULT 0,
  cancel_requested boolean NOT NULL DEFAULT false,
  phase integer NOT NULL DEFAULT 0,
  fraction double precision NOT NULL DEFAULT 0,
  elements bigint NOT NULL DEFAULT 0,
  quality double precision NOT NULL DEFAULT 0
) WITH (fillfactor = 80);
CREATE INDEX symcell_jobs_waiting ON symcell_jobs (turn, sequence) WHERE state = 'queued';
CREATE INDEX symcell_jobs_waiting_by_client ON symcell_jobs (client, turn) WHERE state = 'queued';
CREATE INDEX symcell_jobs_running ON symcell_jobs (turn) WHERE state = 'running';
CREATE INDEX symcell_jobs_running_by_client ON symcell_jobs (client) WHERE state = 'running';
CREATE INDEX symcell_jobs_by_state ON symcell_jobs (state, sequence);
CREATE INDEX symcell_jobs_by_owner ON symcell_jobs (owner, sequence);
CREATE INDEX symcell_jobs_by_end ON symcell_jobs (finished_ms, sequence)
  WHERE finished_ms IS NOT NULL;
CREATE INDEX symcell_jobs_with_spent_models ON symcell_jobs (finished_ms)
  WHERE state IN ('failed', 'cancelled') AND model_kept;
CREATE TABLE symcell_idempotency_keys (
  owner text NOT NULL,
  key text NOT NULL,
  digest text NOT NULL,
  job_id text NOT NULL REFERENCES symcell_jobs (id) ON DELETE CASCADE,
  PRIMARY KEY (owner, key)
);
CREATE INDEX symcell_idempotency_keys_by_job ON symcell_idempotency_keys (job_id);
CREATE TABLE symcell_erased (id text PRIMARY KEY, erased_ms bigint NOT NULL);
CREATE TABLE symcell_api_keys (
  id text PRIMARY KEY,
  name text NOT NULL,
  hash text NOT NULL,
  scopes text NOT NULL,
  created_ms bigint NOT NULL,
  revoked_ms bigint,
  queued bigint NOT NULL,
  running bigint NOT NULL,
  bytes_per_day bigint NOT NULL,
  requests_per_minute bigint NOT NULL,
  priority integer NOT NULL
);
CREATE TABLE symcell_key_usage (
  owner text NOT NULL,
  day bigint NOT NULL,
  jobs bigint NOT NULL,
  bytes bigint NOT NULL,
  PRIMARY KEY (owner, day)
);
CREATE TABLE symcell_deliveries (
  job_id text PRIMARY KEY REFERENCES symcell_jobs (id) ON DELETE CASCADE,
  tries integer NOT NULL,
  due_ms bigint NOT NULL
);
CREATE INDEX symcell_deliveries_by_time ON symcell_deliveries (due_ms);
)sql",
};

// Any number, the same in all versions of this program: "symcell" in ASCII.
constexpr const char* kLockMigrations = "SELECT pg_advisory_xact_lock(32501918393592940)";

}  // namespace

void migrate_postgres(PostgresConnections& connections) {
  connections.transact([](pqxx::work& transaction) {
    transaction.exec("SET LOCAL lock_timeout = 0; SET LOCAL statement_timeout = 0");
    transaction.exec(kLockMigrations);
    transaction.exec("CREATE TABLE IF NOT EXISTS symcell_schema (version integer NOT NULL)");
    const auto rows = transaction.exec("SELECT version FROM symcell_schema");
    const int version = rows.empty() ? 0 : rows[0][0].as<int>();
    const int newest = static_cast<int>(kMigrations.size());
    if (version > newest) {
      throw std::runtime_error("the job database has version " + std::to_string(version) +
                               ", this program knows up to " + std::to_string(newest) +
                               ": use a newer program");
    }
    for (int step = version; step < newest; ++step) {
      transaction.exec(kMigrations[static_cast<std::size_t>(step)]);
    }
    if (rows.empty()) {
      transaction.exec("INSERT INTO symcell_schema VALUES (" + std::to_string(newest) + ")");
    } else {
      transaction.exec("UPDATE symcell_schema SET version = " + std::to_string(newest));
    }
  });
}

}  // namespace symcell::server
