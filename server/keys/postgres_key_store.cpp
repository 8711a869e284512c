#include "server/keys/postgres_key_store.hpp"

#include "server/jobs/postgres_connections.hpp"

namespace symcell::server {
namespace {
// One request reads keys at a time, and `symcell keys` is one process.
constexpr std::size_t kConnections = 2;
}  // namespace

PostgresKeyStore::PostgresKeyStore(const std::string& url)
    : connections_(std::make_unique<PostgresConnections>(url, kConnections)) {
  migrate_postgres(*connections_);
}

PostgresKeyStore::~PostgresKeyStore() = default;

void PostgresKeyStore::insert(const ApiKey& key) {
  connections_->transact([&](pqxx::work& transaction) {
    transaction.exec_params(
        "INSERT INTO symcell_api_keys (id, name, hash, scopes, created_ms, queued, running, "
        "bytes_per_day, requests_per_minute, priority) "
        "VALUES ($1, $2, $3, $4, symcell_now_ms(), $5, $6, $7, $8, $9)",
        key.id, key.name, key.hash, scopes_text(key.scopes), key.limits.queued, key.limits.running,
        key.limits.bytes_per_day, key.limits.requests_per_minute, key.priority);
  });
}

bool PostgresKeyStore::revoke(std::string_view id, std::int64_t /*time_ms*/) {
  return connections_->transact([&](pqxx::work& transaction) -> bool {
    return transaction
               .exec_params(
                   "UPDATE symcell_api_keys SET revoked_ms = COALESCE(revoked_ms, "
                   "symcell_now_ms()) WHERE id = $1",
                   std::string(id))
               .affected_rows() > 0;
  });
}

std::vector<ApiKey> PostgresKeyStore::list() {
  return connections_->transact([&](pqxx::work& transaction) {
    std::vector<ApiKey> keys;
    for (const auto& row :
         transaction.exec("SELECT id, name, hash, scopes, created_ms, revoked_ms, queued, running, "
                          "bytes_per_day, requests_per_minute, priority FROM symcell_api_keys "
                          "ORDER BY created_ms, id")) {
      ApiKey key;
      key.id = row[0].as<std::string>();
      key.name = row[1].as<std::string>();
      key.hash = row[2].as<std::string>();
      key.scopes = parse_scopes(row[3].as<std::string>()).value_or(std::vector<KeyScope>());
      key.created_ms = row[4].as<std::int64_t>();
      if (!row[5].is_null()) key.revoked_ms = row[5].as<std::int64_t>();
      key.limits = {row[6].as<std::int64_t>(), row[7].as<std::int64_t>(), row[8].as<std::int64_t>(),
                    row[9].as<std::int64_t>()};
      key.priority = row[10].as<std::int32_t>();
      keys.push_back(std::move(key));
    }
    return keys;
  });
}

}  // namespace symcell::server
