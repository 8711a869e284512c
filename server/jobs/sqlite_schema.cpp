#include "server/jobs/sqlite_schema.hpp"

#include <fcntl.h>
#include <sqlite3.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <stdexcept>

namespace symcell::server {
namespace {

// One entry a schema version; entry i takes version i to version i + 1. Never edited, only added
// to.
constexpr std::array kMigrations = {
    R"sql(
CREATE TABLE jobs (
  sequence INTEGER PRIMARY KEY AUTOINCREMENT,
  id TEXT NOT NULL UNIQUE,
  state TEXT NOT NULL,
  created_ms INTEGER NOT NULL,
  started_ms INTEGER,
  finished_ms INTEGER,
  model_format TEXT NOT NULL,
  model_name TEXT NOT NULL,
  options_json TEXT NOT NULL,
  error_code TEXT NOT NULL DEFAULT '',
  error_json TEXT NOT NULL DEFAULT '',
  model_bytes INTEGER NOT NULL,
  result_bytes INTEGER NOT NULL DEFAULT 0,
  crashes INTEGER NOT NULL DEFAULT 0
) STRICT;
CREATE INDEX jobs_by_state ON jobs (state, sequence);
CREATE TABLE idempotency_keys (
  key TEXT PRIMARY KEY,
  digest TEXT NOT NULL,
  job_id TEXT NOT NULL REFERENCES jobs (id) ON DELETE CASCADE
) STRICT;
CREATE INDEX idempotency_keys_by_job ON idempotency_keys (job_id);
)sql",
    R"sql(
CREATE TABLE properties (name TEXT PRIMARY KEY, value TEXT NOT NULL) STRICT;
CREATE TABLE erased (id TEXT PRIMARY KEY) STRICT;
)sql",
    // Counted before: deaths of the server, which are no fault of the job's.
    R"sql(
ALTER TABLE jobs RENAME COLUMN crashes TO lost_workers;
UPDATE jobs SET lost_workers = 0 WHERE lost_workers <> 0;
)sql",
    R"sql(
CREATE INDEX jobs_by_end ON jobs (finished_ms, sequence) WHERE finished_ms IS NOT NULL;
)sql",
    R"sql(
ALTER TABLE jobs ADD COLUMN finished_clock_ms INTEGER;
UPDATE jobs SET finished_clock_ms = finished_ms;
DROP INDEX jobs_by_end;
CREATE INDEX jobs_by_end ON jobs (finished_clock_ms, sequence) WHERE finished_clock_ms IS NOT NULL;
)sql",
    R"sql(
ALTER TABLE jobs ADD COLUMN model_sha256 TEXT NOT NULL DEFAULT '';
ALTER TABLE jobs ADD COLUMN statistics_sha256 TEXT NOT NULL DEFAULT '';
)sql",
    // Who takes turns, how often a job was started, and keys that belong to their client.
    R"sql(
ALTER TABLE jobs ADD COLUMN client TEXT NOT NULL DEFAULT '';
ALTER TABLE jobs ADD COLUMN weight INTEGER NOT NULL DEFAULT 1;
ALTER TABLE jobs ADD COLUMN turn REAL NOT NULL DEFAULT 0;
ALTER TABLE jobs ADD COLUMN attempt INTEGER NOT NULL DEFAULT 0;
CREATE INDEX jobs_waiting ON jobs (turn, sequence) WHERE state = 'queued';
CREATE INDEX jobs_waiting_by_client ON jobs (client, turn) WHERE state = 'queued';
CREATE INDEX jobs_running ON jobs (turn) WHERE state = 'running';
)sql",
    // Keys of clients. Idempotency keys are their client's.
    R"sql(
CREATE TABLE api_keys (
  id TEXT PRIMARY KEY,
  name TEXT NOT NULL,
  hash TEXT NOT NULL,
  scopes TEXT NOT NULL,
  created_ms INTEGER NOT NULL,
  revoked_ms INTEGER,
  queued INTEGER NOT NULL,
  running INTEGER NOT NULL,
  bytes_per_day INTEGER NOT NULL,
  requests_per_minute INTEGER NOT NULL,
  priority INTEGER NOT NULL
) STRICT;
CREATE TABLE key_usage (
  owner TEXT NOT NULL,
  day INTEGER NOT NULL,
  jobs INTEGER NOT NULL,
  bytes INTEGER NOT NULL,
  PRIMARY KEY (owner, day)
) STRICT;
ALTER TABLE jobs ADD COLUMN owner TEXT NOT NULL DEFAULT '';
ALTER TABLE jobs ADD COLUMN most_running INTEGER NOT NULL DEFAULT 0;
CREATE INDEX jobs_by_owner ON jobs (owner, sequence);
CREATE INDEX jobs_by_owner_and_state ON jobs (owner, state, sequence);
CREATE INDEX jobs_running_by_client ON jobs (client) WHERE state = 'running';
CREATE TABLE owned_keys (
  owner TEXT NOT NULL,
  key TEXT NOT NULL,
  digest TEXT NOT NULL,
  job_id TEXT NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
  PRIMARY KEY (owner, key)
) STRICT;
INSERT INTO owned_keys SELECT '', key, digest, job_id FROM idempotency_keys;
DROP TABLE idempotency_keys;
ALTER TABLE owned_keys RENAME TO idempotency_keys;
CREATE INDEX idempotency_keys_by_job ON idempotency_keys (job_id);
)sql",
    // Models that go before their jobs, where a job came from, and who is told of its end.
    R"sql(
