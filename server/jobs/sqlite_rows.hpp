// Jobs as rows of the embedded database.
#pragma once

#include <vector>

#include "server/jobs/job.hpp"
#include "server/jobs/sqlite_connection.hpp"

namespace symcell::server {

// What is read of a job, in the order of read_job().
inline constexpr const char* kJobColumns =
    "sequence, id, state, created_ms, started_ms, finished_ms, model_format, model_name, "
    "options_json, error_code, error_json, model_bytes, result_bytes, lost_workers, "
    "finished_clock_ms, model_sha256, statistics_sha256, client, weight, attempt, "
    "owner, most_running, model_kept, request_id, traceparent, webhook";

// Throws std::runtime_error for values that no version wrote.
[[nodiscard]] Job read_job(const Prepared& row);
// Of all rows that are left.
[[nodiscard]] std::vector<Job> read_jobs(Prepared& query);

}  // namespace symcell::server
