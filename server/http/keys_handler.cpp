// GET /v1/keys: who has keys, and what each uses. For keys with the scope admin.
#include <nlohmann/json.hpp>

#include "server/base/clock.hpp"
#include "server/http/call.hpp"
#include "server/http/job_document.hpp"
#include "server/http/router.hpp"
#include "server/http/service_context.hpp"

namespace symcell::server {
namespace {

using Json = nlohmann::ordered_json;

Json limit_or_null(std::int64_t limit) {
  return limit == 0 ? Json(nullptr) : Json(limit);
}

void list_keys(Call& call, ServiceContext& context) {
  Json document;
  document["keys"] = Json::array();
  for (const ApiKey& key : context.jobs.keys().all()) {
    const ClientUsage usage = context.jobs.usage(key.id);
    Json row;
    row["id"] = key.id;
    row["name"] = key.name;
    row["scopes"] = Json::array();
    for (const KeyScope scope : key.scopes) row["scopes"].push_back(key_scope_name(scope));
    row["priority"] = key.priority;
    row["created_at"] = format_timestamp(key.created_ms);
    row["revoked_at"] = key.revoked_ms ? Json(format_timestamp(*key.revoked_ms)) : Json(nullptr);
    row["limits"] = {{"queued", limit_or_null(key.limits.queued)},
                     {"running", limit_or_null(key.limits.running)},
                     {"bytes_per_day", limit_or_null(key.limits.bytes_per_day)},
                     {"requests_per_minute", limit_or_null(key.limits.requests_per_minute)}};
    row["usage"] = {{"queued", usage.queued},
                    {"running", usage.running},
                    {"jobs_today", usage.jobs_today},
                    {"bytes_today", usage.bytes_today}};
    document["keys"].push_back(std::move(row));
  }
  call.response.set_header("Cache-Control", "no-store");
  call.response.set_content(json_text(document), "application/json");
}

}  // namespace

void add_key_routes(Router& router, ServiceContext& context) {
  router.add("GET", "/v1/keys", [&context](Call& call) { list_keys(call, context); });
}

}  // namespace symcell::server
