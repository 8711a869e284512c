// A disk that takes nothing for a while, seen by the process that meshes.
#include <gtest/gtest.h>

#include <atomic>

#include "server/jobs/job_service.hpp"
#include "tests/unit/server/service_under_test.hpp"

namespace symcell::server::test {
namespace {

class FullDiskEngine final : public StubEngine {
 public:
  [[nodiscard]] Result<void> run(const EngineJob& job, ExecutionContext& context) override {
    ++attempts;
    if (full) return fail(ErrorCode::kWriteFailed, "No space left on device");
    return StubEngine::run(job, context);
  }

  std::atomic<bool> full{true};
  std::atomic<int> attempts{0};
};

TEST(DiskFullTest, AJobIsMeshedAgainWhenThereIsRoom) {
  const symcell::test::TemporaryFolder folder;
  FullDiskEngine engine;
  Metrics metrics;
  Logger logger{LogLevel::kOff, LogFormat::kText};
  JobService jobs(folder.path(), {}, engine, metrics, logger);
  jobs.start();
  Submission submission;
  submission.model = jobs.files().incoming();
  symcell::test::write_file(submission.model, square_json());
  const std::string id = jobs.submit(submission).job.id;
  ASSERT_TRUE(eventually([&] { return engine.attempts >= 1; }));
  EXPECT_EQ(jobs.find(id)->state, JobState::kRunning);
  engine.full = false;
  EXPECT_TRUE(eventually([&] { return jobs.find(id)->state == JobState::kSucceeded; }));
  EXPECT_TRUE(jobs.finish_stop(std::chrono::milliseconds(0)));
}

TEST(DiskFullTest, AServerThatStopsMeanwhileLeavesTheJobQueued) {
  const symcell::test::TemporaryFolder folder;
  FullDiskEngine engine;
  Metrics metrics;
  Logger logger{LogLevel::kOff, LogFormat::kText};
  JobService jobs(folder.path(), {}, engine, metrics, logger);
  jobs.start();
  Submission submission;
  submission.model = jobs.files().incoming();
  symcell::test::write_file(submission.model, square_json());
  const std::string id = jobs.submit(submission).job.id;
  ASSERT_TRUE(eventually([&] { return engine.attempts >= 1; }));
  EXPECT_TRUE(jobs.finish_stop(std::chrono::milliseconds(0)));
  EXPECT_EQ(jobs.find(id)->state, JobState::kQueued);
}

}  // namespace
}  // namespace symcell::server::test
