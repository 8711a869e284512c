// Keys in the PostgreSQL database of the jobs.
#pragma once

#include <memory>
#include <string>

#include "server/keys/key_store.hpp"

namespace symcell::server {

class PostgresConnections;

class PostgresKeyStore final : public KeyStore {
 public:
  // Makes the tables where there are none.
  explicit PostgresKeyStore(const std::string& url);
  ~PostgresKeyStore() override;

  void insert(const ApiKey& key) override;
  bool revoke(std::string_view id, std::int64_t time_ms) override;
  [[nodiscard]] std::vector<ApiKey> list() override;

 private:
  std::unique_ptr<PostgresConnections> connections_;
};

}  // namespace symcell::server
