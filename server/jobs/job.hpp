// A job: what was asked, what became of it, and the state machine between the two.
//
//   queued --start--> running --succeed--> succeeded
//     |                 |  \---fail------> failed
//     |                 |---cancel-------> cancelled
//     |                 \---requeue------> queued       (server stopped or died meanwhile)
//     |---cancel--> cancelled
//     \---fail----> failed                              (its model file is gone)
// Finished states (succeeded, failed, cancelled) are final.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "api/formats/model_reader.hpp"
#include "core/base/execution_context.hpp"

namespace symcell::server {

enum class JobState : std::uint8_t { kQueued, kRunning, kSucceeded, kFailed, kCancelled };
enum class JobEvent : std::uint8_t { kStart, kSucceed, kFail, kCancel, kRequeue };

inline constexpr JobState kAllJobStates[] = {JobState::kQueued, JobState::kRunning,
                                             JobState::kSucceeded, JobState::kFailed,
                                             JobState::kCancelled};

[[nodiscard]] std::string_view job_state_name(JobState state);
[[nodiscard]] std::optional<JobState> job_state_from_name(std::string_view name);
// The trace that a traceparent names; empty: none.
[[nodiscard]] std::string_view trace_id_of(std::string_view traceparent);
[[nodiscard]] bool is_traceparent(std::string_view text);
[[nodiscard]] bool is_finished(JobState state);

// nullopt: the event is not allowed in this state.
[[nodiscard]] std::optional<JobState> next_state(JobState state, JobEvent event);

struct Job {
  std::string id;
  std::int64_t sequence = 0;      // order of acceptance, given by the store
  std::string client;             // whose it is where clients take turns: a key, or an address
  std::int32_t weight = 1;        // jobs of this client for one of a client of weight 1
  std::string owner;              // the id of the key that it was sent with; empty: none
  std::int64_t most_running = 0;  // jobs of this client at once; 0: any number
  JobState state = JobState::kQueued;
  std::int64_t created_ms = 0;
  std::optional<std::int64_t> started_ms;
  std::optional<std::int64_t> finished_ms;
  std::optional<std::int64_t> finished_clock_ms;  // by JobStore::clock_ms

  ModelFormat model_format = ModelFormat::kPslgJson;
  std::string model_name;    // of the uploaded file, may be empty
  std::string options_json;  // every option that is set, limits of the server applied

  std::string error_code;  // name of the code; empty unless failed
  std::string error_json;  // problem document; empty unless failed
  std::int64_t model_bytes = 0;
  // SHA-256 of the stored files; empty where an earlier version took none. A cell carries its own.
  std::string model_sha256;
  std::string statistics_sha256;
  std::int64_t result_bytes = 0;
  std::int32_t lost_workers = 0;  // how often a worker that ran this job was killed from outside
  std::int32_t attempt = 0;       // how often it was started
  bool model_kept = true;         // false: retention has removed the model
  std::string request_id;         // of the request that brought it
  std::string traceparent;        // likewise, W3C Trace Context; empty: none came
  std::string webhook;            // address that is told of its end; empty: none
  // As another server noted it; of stores that servers share.
  std::optional<Progress> progress;
};

}  // namespace symcell::server
