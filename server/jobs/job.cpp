#include "server/jobs/job.hpp"

#include <algorithm>

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

bool is_traceparent(std::string_view text) {
  // W3C Trace Context, version 00: 00-<32 digits>-<16 digits>-<2 digits>, lower case.
  constexpr std::size_t kLength = 55;
  if (text.size() != kLength || !text.starts_with("00-") || text[35] != '-' || text[52] != '-') {
    return false;
  }
  return std::ranges::all_of(
      text, [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f') || c == '-'; });
}

std::string_view trace_id_of(std::string_view traceparent) {
  constexpr std::size_t kBegin = 3;
  constexpr std::size_t kDigits = 32;
  return is_traceparent(traceparent) ? traceparent.substr(kBegin, kDigits) : std::string_view();
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
