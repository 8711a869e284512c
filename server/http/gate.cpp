#include "server/http/gate.hpp"

#include <optional>

#include "server/http/call.hpp"
#include "server/http/header_values.hpp"
#include "server/http/problem_response.hpp"

namespace symcell::server {
namespace {

bool is_loopback(std::string_view host) {
  return host == "localhost" || host == "::1" || host.starts_with("127.");
}

// The key that a request bears; nullopt: none. Empty: something else than a key.
std::optional<std::string> key_of(const Call& call) {
  if (call.request.has_header("X-API-Key")) return call.header("X-API-Key");
  if (!call.request.has_header("Authorization")) return std::nullopt;
  const std::string value = call.header("Authorization");
  const std::size_t space = value.find(' ');
  if (media_type_of(value.substr(0, space)) != "bearer" || space == std::string::npos) return "";
  return value.substr(value.find_first_not_of(' ', space));
}

KeyScope scope_of(const Call& call, std::string_view route) {
  if (route.starts_with("/v1/keys")) return KeyScope::kAdmin;
  const std::string& method = call.request.method;
  return method == "GET" || method == "HEAD" ? KeyScope::kRead : KeyScope::kSubmit;
}

}  // namespace

Gate::Gate(const AccessRules& rules,
           const std::string& host,
           JobService& jobs,
           Metrics& metrics,
           Logger& logger)
    : rules_(rules), loopback_(is_loopback(host)), jobs_(jobs), metrics_(metrics), logger_(logger) {
  metrics_.declare_counter("symcell_refused_callers_total",
                           "Calls refused for their key, scope or rate, by reason.");
}

bool Gate::key_required() const {
  if (rules_.insecure_open) return false;
  return rules_.require_key || !loopback_ || jobs_.keys().any();
}

void Gate::note_refusal(const Call& call, std::string_view why) const {
  metrics_.count("symcell_refused_callers_total", {{"reason", why}});
  const Exchange& exchange = call.exchange;
  logger_.warning("caller_refused", {{"why", why},
                                     {"key", std::string_view(exchange.caller.owner())},
                                     {"client", std::string_view(exchange.client)},
                                     {"request_id", std::string_view(exchange.request_id)},
                                     {"path", std::string_view(exchange.path)}});
}

bool Gate::identify(Call& call) const {
  Caller& caller = call.exchange.caller;
  const auto text = key_of(call);
  if (text) {
    caller.key = jobs_.keys().find(*text);
    if (caller.key) {
      caller.client = caller.key->id;
      caller.sees_all = caller.key->may(KeyScope::kAdmin);
      return true;
    }
  } else if (!key_required()) {
    caller.client = call.exchange.client;
    return true;
  }
  note_refusal(call, text ? "bad_key" : "no_key");
  call.response.set_header("WWW-Authenticate", "Bearer realm=\"symcell\"");
  respond_problem(call, ServiceProblem::kUnauthorized,
                  text ? "this key is not valid here; it may have been revoked"
                       : "this server asks for a key: send it as Authorization: Bearer KEY, or "
                         "X-API-Key; whoever runs the server makes one by symcell keys create");
  return false;
}

bool Gate::check_scope(Call& call, std::string_view route) const {
  const Caller& caller = call.exchange.caller;
  const KeyScope scope = scope_of(call, route);
  if (caller.key ? caller.key->may(scope) : scope != KeyScope::kAdmin || !key_required()) {
    return true;
  }
  note_refusal(call, "scope");
  respond_problem(
      call, ServiceProblem::kScopeMissing,
      "this key has not the scope " + std::string(key_scope_name(scope)) + ", which this needs");
  return false;
}

bool Gate::check_rate(Call& call) const {
  if (!call.exchange.caller.key) return true;
  const RateState rate = jobs_.keys().take_turn(*call.exchange.caller.key);
  if (rate.limit == 0) return true;
  call.response.set_header("RateLimit-Policy",
                           "\"requests\";q=" + std::to_string(rate.limit) + ";w=60");
  call.response.set_header("RateLimit", "\"requests\";r=" + std::to_string(rate.remaining) +
                                            ";t=" + std::to_string(rate.reset_s));
  if (rate.allowed) return true;
  note_refusal(call, "rate");
  respond_problem(call, ServiceProblem::kRateLimited,
                  "this key may ask " + std::to_string(rate.limit) +
                      " times a minute; wait as long as Retry-After says");
  set_retry_after(call, rate.reset_s);
  return false;
}

bool Gate::check_job(Call& call, std::string_view route) const {
  if (call.exchange.caller.sees_all || !route.starts_with("/v1/jobs/{id}")) return true;
  const auto job = jobs_.find(call.id);
  if (job && job->owner == call.exchange.caller.owner()) return true;
  respond_problem(call, ServiceProblem::kNotFound, "there is no such job; it may have expired");
  return false;
}

bool Gate::admit(Call& call, std::string_view route) const {
  call.exchange.caller.client = call.exchange.client;
  if (!route.starts_with("/v1/")) return true;
  return identify(call) && check_rate(call) && check_scope(call, route) && check_job(call, route);
}

}  // namespace symcell::server
