#include "server/http/problem_response.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "api/problem.hpp"
#include "server/http/call.hpp"

namespace symcell::server {
namespace {

constexpr const char* kMediaType = "application/problem+json";

constexpr std::array kTable{
    ServiceProblemRow{ServiceProblem::kBadRequest, 400, "bad_request", "The request is malformed"},
    ServiceProblemRow{ServiceProblem::kUnauthorized, 401, "unauthorized", "A key is needed"},
    ServiceProblemRow{ServiceProblem::kScopeMissing, 403, "scope_missing",
                      "The key may not do this"},
    ServiceProblemRow{ServiceProblem::kHostNotAllowed, 403, "host_not_allowed",
                      "The server does not go by this name"},
    ServiceProblemRow{ServiceProblem::kCrossSite, 403, "cross_site",
                      "A page of another site asks for this"},
    ServiceProblemRow{ServiceProblem::kNotFound, 404, "not_found", "There is nothing here"},
    ServiceProblemRow{ServiceProblem::kMethodNotAllowed, 405, "method_not_allowed",
                      "This address does not take this method"},
    ServiceProblemRow{ServiceProblem::kNotAcceptable, 406, "not_acceptable",
                      "None of the accepted media types is offered"},
    ServiceProblemRow{ServiceProblem::kNotFinished, 409, "not_finished", "The job is not finished"},
    ServiceProblemRow{ServiceProblem::kNoResult, 409, "no_result", "The job has no result"},
    ServiceProblemRow{ServiceProblem::kAlreadyFinished, 409, "already_finished",
                      "The job is finished already"},
    ServiceProblemRow{ServiceProblem::kModelGone, 410, "model_gone",
                      "The model is not kept any more"},
    ServiceProblemRow{ServiceProblem::kUriTooLong, 414, "uri_too_long", "The address is too long"},
    ServiceProblemRow{ServiceProblem::kBodyTooLarge, 413, "body_too_large",
                      "The request body is too large"},
    ServiceProblemRow{ServiceProblem::kHeadersTooLarge, 431, "headers_too_large",
                      "The headers are too large"},
    ServiceProblemRow{ServiceProblem::kRangeNotSatisfiable, 416, "range_not_satisfiable",
                      "The range lies beyond the end"},
    ServiceProblemRow{ServiceProblem::kExpectationFailed, 417, "expectation_failed",
                      "The expectation cannot be met"},
    ServiceProblemRow{ServiceProblem::kUnsupportedMediaType, 415, "unsupported_media_type",
                      "The body's media type or encoding is not supported"},
    ServiceProblemRow{ServiceProblem::kIdempotencyConflict, 422, "idempotency_conflict",
                      "The idempotency key belongs to a different request"},
    ServiceProblemRow{ServiceProblem::kWebhookRefused, 422, "webhook_refused",
                      "The webhook's address is not acceptable"},
    ServiceProblemRow{ServiceProblem::kQueueFull, 429, "queue_full", "The queue is full"},
    ServiceProblemRow{ServiceProblem::kTooManyStreams, 429, "too_many_streams",
                      "Too many calls of this kind"},
    ServiceProblemRow{ServiceProblem::kRateLimited, 429, "rate_limited", "Too many requests"},
    ServiceProblemRow{ServiceProblem::kQuotaSpent, 429, "quota_spent",
                      "The key has sent what it may today"},
    ServiceProblemRow{ServiceProblem::kNotImplemented, 501, "not_implemented",
                      "The server cannot do this"},
    ServiceProblemRow{ServiceProblem::kStopping, 503, "stopping", "The server is stopping"},
    ServiceProblemRow{ServiceProblem::kOverloaded, 503, "overloaded", "The server is overloaded"},
    ServiceProblemRow{ServiceProblem::kStoreUnavailable, 503, "store_unavailable",
                      "The job store does not answer"},
    ServiceProblemRow{ServiceProblem::kStorageFull, 507, "storage_full",
                      "The server has no room for the job"},
    ServiceProblemRow{ServiceProblem::kInternal, 500, "internal", "Internal error"},
    ServiceProblemRow{ServiceProblem::kStoredFileDamaged, 500, "stored_file_damaged",
                      "A stored file is damaged"},
};

bool worth_retrying(int status) {
  return status == 429 || status == 503 || status == 507;
}

void respond_json(Call& call, int status, const std::string& document) {
  call.response.status = status;
  if (worth_retrying(status)) call.response.set_header("Retry-After", "5");
  call.response.set_content(document, kMediaType);
}

}  // namespace

std::span<const ServiceProblemRow> service_problem_table() {
  return kTable;
}

const ServiceProblemRow& service_problem_row(ServiceProblem problem) {
  const auto* row = std::ranges::find(kTable, problem, &ServiceProblemRow::problem);
  return row != kTable.end()
             ? *row
             : *std::ranges::find(kTable, ServiceProblem::kInternal, &ServiceProblemRow::problem);
}

ServiceProblem service_problem_for_status(int status) {
  const auto* row = std::ranges::find(kTable, status, &ServiceProblemRow::http_status);
  if (row != kTable.end()) return row->problem;
  return status < 500 ? ServiceProblem::kBadRequest : ServiceProblem::kInternal;
}

std::string service_problem_json(ServiceProblem problem,
                                 std::string_view detail,
                                 std::string_view instance) {
  const ServiceProblemRow& row = service_problem_row(problem);
  nlohmann::ordered_json document;
  document["type"] = "/problems/" + std::string(row.name);
  document["title"] = row.title;
  document["status"] = row.http_status;
  document["detail"] = detail;
  if (!instance.empty()) document["instance"] = instance;
  document["code"] = row.name;
  // A path may hold any bytes: replace what is no UTF-8.
  return document.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

void respond_problem(Call& call, ServiceProblem problem, std::string_view detail) {
  respond_json(call, service_problem_row(problem).http_status,
               service_problem_json(problem, detail, call.request.path));
}

void set_retry_after(Call& call, std::int64_t seconds) {
  call.response.headers.erase("Retry-After");
  call.response.set_header("Retry-After", std::to_string(seconds));
}

void respond_error(Call& call, const Error& error, std::string_view pointer_prefix) {
  const auto document = problem_document(error, call.request.path, pointer_prefix);
  respond_json(
      call, problem_row(error.code).http_status,
      document.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
  call.error_code = error_code_name(error.code);
}

}  // namespace symcell::server
