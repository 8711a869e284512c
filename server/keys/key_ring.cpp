#include "server/keys/key_ring.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

namespace symcell::server {
namespace {

constexpr std::chrono::milliseconds kFresh{1000};
// A key that was made just now should work at once, and unknown ones must not ask the store each time.
constexpr std::chrono::milliseconds kFreshForUnknown{50};
constexpr double kSecondsAMinute = 60;

}  // namespace

RateState TokenBucket::take(std::int64_t capacity, Clock::time_point now) {
  const double most = static_cast<double>(capacity);
  const double per_second = most / kSecondsAMinute;
  if (tokens_ < 0) {
    tokens_ = most;
  } else {
    const double passed = std::chrono::duration<double>(now - filled_).count();
    tokens_ = std::min(most, tokens_ + std::max(0.0, passed) * per_second);
  }
  filled_ = now;
  RateState state{.allowed = tokens_ >= 1, .limit = capacity};
  if (state.allowed) tokens_ -= 1;
  state.remaining = static_cast<std::int64_t>(tokens_);
  const double wanted = state.allowed ? most : 1;
  state.reset_s = static_cast<std::int64_t>(std::ceil((wanted - tokens_) / per_second));
  return state;
}

KeyRing::KeyRing(KeyStore& store, Logger& logger) : store_(store), logger_(logger) {
}

void KeyRing::refresh(std::chrono::milliseconds oldest) {
  const auto now = Clock::now();
  if (read_ != Clock::time_point{} && now - read_ < oldest) return;
  read_ = now;
  try {
    std::map<std::string, std::shared_ptr<const ApiKey>, std::less<>> keys;
    for (ApiKey& key : store_.list()) {
      std::string id = key.id;
      keys.emplace(std::move(id), std::make_shared<const ApiKey>(std::move(key)));
    }
    keys_ = std::move(keys);
    known_ = true;
  } catch (const std::exception& exception) {
    logger_.error("keys_not_read", {{"what", exception.what()}});
  }
}

std::shared_ptr<const ApiKey> KeyRing::find(std::string_view text) {
  const auto parts = parse_key(text);
  if (!parts) return nullptr;
  const std::lock_guard lock(mutex_);
  refresh(kFresh);
  auto found = keys_.find(parts->id);
  if (found == keys_.end()) {
    refresh(kFreshForUnknown);
    found = keys_.find(parts->id);
  }
  if (found == keys_.end() || !same_hash(found->second->hash, parts->hash)) return nullptr;
  return found->second->revoked_ms ? nullptr : found->second;
}

bool KeyRing::any() {
  const std::lock_guard lock(mutex_);
  refresh(kFresh);
  return !known_ || !keys_.empty();
}

std::vector<ApiKey> KeyRing::all() {
  const std::lock_guard lock(mutex_);
  refresh(kFresh);
  std::vector<ApiKey> keys;
  for (const auto& [id, key] : keys_) keys.push_back(*key);
  return keys;
}

RateState KeyRing::take_turn(const ApiKey& key) {
  if (key.limits.requests_per_minute == 0) return {};
  const std::lock_guard lock(mutex_);
  return buckets_[key.id].take(key.limits.requests_per_minute, Clock::now());
}

}  // namespace symcell::server
