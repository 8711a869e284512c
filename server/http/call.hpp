// One request on its way through a handler. For .cpp files: it brings httplib in.
#pragma once

#include <httplib.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <string>
#include <string_view>

#include "server/http/connection.hpp"

namespace symcell::server {

struct Call {
  const httplib::Request& request;
  httplib::Response& response;
  // Reads the body; null where httplib sees none (GET, HEAD, OPTIONS).
  const httplib::ContentReader* body = nullptr;
  Exchange& exchange;
  // Of the target, decoded. httplib's own takes what follows a parameter's last "=" for its value.
  std::multimap<std::string, std::string> query;
  std::string id;                    // what stands for {id} in the route
  std::string_view error_code = {};  // of the library, if the answer has one

  [[nodiscard]] std::string header(const char* name) const {
    return request.get_header_value(name);
  }
  [[nodiscard]] std::string parameter(const char* name) const {
    const auto found = query.find(name);
    return found == query.end() ? std::string() : found->second;
  }
  [[nodiscard]] bool has_parameter(const std::string& name) const { return query.contains(name); }
};

// "a=1&b=c=2" -> a: "1", b: "c=2"; what follows a "?" in `target`, decoded.
[[nodiscard]] inline std::multimap<std::string, std::string> parse_query(std::string_view target) {
  std::multimap<std::string, std::string> query;
  const std::size_t begin = target.find('?');
  if (begin == std::string_view::npos) return query;
  const std::string_view text = target.substr(begin + 1, target.find('#') - begin - 1);
  const auto decoded = [](std::string_view part) {
    return httplib::detail::decode_url(std::string(part), true);
  };
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('&', at), text.size());
    const std::string_view pair = text.substr(at, end - at);
    const std::size_t sign = std::min(pair.find('='), pair.size());
    if (!pair.empty()) {
      query.emplace(decoded(pair.substr(0, sign)),
                    decoded(pair.substr(std::min(sign + 1, pair.size()))));
    }
    at = end + 1;
  }
  return query;
}

}  // namespace symcell::server
