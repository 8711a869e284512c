#include "server/http/site_policy.hpp"

#include <arpa/inet.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <utility>

namespace symcell::server {
namespace {

std::string lower(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

// Without the port; brackets of an IPv6 address stay.
std::string_view name_of(std::string_view host) {
  const std::size_t bracket = host.rfind(']');
  const std::size_t colon = host.find(':', bracket == std::string_view::npos ? 0 : bracket);
  return host.substr(0, colon);
}

bool is_ipv4(std::string_view name) {
  in_addr address{};
  return ::inet_pton(AF_INET, std::string(name).c_str(), &address) == 1;
}

bool is_ipv6(std::string_view name) {
  if (name.size() < 3 || name.front() != '[' || name.back() != ']') return false;
  in6_addr address{};
  return ::inet_pton(AF_INET6, std::string(name.substr(1, name.size() - 2)).c_str(), &address) == 1;
}

bool is_loopback(std::string_view name) {
  return name == "localhost" || name.ends_with(".localhost") || name == "[::1]" ||
         (is_ipv4(name) && name.starts_with("127."));
}

std::string machine_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? lower(name.data()) : std::string();
}

// "https://part.example" is "part.example:443".
std::string authority_of(std::string_view origin) {
  const std::size_t scheme_end = origin.find("://");
  if (scheme_end == std::string_view::npos) return {};
  const std::string_view scheme = origin.substr(0, scheme_end);
  std::string authority = lower(std::string(origin.substr(scheme_end + 3)));
  if (name_of(authority).size() == authority.size()) {
    authority += scheme == "https" ? ":443" : ":80";
  }
  return authority;
}

// Host leaves out the port that its scheme implies, and before a proxy the scheme is not known.
bool is_same_site(std::string_view host, std::string_view origin) {
  const std::string authority = authority_of(origin);
  if (authority.empty() || host.empty()) return false;
  if (name_of(host).size() == host.size()) {
    return authority == std::string(host) + ":80" || authority == std::string(host) + ":443";
  }
  return authority == host;
}

}  // namespace

SitePolicy::SitePolicy(std::string bound,
                       std::vector<std::string> hosts,
                       std::vector<std::string> origins)
    : bound_(lower(std::move(bound))),
      bound_to_all_(bound_ == "0.0.0.0" || bound_ == "::" || bound_ == "[::]"),
      hosts_(std::move(hosts)),
      origins_(std::move(origins)) {
  if (bound_to_all_) machine_ = machine_name();
  for (std::string& host : hosts_) host = lower(std::move(host));
}

bool SitePolicy::allows_host(std::string_view asked) const {
  const std::string host = lower(std::string(asked));
  const std::string_view name = name_of(host);
  if (name.empty() || is_loopback(name) || name == bound_ || name == "[" + bound_ + "]")
    return true;
  // A page reached by a number has been given no name to mislead with.
  if (bound_to_all_ && (is_ipv4(name) || is_ipv6(name) || name == machine_)) return true;
  return std::ranges::any_of(hosts_, [&](const std::string& allowed) {
    return allowed == "*" || allowed == name || allowed == host;
  });
}

bool SitePolicy::allows_change(std::string_view asked,
                               std::string_view origin,
                               std::string_view fetch_site) const {
  const std::string host = lower(std::string(asked));
  const bool configured = std::ranges::any_of(
      origins_, [&](const std::string& allowed) { return allowed == "*" || allowed == origin; });
  if (!origin.empty()) return configured || is_same_site(host, origin);
  return fetch_site.empty() || fetch_site == "same-origin" || fetch_site == "none" || configured;
}

std::string SitePolicy::shared_with(std::string_view origin) const {
  for (const std::string& allowed : origins_) {
    if (allowed == "*" || origins_.size() == 1 || allowed == origin) return allowed;
  }
  return {};
}

}  // namespace symcell::server
