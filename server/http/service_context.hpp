// What the handlers share.
#pragma once

#include <atomic>
#include <cstddef>

#include "server/base/log.hpp"
#include "server/base/metrics.hpp"
#include "server/base/slots.hpp"
#include "server/http/webhook_rules.hpp"
#include "server/jobs/job_service.hpp"

namespace symcell::server {

class Router;

struct ServiceContext {
  JobService& jobs;
  Metrics& metrics;
  Logger& logger;
  std::size_t max_body_bytes;
  SharedSlots& streams;  // places for event streams and waits for a job
  // For calls that hold an HTTP thread for long, with work for the processor; fewer than there are threads, so
  // that other calls always find one.
  Slots& inspections;
  const std::atomic<std::size_t>& requests_in_flight;
  const WebhookRules& webhooks;
};

// Each adds the routes of one topic; `context` must outlive the router.
void add_job_routes(Router& router, ServiceContext& context);
void add_result_routes(Router& router, ServiceContext& context);
void add_event_routes(Router& router, ServiceContext& context);
void add_inspect_routes(Router& router, ServiceContext& context);
void add_key_routes(Router& router, ServiceContext& context);
void add_health_routes(Router& router, ServiceContext& context);
void add_page_routes(Router& router);

}  // namespace symcell::server
