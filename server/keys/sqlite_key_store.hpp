// Keys in the embedded job database, by a connection of their own.
#pragma once

#include <filesystem>
#include <memory>

#include "server/keys/key_store.hpp"

namespace symcell::server {

class SqliteKeyStore final : public KeyStore {
 public:
  // The database must be there. `migrate`: whoever has the data directory to himself may do so; else
  // a database of another version is refused with std::runtime_error.
  SqliteKeyStore(const std::filesystem::path& database, bool migrate);
  ~SqliteKeyStore() override;

  void insert(const ApiKey& key) override;
  bool revoke(std::string_view id, std::int64_t time_ms) override;
  [[nodiscard]] std::vector<ApiKey> list() override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace symcell::server
