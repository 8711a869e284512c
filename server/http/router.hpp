// From method and path to a handler, and the one wrapper around every handler.
//
// Routes are plain templates ("/v1/jobs/{id}/cell"): httplib's own routes are regular expressions
// and know neither 405 nor names for metrics, so it gets a single catch-all.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "server/base/log.hpp"
#include "server/base/metrics.hpp"

namespace symcell::server {

struct Call;
class Gate;
using RouteHandler = std::function<void(Call&)>;

class Router {
 public:
  // Both must outlive the router.
  Router(Metrics& metrics, Logger& logger) : metrics_(metrics), logger_(logger) {}

  // Asked before every handler; false: the call is answered. The gate must outlive the router.
  void set_gate(const Gate* gate) { gate_ = gate; }
  // `path`: segments between slashes, one of which may be "{id}". GET serves HEAD too.
  void add(std::string method, std::string path, RouteHandler handler);

  // Answers the call whatever happens: unknown paths with 404, other methods with 405 and Allow,
  // exceptions with 500 (507 if the disk is full, 503 if the store fails).
  void dispatch(Call& call) const;
  // The same for a call that is resumed.
  void resume(Call& call, const RouteHandler& handler) const;

 private:
  struct Route {
    std::string method;
    std::string path;
    std::vector<std::string> segments;
    RouteHandler handler;
  };

  void run(const Route& route, Call& call) const;
  void guard(Call& call, const std::function<void()>& work) const;
  void refuse_method(Call& call, const std::string& allowed) const;

  Metrics& metrics_;
  Logger& logger_;
  const Gate* gate_ = nullptr;
  std::vector<Route> routes_;
};

}  // namespace symcell::server
