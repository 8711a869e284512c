#include "server/http/job_document.hpp"

#include <nlohmann/json.hpp>

#include "server/base/clock.hpp"
#include "server/jobs/stored_files.hpp"

namespace symcell::server {
namespace {

using Json = nlohmann::ordered_json;

Json time_or_null(const std::optional<std::int64_t>& ms) {
  return ms ? Json(format_timestamp(*ms)) : Json(nullptr);
}

Json links_of(const Job& job) {
  const std::string self = job_path(job);
  Json links;
  links["self"] = self;
  if (job.model_kept) links["model"] = self + "/model";
  if (job.model_kept) links["surface"] = self + "/surface";
  links["events"] = self + "/events";
  if (!is_finished(job.state)) links["cancel"] = self + "/cancel";
  if (is_finished(job.state) && job.model_kept) links["rerun"] = self + "/rerun";
  if (job.state == JobState::kSucceeded) {
    links["cell"] = self + "/cell";
    links["full"] = self + "/full";
    links["statistics"] = self + "/statistics";
  }
  return links;
}

Json options_of(const Job& job) {
  Json options = Json::parse(job.options_json);
  for (auto option = options.begin(); option != options.end();) {
    option = option->is_null() ? options.erase(option) : std::next(option);
  }
  return options;
}

// Null if the file is damaged, or has just gone with its job.
Json statistics_of(const Job& job, const JobService& jobs) {
  try {
    return Json::parse(read_statistics(job, jobs.files()), nullptr, false);
  } catch (const StoredFileDamaged&) {
    return nullptr;
  }
}

void add_statistics(Json& document, Json statistics) {
  // Not there in what an earlier version wrote.
  document["warnings"] = statistics.is_object() && statistics.contains("warnings")
                             ? statistics["warnings"]
                             : Json::array();
  if (statistics.is_null()) document["damaged"] = Json::array({"statistics"});
  document["statistics"] = std::move(statistics);
}

}  // namespace

std::string job_path(const Job& job) {
  return "/v1/jobs/" + job.id;
}

std::string json_text(const Json& document) {
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json progress_document(const Job& job, const JobService& jobs) {
  Progress progress;
  if (job.state == JobState::kSucceeded) {
    progress.phase = Phase::kDone;
    progress.fraction = 1;
    progress.quality_reached = 1;
  } else if (const auto live = jobs.progress(job)) {
    progress = *live;
  }
  Json document;
  document["fraction"] = progress.fraction;
  document["phase"] = phase_name(progress.phase);
  document["elements"] = progress.elements;
  document["quality"] = progress.quality_reached;
  return document;
}

Json job_document(const Job& job, JobService& jobs, JobDetail detail) {
  Json document;
  document["id"] = job.id;
  document["state"] = job_state_name(job.state);
  document["created_at"] = format_timestamp(job.created_ms);
  document["started_at"] = time_or_null(job.started_ms);
  document["finished_at"] = time_or_null(job.finished_ms);
  document["progress"] = progress_document(job, jobs);
  document["model"] = {{"format", model_format_info(job.model_format).name},
                       {"name", job.model_name.empty() ? Json(nullptr) : Json(job.model_name)},
                       {"bytes", job.model_bytes}};
  document["options"] = options_of(job);
  document["key"] = job.owner.empty() ? Json(nullptr) : Json(job.owner);
  if (job.state == JobState::kFailed) document["error"] = Json::parse(job.error_json);
  if (job.state == JobState::kSucceeded) {
    Json statistics = statistics_of(job, jobs);
    if (statistics.is_object() && statistics.contains("cell")) {
      document["progress"]["elements"] = statistics["cell"].value("elements", 0U);
    }
    if (detail == JobDetail::kFull) add_statistics(document, std::move(statistics));
  }
  document["links"] = links_of(job);
  return document;
}

}  // namespace symcell::server
