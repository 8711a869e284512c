// httplib's server with what it lacks: connections that wait without a thread, limits on slow
// clients, prompt stop, request ids, access log, and connections that are closed without loss of the
// answer.
//
// A request gets a thread when its head and, if small, its body have come. Probes have threads of
// their own; what may wait long, for the rest of a body or for a slow reader, has others than what is
// answered at once; what waits for a job has none until there is something to say. So neither slow clients
// nor waiting ones hold up the rest.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "server/base/log.hpp"
#include "server/base/metrics.hpp"
#include "server/http/lobby.hpp"
#include "server/http/router.hpp"

namespace symcell::server {

struct HttpSettings {
  std::string host = "127.0.0.1";
  int port = 8080;                    // 0: any free one
  std::size_t threads = 16;           // for what is answered at once
  std::size_t patient_threads = 512;  // for what waits for its client
  std::size_t max_waiting = 4096;  // calls that wait for a job, and event streams: without a thread
  LobbyLimits lobby;
  std::chrono::milliseconds pace_window{20'000};  // see ConnectionLimits
  std::size_t max_body_bytes = 0;
  std::vector<std::string> cors_origins = {};   // see SitePolicy
  std::vector<std::string> allowed_hosts = {};  // see SitePolicy
  TlsFiles tls = {};
};

class HttpServer {
 public:
  // `router`, `metrics` and `logger` must outlive the server.
  HttpServer(const HttpSettings& settings, const Router& router, Metrics& metrics, Logger& logger);
  // Requires: run() has returned or was never called.
  ~HttpServer();

  // Binds; returns the port.  Throws std::runtime_error if the address cannot be had.
  int bind();
  // Serves until stop(); then requests under way are finished first.
  void run();
  void stop();
  // Reads certificate and key again; throws where they are no good, and goes on with what it has.
  void reload_tls();

  // Requests being served.
  [[nodiscard]] const std::atomic<std::size_t>& in_flight() const { return in_flight_; }

 private:
  class Impl;

  std::atomic<std::size_t> in_flight_{0};
  std::unique_ptr<Impl> impl_;
};

}  // namespace symcell::server
