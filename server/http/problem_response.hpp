// Problem documents (RFC 9457) as answers, for errors of the service itself and of the model.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "core/base/error.hpp"

namespace symcell::server {

struct Call;

// Errors that HTTP has and the library has not; the library's own codes are in api/problem.hpp.
enum class ServiceProblem : std::uint8_t {
  kBadRequest,
  kUnauthorized,
  kScopeMissing,
  kHostNotAllowed,
  kCrossSite,
  kNotFound,
  kMethodNotAllowed,
  kNotAcceptable,
  kNotFinished,
  kNoResult,
  kAlreadyFinished,
  kModelGone,
  kUriTooLong,
  kBodyTooLarge,
  kHeadersTooLarge,
  kRangeNotSatisfiable,
  kExpectationFailed,
  kUnsupportedMediaType,
  kIdempotencyConflict,
  kWebhookRefused,
  kQueueFull,
  kTooManyStreams,
  kRateLimited,
  kQuotaSpent,
  kNotImplemented,
  kStopping,
  kOverloaded,
  kStoreUnavailable,
  kStorageFull,
  kInternal,
  kStoredFileDamaged,
};

struct ServiceProblemRow {
  ServiceProblem problem;
  int http_status;
  std::string_view name;   // stable; "type" is "/problems/<name>"
  std::string_view title;  // the same for every occurrence
};

[[nodiscard]] std::span<const ServiceProblemRow> service_problem_table();
[[nodiscard]] const ServiceProblemRow& service_problem_row(ServiceProblem problem);
// For answers that httplib gives by itself.
[[nodiscard]] ServiceProblem service_problem_for_status(int status);

// JSON text of the document.  `detail`: what was wrong here and how to mend it.
[[nodiscard]] std::string service_problem_json(ServiceProblem problem,
                                               std::string_view detail,
                                               std::string_view instance);

// Answer the call. Retry-After is added where trying again later helps.
void respond_problem(Call& call, ServiceProblem problem, std::string_view detail);
// Instead of what respond_problem() says by itself.
void set_retry_after(Call& call, std::int64_t seconds);
void respond_error(Call& call, const Error& error, std::string_view pointer_prefix);

}  // namespace symcell::server
