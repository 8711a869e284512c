// What a server finds after an earlier one stopped or died.
#include <gtest/gtest.h>

#include "server/jobs/job_service.hpp"
#include "server/jobs/sqlite_job_store.hpp"
#include "tests/unit/server/service_under_test.hpp"

namespace symcell::server::test {
namespace {

class JobRestartTest : public ::testing::Test {
 protected:
  // As if the server had died while it ran the job.
  void mark_running(const std::string& id) {
    SqliteJobStore store(service_.folder / "jobs.sqlite");
    ASSERT_TRUE(store.apply(id, JobEvent::kStart, {.time_ms = 1}));
  }

  ServiceUnderTest service_;
};

TEST_F(JobRestartTest, FinishedJobsAndTheirResultsAreStillThere) {
  const std::string id = service_.submit().job.id;
  ASSERT_TRUE(service_.reaches(id, JobState::kSucceeded));
  ASSERT_TRUE(service_.close());
  service_.open();
  EXPECT_EQ(service_.jobs->find(id)->state, JobState::kSucceeded);
  EXPECT_TRUE(std::filesystem::exists(service_.jobs->files().cell(id)));
  EXPECT_EQ(service_.engine.runs(), 1);
}

TEST_F(JobRestartTest, RunningAndWaitingJobsRunAgainAfterAStop) {
  service_.engine.close_gate();
  const std::string running = service_.submit().job.id;
  ASSERT_TRUE(service_.reaches(running, JobState::kRunning));
  const std::string waiting = service_.submit().job.id;
  ASSERT_TRUE(service_.close());
  {
    SqliteJobStore store(service_.folder / "jobs.sqlite");
    EXPECT_EQ(store.find(running)->state, JobState::kQueued);
    EXPECT_EQ(store.find(running)->lost_workers, 0);
  }
  service_.engine.open_gate();
  service_.open();
  EXPECT_TRUE(service_.reaches(running, JobState::kSucceeded));
  EXPECT_TRUE(service_.reaches(waiting, JobState::kSucceeded));
}

TEST_F(JobRestartTest, TheGracePeriodLetsARunningJobFinish) {
  service_.engine.close_gate();
  const std::string id = service_.submit().job.id;
  ASSERT_TRUE(service_.reaches(id, JobState::kRunning));
  std::thread opener([&] {
    while (!service_.jobs->stopping()) std::this_thread::yield();
    service_.engine.open_gate();
  });
  EXPECT_TRUE(service_.jobs->finish_stop(std::chrono::seconds(10)));
  opener.join();
  EXPECT_EQ(service_.jobs->find(id)->state, JobState::kSucceeded);
}

TEST_F(JobRestartTest, DeathsOfTheServerAreNoFaultOfTheJobThatRan) {
  service_.engine.close_gate();
  const std::string id = service_.submit().job.id;
  ASSERT_TRUE(service_.reaches(id, JobState::kRunning));
  ASSERT_TRUE(service_.close());
  for (int death = 1; death <= 5; ++death) {
    mark_running(id);
    service_.open();
    ASSERT_TRUE(service_.reaches(id, JobState::kRunning)) << death;
    ASSERT_TRUE(service_.close());
  }
  service_.engine.open_gate();
  service_.open();
  EXPECT_TRUE(service_.reaches(id, JobState::kSucceeded));
}

TEST_F(JobRestartTest, AJobWithoutItsModelFails) {
  service_.engine.close_gate();
  const std::string running = service_.submit().job.id;
  ASSERT_TRUE(service_.reaches(running, JobState::kRunning));
  const std::string id = service_.submit().job.id;
  const auto model = service_.jobs->files().model(id);
  service_.forget_copies();
  ASSERT_TRUE(service_.close());
  std::filesystem::remove(model);
  service_.open();
  EXPECT_EQ(service_.jobs->find(id)->state, JobState::kFailed);
}

TEST_F(JobRestartTest, BodiesThatWereArrivingAreRemovedAndWhatIsUnknownIsPutAway) {
  const auto orphan = service_.folder.path() / "jobs" / "unknown";
  const auto upload = service_.jobs->files().incoming();
  const auto stray = service_.folder.path() / "incoming" / "half";
  ASSERT_TRUE(service_.close());
  std::filesystem::create_directory(orphan);
  symcell::test::write_file(upload, "half a model");
  symcell::test::write_file(stray, "no name of ours");
  service_.open();
  EXPECT_FALSE(std::filesystem::exists(orphan));
  EXPECT_FALSE(std::filesystem::exists(upload));
  EXPECT_FALSE(std::filesystem::exists(stray));
  std::size_t kept = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(service_.folder.path() / "quarantine")) {
    const auto name = entry.path().filename();
    if (name == "unknown" || name == "half") ++kept;
  }
  EXPECT_EQ(kept, 2U);
}

}  // namespace
}  // namespace symcell::server::test
