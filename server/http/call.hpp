// One request on its way through a handler. For .cpp files: it brings httplib in.
#pragma once

#include <httplib.h>

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
  std::string id;                    // what stands for {id} in the route
  std::string_view error_code = {};  // of the library, if the answer has one

  [[nodiscard]] std::string header(const char* name) const {
    return request.get_header_value(name);
  }
  [[nodiscard]] std::string parameter(const char* name) const {
    return request.get_param_value(name);
  }
};

}  // namespace symcell::server
