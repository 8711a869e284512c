// Where keys are kept: beside the jobs, so that every server of a store knows the same ones.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "server/keys/api_key.hpp"

namespace symcell::server {

class KeyStore {
 public:
  virtual ~KeyStore() = default;

  // All may throw StoreError (server/jobs/job_store.hpp). Any thread may call.
  virtual void insert(const ApiKey& key) = 0;
  // False: unknown. A revoked key stays in the list: its jobs bear its id.
  virtual bool revoke(std::string_view id, std::int64_t time_ms) = 0;
  // Oldest first, revoked ones included.
  [[nodiscard]] virtual std::vector<ApiKey> list() = 0;
};

}  // namespace symcell::server
