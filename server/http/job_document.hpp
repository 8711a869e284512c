// A job as the interface's JSON document.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "server/jobs/job_service.hpp"

namespace symcell::server {

enum class JobDetail { kSummary, kFull };  // full: with the statistics once done

[[nodiscard]] nlohmann::ordered_json job_document(const Job& job,
                                                  JobService& jobs,
                                                  JobDetail detail);
[[nodiscard]] nlohmann::ordered_json progress_document(const Job& job, const JobService& jobs);

// Path of a job, "/v1/jobs/<id>".
[[nodiscard]] std::string job_path(const Job& job);

// JSON as it goes out; bytes that are no UTF-8 are replaced.
[[nodiscard]] std::string json_text(const nlohmann::ordered_json& document);

}  // namespace symcell::server
