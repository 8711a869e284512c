// GET /healthz (the process answers), /readyz (it takes jobs), /metrics (Prometheus).
#include <exception>

#include "server/http/call.hpp"
#include "server/http/problem_response.hpp"
#include "server/http/router.hpp"
#include "server/http/service_context.hpp"

namespace symcell::server {
namespace {

void respond_text(Call& call, const std::string& text, const char* media_type) {
  call.response.set_header("Cache-Control", "no-store");
  call.response.set_content(text, media_type);
}

void show_readiness(Call& call, ServiceContext& context) {
  if (context.jobs.stopping()) {
    respond_problem(call, ServiceProblem::kStopping, "the server is stopping");
    return;
  }
  try {
    context.jobs.check_health();
  } catch (const std::exception& exception) {
    context.logger.error("store_unhealthy", {{"what", exception.what()}});
    respond_problem(call, ServiceProblem::kStoreUnavailable,
                    "the job store does not take what is written to it");
    return;
  }
  if (const std::string fault = context.jobs.engine().fault(); !fault.empty()) {
    context.logger.error("engine_unhealthy", {{"what", std::string_view(fault)}});
    respond_problem(call, ServiceProblem::kOverloaded, "no worker process can be started");
    return;
  }
  respond_text(call, "ready\n", "text/plain; charset=utf-8");
}

void append_gauge(std::string& text, const char* name, const char* help, double value) {
  Metrics::append_gauge_header(text, name, help);
  Metrics::append_sample(text, name, {}, value);
}

void show_metrics(Call& call, ServiceContext& context) {
  std::string text = context.metrics.text();
  const StoreTotals totals = context.jobs.totals();
  Metrics::append_gauge_header(text, "symcell_jobs", "Stored jobs by state.");
  for (const JobState state : kAllJobStates) {
    Metrics::append_sample(text, "symcell_jobs", {{"state", job_state_name(state)}},
                           static_cast<double>(totals.by_state[static_cast<std::size_t>(state)]));
  }
  const JobRunner& runner = context.jobs.runner();
  append_gauge(text, "symcell_stored_bytes", "Bytes of all models and results.",
               static_cast<double>(totals.bytes));
  append_gauge(text, "symcell_queue_length", "Jobs that wait for a worker.",
               static_cast<double>(totals.by_state[static_cast<std::size_t>(JobState::kQueued)]));
  append_gauge(text, "symcell_queue_limit", "Jobs that may wait.",
               static_cast<double>(context.jobs.limits().queue_limit));
  append_gauge(text, "symcell_workers", "Jobs that may run at once.",
               static_cast<double>(runner.workers()));
  append_gauge(text, "symcell_workers_busy", "Jobs that run now.",
               static_cast<double>(runner.running()));
  append_gauge(text, "symcell_http_requests_in_flight", "Requests being served.",
               static_cast<double>(context.requests_in_flight.load()));
  append_gauge(text, "symcell_streams_open", "Event streams and waits for a job.",
               static_cast<double>(context.streams.taken()));
  context.jobs.engine().append_metrics(text);
  respond_text(call, text, "text/plain; version=0.0.4; charset=utf-8");
}

}  // namespace

void add_health_routes(Router& router, ServiceContext& context) {
  router.add("GET", "/healthz",
             [](Call& call) { respond_text(call, "ok\n", "text/plain; charset=utf-8"); });
  router.add("GET", "/readyz", [&context](Call& call) { show_readiness(call, context); });
  router.add("GET", "/metrics", [&context](Call& call) { show_metrics(call, context); });
}

}  // namespace symcell::server
