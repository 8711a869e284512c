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
  if (const std::string fault = context.jobs.fault(); !fault.empty()) {
    context.logger.error("service_unhealthy", {{"what", std::string_view(fault)}});
    respond_problem(call, ServiceProblem::kOverloaded, fault);
    return;
  }
  respond_text(call, "ready\n", "text/plain; charset=utf-8");
}

void report(Metrics& metrics, const char* name, double value) {
  metrics.set(name, {}, value);
}

void show_metrics(Call& call, ServiceContext& context) {
  Metrics& metrics = context.metrics;
  const StoreTotals totals = context.jobs.totals();
  for (const JobState state : kAllJobStates) {
    metrics.set("symcell_jobs", {{"state", job_state_name(state)}},
                static_cast<double>(totals.by_state[static_cast<std::size_t>(state)]));
  }
  const JobRunner& runner = context.jobs.runner();
  report(metrics, "symcell_stored_bytes", static_cast<double>(totals.bytes));
  report(metrics, "symcell_free_bytes", static_cast<double>(context.jobs.free_bytes()));
  report(metrics, "symcell_queue_length",
         static_cast<double>(totals.by_state[static_cast<std::size_t>(JobState::kQueued)]));
  try {
    report(metrics, "symcell_queue_age_seconds", context.jobs.queue_age_s());
  } catch (const StoreError&) {
    // Counted by the store's watch; the age stays as it was found last.
  }
  report(metrics, "symcell_queue_limit", static_cast<double>(context.jobs.limits().queue_limit));
  report(metrics, "symcell_workers", static_cast<double>(runner.workers()));
  report(metrics, "symcell_workers_busy", static_cast<double>(runner.running()));
  report(metrics, "symcell_jobs_overdue", static_cast<double>(runner.overdue()));
  report(metrics, "symcell_http_requests_in_flight",
         static_cast<double>(context.requests_in_flight.load()));
  report(metrics, "symcell_streams_open", static_cast<double>(context.streams.taken()));
  report_process_metrics(metrics);
  context.jobs.engine().report_metrics(metrics);
  respond_text(call, metrics.text(), "text/plain; version=0.0.4; charset=utf-8");
}

}  // namespace

void add_health_routes(Router& router, ServiceContext& context) {
  router.add("GET", "/healthz",
             [](Call& call) { respond_text(call, "ok\n", "text/plain; charset=utf-8"); });
  router.add("GET", "/readyz", [&context](Call& call) { show_readiness(call, context); });
  router.add("GET", "/metrics", [&context](Call& call) { show_metrics(call, context); });
}

}  // namespace symcell::server
