#include "server/jobs/job.hpp"

namespace symcell::server {

std::string_view job_state_name(JobState state) {
  switch (state) {
    case JobState::kQueued: return "queued";
    case JobState::kRunning: return "running";
    case JobState::kSucceeded: return "succeeded";
    case JobState::kFailed: return "failed";
    case JobState::kCancelled: return "cancelled";
  }
  return "failed";
}

std::optional<JobState> job_state_from_name(std::string_view name) {
  for (const JobState state : kAllJobStates) {
    if (job_state_name(state) == name) return state;
  }
  return std::nullopt;
}

bool is_finished(JobState state) {
  return state != JobState::kQueued && state != JobState::kRunning;
}

std::optional<JobState> next_state(JobState state, JobEvent event) {
  if (state == JobState::kQueued) {
    switch (event) {
      case JobEvent::kStart: return JobState::kRunning;
      case JobEvent::kFail: return JobState::kFailed;
      case JobEvent::kCancel: return JobState::kCancelled;
      case JobEvent::kSucceed:
      case JobEvent::kRequeue: return std::nullopt;
    }
  }
  if (state == JobState::kRunning) {
    switch (event) {
      case JobEvent::kSucceed: return JobState::kSucceeded;
      case JobEvent::kFail: return JobState::kFailed;
      case JobEvent::kCancel: return JobState::kCancelled;
      case JobEvent::kRequeue: return JobState::kQueued;
      case JobEvent::kStart: return std::nullopt;
    }
  }
  return std::nullopt;
}

}  // namespace symcell::server
