#include "server/jobs/sqlite_rows.hpp"

#include <optional>
#include <stdexcept>
#include <string>

#include "api/formats/model_format.hpp"

namespace symcell::server {
namespace {

ModelFormat format_from_name(const std::string& name) {
  if (const auto format = model_format_of_name(name)) return *format;
  throw std::runtime_error("the job database holds an unknown model format: " + name);
}

std::optional<std::int64_t> optional_time(const SQLite::Column& column) {
  if (column.isNull()) return std::nullopt;
  return column.getInt64();
}

}  // namespace

Job read_job(const Prepared& row) {
  Job job;
  job.sequence = row.column(0).getInt64();
  job.id = row.column(1).getString();
  const auto state = job_state_from_name(row.column(2).getString());
  if (!state) throw std::runtime_error("the job database holds an unknown state");
  job.state = *state;
  job.created_ms = row.column(3).getInt64();
  job.started_ms = optional_time(row.column(4));
  job.finished_ms = optional_time(row.column(5));
  job.model_format = format_from_name(row.column(6).getString());
  job.model_name = row.column(7).getString();
  job.options_json = row.column(8).getString();
  job.error_code = row.column(9).getString();
  job.error_json = row.column(10).getString();
  job.model_bytes = row.column(11).getInt64();
  job.result_bytes = row.column(12).getInt64();
  job.lost_workers = row.column(13).getInt();
  job.finished_clock_ms = optional_time(row.column(14));
  job.model_sha256 = row.column(15).getString();
  job.statistics_sha256 = row.column(16).getString();
  job.client = row.column(17).getString();
  job.weight = row.column(18).getInt();
  job.attempt = row.column(19).getInt();
  job.owner = row.column(20).getString();
  job.most_running = row.column(21).getInt64();
  job.model_kept = row.column(22).getInt() != 0;
  job.request_id = row.column(23).getString();
  job.traceparent = row.column(24).getString();
  job.webhook = row.column(25).getString();
  return job;
}

std::vector<Job> read_jobs(Prepared& query) {
  std::vector<Job> jobs;
  while (query.step()) jobs.push_back(read_job(query));
  return jobs;
}

}  // namespace symcell::server
