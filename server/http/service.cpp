#include "server/http/service.hpp"

#include <algorithm>
#include <thread>

#include "api/version.hpp"
#include "server/http/router.hpp"
#include "server/http/service_context.hpp"
#include "server/http/webhook_sender.hpp"

namespace symcell::server {
namespace {

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
  metrics.declare_gauge("symcell_jobs", "Stored jobs by state.");
  metrics.declare_gauge("symcell_stored_bytes", "Bytes of all models and results.");
  metrics.declare_gauge("symcell_free_bytes", "Room left where they are kept.");
  metrics.declare_gauge("symcell_queue_length", "Jobs that wait for a worker.");
  metrics.declare_gauge("symcell_queue_age_seconds", "How long the job waits that waits longest.");
  metrics.declare_gauge("symcell_queue_limit", "Jobs that may wait.");
  metrics.declare_gauge("symcell_workers", "Jobs that may run at once.");
  metrics.declare_gauge("symcell_workers_busy", "Jobs that run now.");
  metrics.declare_gauge("symcell_jobs_overdue", "Jobs that run beyond their time limit.");
  metrics.declare_gauge("symcell_http_requests_in_flight", "Requests being served.");
  metrics.declare_gauge("symcell_streams_open", "Event streams and waits for a job.");
  metrics.declare_gauge("symcell_build_info", "1, with the program's version as a label.");
  metrics.set("symcell_build_info", {{"version", version()}}, 1);
  declare_process_metrics(metrics);
}

}  // namespace

struct Service::Impl {
  Impl(const ServiceSettings& service_settings, JobEngine& engine, Logger& service_logger)
      : settings(service_settings),
        logger(service_logger),
        jobs(settings.data_directory, settings.jobs, engine, metrics, logger),
        webhook_rules(settings.webhooks),
        webhooks(settings.webhooks, webhook_rules, jobs, metrics, logger),
        streams(settings.http.max_waiting),
        inspections(inspection_places(settings.http.threads)),
        gate(settings.access, settings.http.host, jobs, metrics, logger),
        router(metrics, logger),
        http(settings.http, router, metrics, logger),
        context{jobs,    metrics,     logger,           settings.http.max_body_bytes,
                streams, inspections, http.in_flight(), webhook_rules} {
    declare_metrics(metrics);
    engine.declare_metrics(metrics);
    router.set_gate(&gate);
    add_health_routes(router, context);
    if (settings.role == ServerRole::kWorker) return;
    add_job_routes(router, context);
    add_result_routes(router, context);
    add_event_routes(router, context);
    add_inspect_routes(router, context);
    add_key_routes(router, context);
    add_page_routes(router);
  }

  ServiceSettings settings;
  Logger& logger;
  Metrics metrics;
  JobService jobs;
  WebhookRules webhook_rules;
  WebhookSender webhooks;
  SharedSlots streams;
  Slots inspections;
  Gate gate;
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
  impl_->webhooks.start();
  impl_->acceptor = std::thread([this] { impl_->http.run(); });
  return port;
}

bool Service::stop() {
  impl_->jobs.begin_stop();
  const bool jobs_stopped = impl_->jobs.finish_stop(impl_->settings.grace);
  impl_->webhooks.stop();
  impl_->http.stop();
  if (impl_->acceptor.joinable()) impl_->acceptor.join();
  return jobs_stopped;
}

void Service::reload_tls() {
  impl_->http.reload_tls();
}

JobService& Service::jobs() {
  return impl_->jobs;
}

}  // namespace symcell::server
