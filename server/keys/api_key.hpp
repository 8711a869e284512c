// Keys by which clients are known: what they may do, and how much of it.
//
// The text of a key is symcell_<id>_<secret>. The secret has 256 random bits, is shown once and kept
// as its BLAKE2b hash alone; nothing slow is needed against guessing at that length. The id is no
// secret: it stands in logs and lists.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace symcell::server {

enum class KeyScope : std::uint8_t {
  kSubmit,  // send models, cancel, delete and repeat own jobs
  kRead,    // see own jobs and fetch their results
  kAdmin,   // all of that with everybody's jobs, and the list of keys
};

inline constexpr KeyScope kAllKeyScopes[] = {KeyScope::kSubmit, KeyScope::kRead, KeyScope::kAdmin};

[[nodiscard]] std::string_view key_scope_name(KeyScope scope);
[[nodiscard]] std::optional<KeyScope> key_scope_from_name(std::string_view name);

// Zero: no limit but the server's own.
struct KeyLimits {
  std::int64_t queued = 0;               // jobs that wait
  std::int64_t running = 0;              // jobs at once
  std::int64_t bytes_per_day = 0;        // of models, from midnight to midnight, UTC
  std::int64_t requests_per_minute = 0;  // of each server; as many may come at once
};

struct ApiKey {
  std::string id;    // kKeyIdDigits hexadecimal digits
  std::string name;  // whose it is, for people
  std::string hash;  // of the secret, hexadecimal
  std::vector<KeyScope> scopes;
  KeyLimits limits;
  std::int32_t priority = 1;  // jobs for one of a key of priority 1 while both wait
  std::int64_t created_ms = 0;
  std::optional<std::int64_t> revoked_ms;

  // kAdmin includes the others.
  [[nodiscard]] bool may(KeyScope scope) const;
};

inline constexpr std::size_t kKeyIdDigits = 12;
inline constexpr std::int32_t kMostPriority = 100;

struct NewKey {
  std::string text;  // to be shown, once
  std::string id;
  std::string hash;
};

[[nodiscard]] NewKey make_key();

struct KeyParts {
  std::string id;
  std::string hash;  // of the secret that came
};

// nullopt: not of the form of a key.
[[nodiscard]] std::optional<KeyParts> parse_key(std::string_view text);

// In a time that does not depend on where they differ.
[[nodiscard]] bool same_hash(std::string_view one, std::string_view other);

// "submit,read"; nullopt: an unknown name, or none.
[[nodiscard]] std::optional<std::vector<KeyScope>> parse_scopes(std::string_view text);
[[nodiscard]] std::string scopes_text(const std::vector<KeyScope>& scopes);

}  // namespace symcell::server
