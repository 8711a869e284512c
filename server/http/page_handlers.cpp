// GET /, /docs, /openapi.yaml, and what stands behind the `type` of problem documents.
#include <string>

#include "api/problem.hpp"
#include "server/http/call.hpp"
#include "server/http/header_values.hpp"
#include "server/http/pages.hpp"
#include "server/http/problem_response.hpp"
#include "server/http/router.hpp"
#include "server/http/service_context.hpp"

namespace symcell::server {
namespace {

void respond_page(Call& call, std::string_view page, const char* media_type) {
  call.response.set_header("Cache-Control", "public, max-age=300");
  call.response.set_content(page.data(), page.size(), media_type);
}

struct KnownProblem {
  std::string_view title;
  int status = 0;
};

// Empty title: unknown.
KnownProblem find_problem(std::string_view name) {
  for (const ProblemRow& row : problem_table()) {
    if (error_code_name(row.code) == name) return {row.title, row.http_status};
  }
  for (const ServiceProblemRow& row : service_problem_table()) {
    if (row.name == name) return {row.title, row.http_status};
  }
  return {};
}

void show_problem(Call& call) {
  const KnownProblem problem = find_problem(call.id);
  if (problem.title.empty()) {
    respond_problem(call, ServiceProblem::kNotFound, "there is no such problem type");
    return;
  }
  // The name is one of ours, so nothing needs escaping.
  respond_page(call,
               call.id + " (HTTP " + std::to_string(problem.status) +
                   "): " + std::string(problem.title) +
                   ".\nThe problem document's detail says what was wrong and how to mend it.\n",
               "text/plain; charset=utf-8");
}

}  // namespace

void add_page_routes(Router& router) {
  router.add("GET", "/",
             [](Call& call) { respond_page(call, index_page(), "text/html; charset=utf-8"); });
  router.add("GET", "/docs",
             [](Call& call) { respond_page(call, docs_page(), "text/html; charset=utf-8"); });
  router.add("GET", "/openapi.yaml",
             [](Call& call) { respond_page(call, openapi_yaml(), "application/yaml"); });
  router.add("GET", "/problems/{id}", show_problem);
}

}  // namespace symcell::server
