// The keys that a server knows at present, and how fast each may ask.
//
// Keys are read from their store once a second at most: a revoked one is refused within that time. If
// the store fails, those read last stay valid.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "server/base/log.hpp"
#include "server/keys/key_store.hpp"

namespace symcell::server {

// Where a client stands against its rate.
struct RateState {
  bool allowed = true;
  std::int64_t limit = 0;      // requests a minute; 0: none, and the rest means nothing
  std::int64_t remaining = 0;  // that may come now
  std::int64_t reset_s = 0;    // until one more may, or all may again
};

// Holds `capacity` tokens at most, and gets as many a minute.
class TokenBucket {
 public:
  using Clock = std::chrono::steady_clock;

  // Takes a token, or says when there will be one.
  [[nodiscard]] RateState take(std::int64_t capacity, Clock::time_point now);

 private:
  double tokens_ = -1;  // below 0: never used, full
  Clock::time_point filled_{};
};

class KeyRing {
 public:
  using Clock = std::chrono::steady_clock;

  // Both must outlive the ring.
  KeyRing(KeyStore& store, Logger& logger);

  // The key that this is the text of; null: none, or a revoked one.
  [[nodiscard]] std::shared_ptr<const ApiKey> find(std::string_view text);
  // Whether there is any, revoked ones included; true as long as that could not be found out.
  [[nodiscard]] bool any();
  [[nodiscard]] std::vector<ApiKey> all();
  [[nodiscard]] RateState take_turn(const ApiKey& key);

 private:
  // Requires: mutex_ held.
  void refresh(std::chrono::milliseconds oldest);

  KeyStore& store_;
  Logger& logger_;
  std::mutex mutex_;  // guards all below
  std::map<std::string, std::shared_ptr<const ApiKey>, std::less<>> keys_;
  std::map<std::string, TokenBucket, std::less<>> buckets_;
  Clock::time_point read_{};
  bool known_ = false;  // they were read once
};

}  // namespace symcell::server