ALTER TABLE jobs ADD COLUMN model_kept INTEGER NOT NULL DEFAULT 1;
ALTER TABLE jobs ADD COLUMN request_id TEXT NOT NULL DEFAULT '';
ALTER TABLE jobs ADD COLUMN traceparent TEXT NOT NULL DEFAULT '';
ALTER TABLE jobs ADD COLUMN webhook TEXT NOT NULL DEFAULT '';
CREATE INDEX jobs_with_spent_models ON jobs (finished_clock_ms)
  WHERE state IN ('failed', 'cancelled') AND model_kept = 1;
CREATE TABLE deliveries (
  job_id TEXT PRIMARY KEY REFERENCES jobs (id) ON DELETE CASCADE,
  tries INTEGER NOT NULL,
  due_ms INTEGER NOT NULL
) STRICT;
CREATE INDEX deliveries_by_time ON deliveries (due_ms);
)sql",
    // Small files until they are synchronised.
    R"sql(
CREATE TABLE file_copies (
  number INTEGER PRIMARY KEY,
  job_id TEXT NOT NULL,
  name TEXT NOT NULL,
  bytes BLOB NOT NULL
) STRICT;
)sql",
};

DatabaseFinding examine(SQLite::Database& database) {
  const std::string fault = database.execAndGet("PRAGMA quick_check(1)").getString();
  if (fault != "ok") return {DatabaseState::kDamaged, {}, fault};
  if (database.execAndGet("SELECT COUNT(*) FROM sqlite_schema").getInt() == 0) {
    return {DatabaseState::kEmpty, {}, {}};
  }
  if (!database.tableExists("jobs") || !database.tableExists("idempotency_keys")) {
    return {DatabaseState::kForeign, {}, {}};
  }
  DatabaseFinding finding{DatabaseState::kOurs, {}, {}};
  if (database.tableExists("properties")) {
    SQLite::Statement query(database, "SELECT value FROM properties WHERE name = 'directory_id'");
    if (query.executeStep()) finding.directory_id = query.getColumn(0).getString();
  }
  return finding;
}

}  // namespace

const std::filesystem::path& create_job_database(const std::filesystem::path& file) {
  constexpr mode_t kOwner = S_IRUSR | S_IWUSR;
  const int created = ::open(file.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, kOwner);
  if (created < 0) throw std::runtime_error("cannot open the job database " + file.string());
  // An earlier version left it to the umask.
  ::fchmod(created, kOwner);
  ::close(created);
  return file;
}

void migrate_job_database(SQLite::Database& database) {
  const int version = database.execAndGet("PRAGMA user_version").getInt();
  const int newest = static_cast<int>(kMigrations.size());
  if (version > newest) {
    throw std::runtime_error("the job database has version " + std::to_string(version) +
                             ", this program knows up to " + std::to_string(newest) +
                             ": use a newer program or another data directory");
  }
  for (int step = version; step < newest; ++step) {
    SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
    database.exec(kMigrations[static_cast<std::size_t>(step)]);
    database.exec("PRAGMA user_version = " + std::to_string(step + 1));
    transaction.commit();
  }
}

bool has_newest_schema(SQLite::Database& database) {
  return database.execAndGet("PRAGMA user_version").getInt() ==
         static_cast<int>(kMigrations.size());
}

StoreError::Kind store_error_kind(const SQLite::Exception& exception) {
  switch (exception.getErrorCode()) {
    case SQLITE_BUSY:
    case SQLITE_LOCKED: return StoreError::Kind::kBusy;
    case SQLITE_FULL: return StoreError::Kind::kFull;
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB: return StoreError::Kind::kDamaged;
    default: return StoreError::Kind::kOther;
  }
}

DatabaseFinding examine_job_database(const std::filesystem::path& file) {
  const auto status = std::filesystem::symlink_status(file);
  if (!std::filesystem::exists(status)) return {};
  if (!std::filesystem::is_regular_file(status)) {
    throw std::runtime_error(file.string() + " should be a file, and no symbolic link");
  }
  try {
    // Writable, for a log that a killed server left is read into the database first.
    SQLite::Database database(file.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_NOFOLLOW);
    database.setBusyTimeout(kSqliteBusyPatienceMs);
    return examine(database);
  } catch (const SQLite::Exception& exception) {
    const int code = exception.getErrorCode();
    if (code == SQLITE_CORRUPT || code == SQLITE_NOTADB) {
      return {DatabaseState::kDamaged, {}, exception.what()};
    }
    throw;
  }
}

}  // namespace symcell::server
