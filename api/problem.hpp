// One table from error code to HTTP status, problem type, title and exit code, and the problem
// document of RFC 9457.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>

#include "core/base/error.hpp"

namespace symcell {

struct ProblemRow {
  ErrorCode code;
  int http_status;
  int exit_code;           // 0 done, 1 meshing failed, 2 usage, 3 model, 4 limit
  std::string_view title;  // short, the same for every occurrence
};

[[nodiscard]] std::span<const ProblemRow> problem_table();
[[nodiscard]] const ProblemRow& problem_row(ErrorCode code);

// `instance`: path of the request or job, may be empty.  `type` is "/problems/<code name>".
// Adds "code" (the code's name), "elements" (ids of the entities at fault, in input numbering)
// where there are any, and errors:[{pointer, detail}] where the error has a pointer; the pointer is
// prefixed with `pointer_prefix` ("/model" in a service request) unless it points into "/options".
[[nodiscard]] nlohmann::ordered_json problem_document(const Error& error,
                                                      std::string_view instance,
                                                      std::string_view pointer_prefix);

}  // namespace symcell
