// The whole service put together: jobs, handlers, HTTP server.
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

#include "server/base/log.hpp"
#include "server/http/gate.hpp"
#include "server/http/http_server.hpp"
#include "server/http/webhook_rules.hpp"
#include "server/jobs/job_service.hpp"

namespace symcell::server {

// What a server does of what all do together.
enum class ServerRole : std::uint8_t {
  kAll,
  kApi,     // answers callers, and leaves meshing to others
  kWorker,  // meshes, and answers probes alone
};

struct ServiceSettings {
  ServerRole role = ServerRole::kAll;
  HttpSettings http;
  AccessRules access;
  WebhookSettings webhooks;
  JobLimits jobs;
  std::filesystem::path data_directory;
  std::chrono::milliseconds grace{10'000};  // for running jobs when the server stops
};

class Service {
 public:
  // Opens the data directory; throws std::runtime_error where that fails. `engine` and `logger`
  // must outlive the service.
  Service(const ServiceSettings& settings, JobEngine& engine, Logger& logger);
  ~Service();

  // Binds, takes up stored jobs and serves from other threads; returns the port.  Throws
  // std::runtime_error if the address cannot be had.
  int start();

  // In this order: not ready and no new jobs; running jobs get the grace period, then are left for
  // the next start; streams end; requests under way are finished; threads are joined.
  // False: an engine ignores its cancellation and its thread cannot be joined; the process should
  // exit without destroying the service.  All jobs are safe either way.
  [[nodiscard]] bool stop();

  // See HttpServer.
  void reload_tls();

  [[nodiscard]] JobService& jobs();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace symcell::server
