// GET /, /docs, /openapi.yaml, the files of the pages, and what stands behind the `type` of problem documents.
#include <string>

#include "api/formats/gzip.hpp"
#include "api/problem.hpp"
#include "server/http/call.hpp"
#include "server/http/gzip.hpp"
#include "server/http/page_files.hpp"
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

// Scripts, styles and calls of this address only; pictures also of what a script drew.
constexpr const char* kPagePolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; "
    "connect-src 'self'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
constexpr std::size_t kMostPageBytes = 16UL << 20U;

void respond_file(Call& call, const PageFile& file) {
  // Names of assets change with their bytes.
  const bool asset = file.path.starts_with("/assets/");
  call.response.set_header("Cache-Control",
                           asset ? "public, max-age=31536000, immutable" : "public, max-age=300");
  call.response.set_header("Vary", "Accept-Encoding");
  // In the place of the one for all else, which allows no scripts.
  call.response.headers.erase("Content-Security-Policy");
  call.response.set_header("Content-Security-Policy", kPagePolicy);
  const std::string media_type(file.media_type);
  if (accepts_gzip(call.exchange.accept_encoding)) {
    call.response.set_header("Content-Encoding", "gzip");
    call.response.set_content(file.gzip.data(), file.gzip.size(), media_type);
    return;
  }
  const auto bytes = gunzip(file.gzip, kMostPageBytes);
  if (!bytes) {
    respond_problem(call, ServiceProblem::kInternal, "the page's own file is damaged");
    return;
  }
  call.response.set_content(*bytes, media_type);
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
  const auto plain_docs = [](Call& call) {
    respond_page(call, docs_page(), "text/html; charset=utf-8");
  };
  for (const PageFile& file : page_files()) {
    router.add("GET", std::string(file.path), [&file](Call& call) { respond_file(call, file); });
  }
  if (page_files().empty()) {
    router.add("GET", "/",
               [](Call& call) { respond_page(call, index_page(), "text/html; charset=utf-8"); });
    router.add("GET", "/docs", plain_docs);
  }
  router.add("GET", "/docs/plain", plain_docs);
  router.add("GET", "/openapi.yaml",
             [](Call& call) { respond_page(call, openapi_yaml(), "application/yaml"); });
  router.add("GET", "/problems/{id}", show_problem);
}

}  // namespace symcell::server
