#include "server/cli/report_error.hpp"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "api/problem.hpp"

namespace symcell::cli {

int report_error(const Error& error, bool as_json) {
  const ProblemRow& row = problem_row(error.code);
  if (as_json) {
    using Json = nlohmann::ordered_json;
    // Messages may quote file names, which need not be UTF-8.
    const std::string text =
        problem_document(error, "", "/model").dump(2, ' ', false, Json::error_handler_t::replace);
    std::fprintf(stderr, "%s\n", text.c_str());
    return row.exit_code;
  }
  std::string line = error.message;
  std::ranges::replace(line, '\n', ' ');
  std::fprintf(stderr, "symcell: %s\n", line.c_str());
  std::string more = "  code " + std::string(error_code_name(error.code));
  if (!error.pointer.empty()) more += ", at " + error.pointer;
  if (!error.elements.empty()) {
    constexpr std::size_t kShown = 10;
    more += ", entities";
    for (std::size_t i = 0; i < std::min(error.elements.size(), kShown); ++i) {
      more += " " + std::to_string(error.elements[i]);
    }
    if (error.elements.size() > kShown) {
      more += " and " + std::to_string(error.elements.size() - kShown) + " more";
    }
  }
  std::fprintf(stderr, "%s\n", more.c_str());
  return row.exit_code;
}

void report_warnings(const std::string& warnings, bool as_json) {
  using Json = nlohmann::ordered_json;
  const Json list = Json::parse(warnings, nullptr, false);
  if (!list.is_array() || list.empty()) return;
  if (as_json) {
    Json document;
    document["warnings"] = list;
    const std::string text = document.dump(2, ' ', false, Json::error_handler_t::replace);
    std::fprintf(stderr, "%s\n", text.c_str());
    return;
  }
  for (const Json& warning : list) {
    std::fprintf(stderr, "symcell: warning: %s\n  code %s; %s\n",
                 warning.value("detail", "").c_str(), warning.value("code", "").c_str(),
                 warning.value("mend", "").c_str());
  }
}

}  // namespace symcell::cli
