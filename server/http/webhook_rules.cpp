#include "server/http/webhook_rules.hpp"

#include <arpa/inet.h>
#include <netdb.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>

#include "server/http/header_values.hpp"

namespace symcell::server {
namespace {

constexpr std::size_t kMostAddressChars = 2048;
constexpr std::size_t kLeastSecretBytes = 24;  // by Standard Webhooks

struct Net4 {
  std::uint32_t base;
  int bits;
};

// Not of the open internet: RFC 6890 and multicast.
constexpr std::array<Net4, 14> kOwnNets{{{0x00000000, 8},
                                         {0x0a000000, 8},
                                         {0x64400000, 10},
                                         {0x7f000000, 8},
                                         {0xa9fe0000, 16},
                                         {0xac100000, 12},
                                         {0xc0000000, 24},
                                         {0xc0000200, 24},
                                         {0xc0a80000, 16},
                                         {0xc6120000, 15},
                                         {0xc6336400, 24},
                                         {0xcb007100, 24},
                                         {0xe0000000, 4},
                                         {0xf0000000, 4}}};

bool is_public4(std::uint32_t address) {
  return std::ranges::none_of(kOwnNets, [&](const Net4& net) {
    const std::uint32_t mask = ~std::uint32_t{0} << (32 - net.bits);
    return (address & mask) == net.base;
  });
}

bool is_public6(const in6_addr& address) {
  const auto* b = static_cast<const std::uint8_t*>(address.s6_addr);
  const auto embedded = [&](int at) {
    return std::uint32_t{b[at]} << 24U | std::uint32_t{b[at + 1]} << 16U |
           std::uint32_t{b[at + 2]} << 8U | b[at + 3];
  };
  if (IN6_IS_ADDR_V4MAPPED(&address)) return is_public4(embedded(12));
  // Global unicast alone; of it not documentation, and not 6to4, which embeds any address.
  if ((b[0] & 0xe0U) != 0x20U) return false;
  if (b[0] == 0x20 && b[1] == 0x01 && b[2] == 0x0d && b[3] == 0xb8) return false;
  if (b[0] == 0x20 && b[1] == 0x01 && b[2] == 0x00 && b[3] == 0x00) return false;  // Teredo
  return !(b[0] == 0x20 && b[1] == 0x02);
}

std::string base64(const unsigned char* bytes, std::size_t count) {
  std::string text(4 * ((count + 2) / 3) + 1, '\0');
  const int length = ::EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()), bytes,
                                       static_cast<int>(count));
  text.resize(static_cast<std::size_t>(length));
  return text;
}

bool is_plain(std::string_view text) {
  return std::ranges::all_of(text, [](char c) { return c > 0x20 && c < 0x7f; });
}

}  // namespace

std::optional<WebhookTarget> parse_webhook_target(const std::string& address) {
  WebhookTarget target;
  std::string_view rest = address;
  if (rest.size() > kMostAddressChars || !is_plain(rest)) return std::nullopt;
  if (rest.starts_with("https://")) {
    target.tls = true;
    rest.remove_prefix(8);
  } else if (rest.starts_with("http://")) {
    rest.remove_prefix(7);
  } else {
    return std::nullopt;
  }
  const std::size_t end = std::min(rest.find_first_of("/?#"), rest.size());
  std::string_view authority = rest.substr(0, end);
  rest.remove_prefix(end);
  if (authority.find('@') != std::string_view::npos || rest.find('#') != std::string_view::npos) {
    return std::nullopt;
  }
  target.path = rest.starts_with('/') ? std::string(rest) : "/" + std::string(rest);
  target.port = target.tls ? 443 : 80;
  std::size_t name_end = authority.size();
  if (authority.starts_with('[')) {
    name_end = authority.find(']');
    if (name_end == std::string_view::npos) return std::nullopt;
    target.host = authority.substr(1, name_end - 1);
    ++name_end;
  } else {
    name_end = std::min(authority.find(':'), authority.size());
    target.host = authority.substr(0, name_end);
  }
  if (name_end < authority.size()) {
    if (authority[name_end] != ':') return std::nullopt;
    const auto port = parse_whole_number(authority.substr(name_end + 1));
    if (!port || *port < 1 || *port > 65535) return std::nullopt;
    target.port = static_cast<int>(*port);
  }
  std::ranges::transform(target.host, target.host.begin(), [](unsigned char c) {
    return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  });
  if (target.host.empty()) return std::nullopt;
  return target;
}

