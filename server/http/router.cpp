#include "server/http/router.hpp"

#include <cerrno>
#include <exception>
#include <new>
#include <system_error>
#include <utility>

#include "server/http/call.hpp"
#include "server/http/gate.hpp"
#include "server/http/problem_response.hpp"
#include "server/jobs/job_store.hpp"
#include "server/jobs/stored_files.hpp"

namespace symcell::server {
namespace {

std::vector<std::string> split_path(std::string_view path) {
  std::vector<std::string> segments;
  while (!path.empty()) {
    path.remove_prefix(1);  // the slash
    const std::size_t end = std::min(path.find('/'), path.size());
    segments.emplace_back(path.substr(0, end));
    path.remove_prefix(end);
  }
  return segments;
}

// Fills `id` if the route has a place for it.
bool matches(const std::vector<std::string>& route,
             const std::vector<std::string>& path,
             std::string& id) {
  if (route.size() != path.size()) return false;
  for (std::size_t i = 0; i < route.size(); ++i) {
    if (route[i] == "{id}") {
      id = path[i];
    } else if (route[i] != path[i]) {
      return false;
    }
  }
  return true;
}

// Of an id, in the log: anything may come as one.
constexpr std::size_t kIdChars = 40;

bool is_disk_full(const std::system_error& error) {
  return error.code().category() == std::generic_category() &&
         (error.code().value() == ENOSPC || error.code().value() == EDQUOT);
}

}  // namespace

void Router::add(std::string method, std::string path, RouteHandler handler) {
  auto segments = split_path(path);
  routes_.push_back({std::move(method), std::move(path), std::move(segments), std::move(handler)});
}

void Router::dispatch(Call& call) const {
  const std::string method = call.request.method == "HEAD" ? "GET" : call.request.method;
  if (!call.request.path.starts_with('/')) {
    respond_problem(call, ServiceProblem::kNotFound, "a path begins with a slash");
    return;
  }
  const auto path = split_path(call.request.path);
  std::string allowed;
  for (const Route& route : routes_) {
    std::string id;
    if (!matches(route.segments, path, id)) continue;
    call.exchange.route = route.path;
    if (route.method == method) {
      call.id = std::move(id);
      if (route.path.starts_with("/v1/jobs/{id}")) call.exchange.job = call.id.substr(0, kIdChars);
      run(route, call);
      return;
    }
    if (!allowed.empty()) allowed += ", ";
    allowed += route.method == "GET" ? "GET, HEAD" : route.method;
  }
  if (!allowed.empty()) {
    refuse_method(call, allowed + ", OPTIONS");
    return;
  }
  respond_problem(call, ServiceProblem::kNotFound,
                  "no such address; see /docs for those there are");
}

void Router::refuse_method(Call& call, const std::string& allowed) const {
  call.response.set_header("Allow", allowed);
  if (call.request.method == "OPTIONS") {
    call.response.status = 204;
    return;
  }
  respond_problem(call, ServiceProblem::kMethodNotAllowed,
                  "this address takes " + allowed + " only");
}

void Router::run(const Route& route, Call& call) const {
  guard(call, [&] {
    if (gate_ == nullptr || gate_->admit(call, route.path)) route.handler(call);
  });
}

void Router::resume(Call& call, const RouteHandler& handler) const {
  guard(call, [&] { handler(call); });
}

void Router::guard(Call& call, const std::function<void()>& work) const {
  const std::string& path = call.exchange.route;
  try {
    work();
    return;
  } catch (const StoreError& error) {
    // Told and counted by the store's watch.
    if (error.kind() == StoreError::Kind::kFull) {
      respond_problem(call, ServiceProblem::kStorageFull, "the disk is full; try again later");
    } else {
      respond_problem(call, ServiceProblem::kStoreUnavailable,
                      "the job store does not answer at present; try again soon");
    }
    return;
  } catch (const StoredFileDamaged& damaged) {
    logger_.error("stored_file_damaged", {{"route", path}, {"what", damaged.what()}});
    metrics_.count("symcell_internal_errors_total", {{"where", "stored_file"}});
    respond_problem(call, ServiceProblem::kStoredFileDamaged,
                    std::string(damaged.what()) + "; submit the job again");
    return;
  } catch (const std::system_error& error) {
    if (is_disk_full(error)) {
      logger_.error("disk_full", {{"what", error.what()}});
      respond_problem(call, ServiceProblem::kStorageFull, "the disk is full; try again later");
      return;
    }
    logger_.error("handler_threw", {{"route", path}, {"what", error.what()}});
  } catch (const std::exception& exception) {
    logger_.error(
        "handler_threw",
        {{"route", path}, {"what", exception.what()}, {"request_id", call.exchange.request_id}});
  } catch (...) {
    logger_.error("handler_threw", {{"route", path}, {"what", "not an std::exception"}});
  }
  metrics_.count("symcell_internal_errors_total", {{"where", "http"}});
  respond_problem(call, ServiceProblem::kInternal,
                  "internal error; the server's log tells more under " + call.exchange.request_id);
}

}  // namespace symcell::server
