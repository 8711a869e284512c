// POST /v1/inspect: what detection finds, at once, within a small limit of size and time.
#include <algorithm>

#include "server/http/call.hpp"
#include "server/http/model_request.hpp"
#include "server/http/picture.hpp"
#include "server/http/problem_response.hpp"
#include "server/http/router.hpp"
#include "server/http/service_context.hpp"

namespace symcell::server {
namespace {

void inspect(Call& call, ServiceContext& context) {
  if (context.jobs.stopping()) {
    call.exchange.close = true;
    respond_problem(call, ServiceProblem::kStopping, "the server is stopping");
    return;
  }
  const auto request =
      receive_model_request(call, context, std::min(kMaxInspectBytes, context.max_body_bytes));
  if (!request) return;
  if (wants_picture(call)) {
    respond_picture(call, context, request->model.path(), request->format, request->options);
    return;
  }
  // An inspection holds the HTTP thread and a worker process; the places keep threads and
  // processors for others. Not taken before the body is here: slow senders would hold them all.
  const Slots::Slot place = context.inspections.try_take();
  if (!place) {
    respond_problem(call, ServiceProblem::kTooManyStreams,
                    "too many inspections at once; try again shortly");
    return;
  }
  ExecutionContext execution;
  MeshOptions options = request->options;
  options.time_limit_s = std::min(kMaxInspectSeconds, options.time_limit_s);
  execution.set_time_limit(options.time_limit_s);
  const auto document =
      context.jobs.engine().inspect(request->model.path(), request->format, options, execution);
  if (!document) {
    respond_error(call, document.error(), "/model");
    return;
  }
  call.response.set_header("Cache-Control", "no-store");
  call.response.set_content(*document, "application/json");
}

}  // namespace

void add_inspect_routes(Router& router, ServiceContext& context) {
  // The last two for clients made from openapi.yaml, which has one form of body an operation.
  for (const char* path : {"/v1/inspect", "/v1/inspect/file", "/v1/inspect/form"}) {
    router.add("POST", path, [&context](Call& call) { inspect(call, context); });
  }
}

}  // namespace symcell::server
