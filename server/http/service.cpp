#include "server/http/service.hpp"

#include <algorithm>
#include <thread>

#include "server/http/router.hpp"
#include "server/http/service_context.hpp"

namespace symcell::server {
namespace {

// Half of those threads always remain for uploads and downloads.
std::size_t long_call_places(std::size_t threads) {
  return std::max<std::size_t>(1, threads / 2);
}

std::size_t inspection_places(std::size_t threads) {
  return std::max<std::size_t>(1, threads / 4);
}

void declare_metrics(Metrics& metrics) {
  metrics.declare_counter("symcell_http_requests_total", "Requests by route, method and status.");
  metrics.declare_histogram("symcell_http_request_duration_seconds",
                            "Time from the request's first byte to the answer's last.",
                            {0.005, 0.025, 0.1, 0.5, 1, 5, 30, 120});
  metrics.declare_counter("symcell_http_refused_connections_total",
                          "Connections refused because all threads and places were taken.");
  metrics.declare_counter("symcell_request_errors_total",
                          "Requests refused for their model or options, by error code.");
  metrics.declare_counter("symcell_job_errors_total", "Failed jobs by error code.");
  metrics.declare_histogram("symcell_job_duration_seconds",
                            "Time jobs ran, by the state they ended in.",
                            {0.01, 0.05, 0.25, 1, 5, 30, 120, 600, 3600});
  metrics.declare_counter("symcell_job_write_retries_total",
                          "Times that a job's state or results could not be written and were tried "
                          "again.");
  metrics.declare_counter("symcell_internal_errors_total", "Bugs and failures of the machine.");
}

}  // namespace

struct Service::Impl {
  Impl(const ServiceSettings& service_settings, JobEngine& engine, Logger& service_logger)
      : settings(service_settings),
        logger(service_logger),
        jobs(settings.data_directory, settings.jobs, engine, metrics, logger),
        streams(long_call_places(settings.http.patient_threads)),
        inspections(inspection_places(settings.http.threads)),
        router(metrics, logger),
        http(settings.http, router, metrics, logger),
        context{jobs,    metrics,     logger,          settings.http.max_body_bytes,
                streams, inspections, http.in_flight()} {
    declare_metrics(metrics);
    add_job_routes(router, context);
    add_result_routes(router, context);
    add_event_routes(router, context);
    add_inspect_routes(router, context);
    add_health_routes(router, context);
    add_page_routes(router);
  }

  ServiceSettings settings;
  Logger& logger;
  Metrics metrics;
  JobService jobs;
  Slots streams;
  Slots inspections;
  Router router;
  HttpServer http;
  ServiceContext context;
  std::thread acceptor;
};

Service::Service(const ServiceSettings& settings, JobEngine& engine, Logger& logger)
    : impl_(std::make_unique<Impl>(settings, engine, logger)) {
}

Service::~Service() {
  if (impl_->acceptor.joinable()) static_cast<void>(stop());
}

int Service::start() {
  const int port = impl_->http.bind();
  impl_->jobs.start();
  impl_->acceptor = std::thread([this] { impl_->http.run(); });
  return port;
}

bool Service::stop() {
  impl_->jobs.begin_stop();
  const bool jobs_stopped = impl_->jobs.finish_stop(impl_->settings.grace);
  impl_->http.stop();
  if (impl_->acceptor.joinable()) impl_->acceptor.join();
  return jobs_stopped;
}

JobService& Service::jobs() {
  return impl_->jobs;
}

}  // namespace symcell::server
