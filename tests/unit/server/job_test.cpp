#include "server/jobs/job.hpp"

#include <gtest/gtest.h>

#include <array>

namespace symcell::server {
namespace {

constexpr std::array kEvents{JobEvent::kStart, JobEvent::kSucceed, JobEvent::kFail,
                             JobEvent::kCancel, JobEvent::kRequeue};

struct Transition {
  JobState from;
  JobEvent event;
  JobState to;
};

// The whole machine; every pair that is missing here is forbidden.
constexpr std::array kAllowed{
    Transition{JobState::kQueued, JobEvent::kStart, JobState::kRunning},
    Transition{JobState::kQueued, JobEvent::kFail, JobState::kFailed},
    Transition{JobState::kQueued, JobEvent::kCancel, JobState::kCancelled},
    Transition{JobState::kRunning, JobEvent::kSucceed, JobState::kSucceeded},
    Transition{JobState::kRunning, JobEvent::kFail, JobState::kFailed},
    Transition{JobState::kRunning, JobEvent::kCancel, JobState::kCancelled},
    Transition{JobState::kRunning, JobEvent::kRequeue, JobState::kQueued},
};

std::optional<JobState> expected(JobState from, JobEvent event) {
  for (const Transition& transition : kAllowed) {
    if (transition.from == from && transition.event == event) return transition.to;
  }
  return std::nullopt;
}

TEST(JobStateTest, EveryPairOfStateAndEventDoesWhatTheTableSays) {
  for (const JobState state : kAllJobStates) {
    for (const JobEvent event : kEvents) {
      EXPECT_EQ(next_state(state, event), expected(state, event))
          << job_state_name(state) << " with event " << static_cast<int>(event);
    }
  }
}

TEST(JobStateTest, FinishedStatesAreFinal) {
  for (const JobState state : kAllJobStates) {
    bool leaves = false;
    for (const JobEvent event : kEvents) leaves = leaves || next_state(state, event);
    EXPECT_EQ(is_finished(state), !leaves) << job_state_name(state);
  }
}

TEST(JobStateTest, NamesComeBack) {
  for (const JobState state : kAllJobStates) {
    EXPECT_EQ(job_state_from_name(job_state_name(state)), state);
  }
  EXPECT_FALSE(job_state_from_name("done"));
  EXPECT_FALSE(job_state_from_name(""));
}

}  // namespace
}  // namespace symcell::server
