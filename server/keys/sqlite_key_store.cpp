#include "server/keys/sqlite_key_store.hpp"

#include <SQLiteCpp/SQLiteCpp.h>

#include <mutex>
#include <stdexcept>
#include <string>

#include "server/jobs/sqlite_schema.hpp"

namespace symcell::server {

struct SqliteKeyStore::Impl {
  explicit Impl(const std::filesystem::path& file)
      : database(file.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_NOFOLLOW) {
    database.setBusyTimeout(kSqliteBusyPatienceMs);
    database.exec("PRAGMA synchronous = FULL");
  }

  std::mutex mutex;  // guards `database`
  SQLite::Database database;
};

SqliteKeyStore::SqliteKeyStore(const std::filesystem::path& database, bool migrate)
    : impl_(std::make_unique<Impl>(database)) {
  if (migrate) {
    migrate_job_database(impl_->database);
  } else if (!has_newest_schema(impl_->database)) {
    throw std::runtime_error(
        "the job database is of another version, and a server uses it: stop that server first");
  }
}

SqliteKeyStore::~SqliteKeyStore() = default;

void SqliteKeyStore::insert(const ApiKey& key) {
  const std::lock_guard lock(impl_->mutex);
  translate_sqlite_errors([&] {
    SQLite::Statement insert(
        impl_->database,
        "INSERT INTO api_keys (id, name, hash, scopes, created_ms, queued, running, "
        "bytes_per_day, requests_per_minute, priority) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    insert.bind(1, key.id);
    insert.bind(2, key.name);
    insert.bind(3, key.hash);
    insert.bind(4, scopes_text(key.scopes));
    insert.bind(5, key.created_ms);
    insert.bind(6, key.limits.queued);
    insert.bind(7, key.limits.running);
    insert.bind(8, key.limits.bytes_per_day);
    insert.bind(9, key.limits.requests_per_minute);
    insert.bind(10, key.priority);
    insert.exec();
  });
}

bool SqliteKeyStore::revoke(std::string_view id, std::int64_t time_ms) {
  const std::lock_guard lock(impl_->mutex);
  return translate_sqlite_errors([&] {
    SQLite::Statement update(
        impl_->database, "UPDATE api_keys SET revoked_ms = COALESCE(revoked_ms, ?) WHERE id = ?");
    update.bind(1, time_ms);
    update.bind(2, std::string(id));
    return update.exec() > 0;
  });
}

std::vector<ApiKey> SqliteKeyStore::list() {
  const std::lock_guard lock(impl_->mutex);
  return translate_sqlite_errors([&] {
    std::vector<ApiKey> keys;
    SQLite::Statement query(
        impl_->database,
        "SELECT id, name, hash, scopes, created_ms, revoked_ms, queued, running, bytes_per_day, "
        "requests_per_minute, priority FROM api_keys ORDER BY created_ms, id");
    while (query.executeStep()) {
      ApiKey key;
      key.id = query.getColumn(0).getString();
      key.name = query.getColumn(1).getString();
      key.hash = query.getColumn(2).getString();
      // A scope that a newer version knows gives nothing here.
      key.scopes = parse_scopes(query.getColumn(3).getString()).value_or(std::vector<KeyScope>());
      key.created_ms = query.getColumn(4).getInt64();
      if (!query.getColumn(5).isNull()) key.revoked_ms = query.getColumn(5).getInt64();
      key.limits = {query.getColumn(6).getInt64(), query.getColumn(7).getInt64(),
                    query.getColumn(8).getInt64(), query.getColumn(9).getInt64()};
      key.priority = query.getColumn(10).getInt();
      keys.push_back(std::move(key));
    }
    return keys;
  });
}

}  // namespace symcell::server