bool is_public_address(const std::string& numeric) {
  in_addr four{};
  if (::inet_pton(AF_INET, numeric.c_str(), &four) == 1) return is_public4(ntohl(four.s_addr));
  in6_addr six{};
  return ::inet_pton(AF_INET6, numeric.c_str(), &six) == 1 && is_public6(six);
}

bool WebhookRules::allows_host(std::string_view host) const {
  return std::ranges::any_of(settings_.hosts, [&](const std::string& allowed) {
    if (allowed == "*" || allowed == host) return true;
    return allowed.starts_with("*.") && host.ends_with(std::string_view(allowed).substr(1));
  });
}

std::string WebhookRules::refusal_of(const std::string& address) const {
  if (settings_.hosts.empty() || settings_.secret.empty()) {
    return "this server sends no webhooks; it is started with --webhook-host and "
           "--webhook-secret-file where it does";
  }
  const auto target = parse_webhook_target(address);
  if (!target) return "a webhook's address is http:// or https://, a host, and a path";
  if (!allows_host(target->host)) {
    return "the server may not call " + target->host + "; --webhook-host lists whom it may call";
  }
  in6_addr ignored{};
  const bool numeric = ::inet_pton(AF_INET, target->host.c_str(), &ignored) == 1 ||
                       ::inet_pton(AF_INET6, target->host.c_str(), &ignored) == 1;
  if (numeric && !settings_.allow_private && !is_public_address(target->host)) {
    return target->host + " is an address of a private network";
  }
  return {};
}

std::optional<std::string> WebhookRules::resolve(const WebhookTarget& target,
                                                 std::string& fault) const {
  if (!allows_host(target.host)) {
    fault = target.host + " is not on the list any more";
    return std::nullopt;
  }
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* raw = nullptr;
  if (::getaddrinfo(target.host.c_str(), nullptr, &hints, &raw) != 0) {
    fault = target.host + " has no address";
    return std::nullopt;
  }
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> found(raw, ::freeaddrinfo);
  std::optional<std::string> first;
  for (const addrinfo* entry = raw; entry != nullptr; entry = entry->ai_next) {
    std::array<char, NI_MAXHOST> text{};
    if (::getnameinfo(entry->ai_addr, entry->ai_addrlen, text.data(), text.size(), nullptr, 0,
                      NI_NUMERICHOST) != 0) {
      continue;
    }
    // One private address among public ones is as good as none.
    if (!settings_.allow_private && !is_public_address(text.data())) {
      fault = target.host + " is in a private network";
      return std::nullopt;
    }
    if (!first) first = text.data();
  }
  if (!first) fault = target.host + " has no address";
  return first;
}

std::optional<std::string> parse_webhook_secret(std::string_view text) {
  constexpr std::string_view kPrefix = "whsec_";
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r' || text.back() == ' ')) {
    text.remove_suffix(1);
  }
  if (!text.starts_with(kPrefix)) return std::nullopt;
  text.remove_prefix(kPrefix.size());
  if (text.size() % 4 != 0) return std::nullopt;
  std::string secret(text.size() / 4 * 3 + 1, '\0');
  const int length = ::EVP_DecodeBlock(reinterpret_cast<unsigned char*>(secret.data()),
                                       reinterpret_cast<const unsigned char*>(text.data()),
                                       static_cast<int>(text.size()));
  if (length < 0) return std::nullopt;
  const auto padding = static_cast<std::size_t>(std::ranges::count(text, '='));
  secret.resize(static_cast<std::size_t>(length) - padding);
  if (secret.size() < kLeastSecretBytes) return std::nullopt;
  return secret;
}

std::string webhook_signature(const std::string& secret,
                              const std::string& id,
                              const std::string& timestamp,
                              const std::string& body) {
  std::string message = id;
  message.append(".").append(timestamp).append(".").append(body);
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int length = 0;
  ::HMAC(::EVP_sha256(), secret.data(), static_cast<int>(secret.size()),
         reinterpret_cast<const unsigned char*>(message.data()), message.size(), digest.data(),
         &length);
  return "v1," + base64(digest.data(), length);
}

}  // namespace symcell::server
