#include "server/keys/api_key.hpp"

#include <sodium.h>

#include <algorithm>
#include <array>
#include <stdexcept>

namespace symcell::server {
namespace {

constexpr std::string_view kPrefix = "symcell_";
constexpr std::size_t kSecretBytes = 32;
constexpr int kSecretVariant = sodium_base64_VARIANT_URLSAFE_NO_PADDING;
constexpr std::size_t kSecretChars = sodium_base64_ENCODED_LEN(kSecretBytes, kSecretVariant) - 1;
constexpr std::size_t kHashBytes = crypto_generichash_BYTES;

void start_sodium() {
  if (::sodium_init() < 0) throw std::runtime_error("libsodium cannot start");
}

std::string hex(const unsigned char* bytes, std::size_t count) {
  std::string text(2 * count + 1, '\0');
  ::sodium_bin2hex(text.data(), text.size(), bytes, count);
  text.pop_back();
  return text;
}

std::string hash_of(std::string_view secret) {
  start_sodium();
  std::array<unsigned char, kHashBytes> hash{};
  ::crypto_generichash(hash.data(), hash.size(),
                       reinterpret_cast<const unsigned char*>(secret.data()), secret.size(),
                       nullptr, 0);
  return hex(hash.data(), hash.size());
}

}  // namespace

std::string_view key_scope_name(KeyScope scope) {
  switch (scope) {
    case KeyScope::kSubmit: return "submit";
    case KeyScope::kRead: return "read";
    case KeyScope::kAdmin: return "admin";
  }
  return "";
}

std::optional<KeyScope> key_scope_from_name(std::string_view name) {
  for (const KeyScope scope : kAllKeyScopes) {
    if (key_scope_name(scope) == name) return scope;
  }
  return std::nullopt;
}

bool ApiKey::may(KeyScope scope) const {
  return std::ranges::any_of(scopes,
                             [&](KeyScope own) { return own == scope || own == KeyScope::kAdmin; });
}

NewKey make_key() {
  start_sodium();
  std::array<unsigned char, kKeyIdDigits / 2> id{};
  std::array<unsigned char, kSecretBytes> secret{};
  ::randombytes_buf(id.data(), id.size());
  ::randombytes_buf(secret.data(), secret.size());
  std::string text(kSecretChars + 1, '\0');
  ::sodium_bin2base64(text.data(), text.size(), secret.data(), secret.size(), kSecretVariant);
  text.pop_back();
  ::sodium_memzero(secret.data(), secret.size());
  NewKey key;
  key.id = hex(id.data(), id.size());
  key.hash = hash_of(text);
  key.text = std::string(kPrefix) + key.id + "_" + text;
  return key;
}

std::optional<KeyParts> parse_key(std::string_view text) {
  constexpr std::size_t kLength = kPrefix.size() + kKeyIdDigits + 1 + kSecretChars;
  if (text.size() != kLength || !text.starts_with(kPrefix)) return std::nullopt;
  const std::string_view id = text.substr(kPrefix.size(), kKeyIdDigits);
  if (text[kPrefix.size() + kKeyIdDigits] != '_') return std::nullopt;
  return KeyParts{std::string(id), hash_of(text.substr(kLength - kSecretChars))};
}

bool same_hash(std::string_view one, std::string_view other) {
  return one.size() == other.size() && ::sodium_memcmp(one.data(), other.data(), one.size()) == 0;
}

std::optional<std::vector<KeyScope>> parse_scopes(std::string_view text) {
  std::vector<KeyScope> scopes;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(','), text.size());
    const auto scope = key_scope_from_name(text.substr(0, end));
    if (!scope) return std::nullopt;
    if (std::ranges::find(scopes, *scope) == scopes.end()) scopes.push_back(*scope);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  if (scopes.empty()) return std::nullopt;
  return scopes;
}

std::string scopes_text(const std::vector<KeyScope>& scopes) {
  std::string text;
  for (const KeyScope scope : scopes) {
    if (!text.empty()) text += ",";
    text += key_scope_name(scope);
  }
  return text;
}

}  // namespace symcell::server
