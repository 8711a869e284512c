// A disk that takes nothing for a while, seen by the process that meshes.
#include <gtest/gtest.h>

#include <atomic>

#include "server/jobs/job_service.hpp"
#include "tests/unit/server/service_under_test.hpp"

namespace symcell::server::test {
namespace {

class FullDiskEngine final : public JobEngine {
 public:
  [[nodiscard]] Result<void> run(const EngineJob& job, ExecutionContext& context) override {
    ++runs;
    if (full) return fail(ErrorCode::kWriteFailed, "No space left on device");
    return stub_.run(job, context);
  }
  [[nodiscard]] Result<ModelFormat> recognise(const std::filesystem::path& model,
                                              std::optional<ModelFormat> promised,
                                              ExecutionContext& context) override {
    return stub_.recognise(model, promised, context);
  }
  [[nodiscard]] Result<std::string> inspect(const std::filesystem::path& model,
                                            ModelFormat format,
                                            const MeshOptions& options,
                                            ExecutionContext& context) override {
    return stub_.inspect(model, format, options, context);
  }
  [[nodiscard]] Result<void> draw(const std::filesystem::path& model,
                                  ModelFormat format,
                                  const MeshOptions& options,
                                  const std::filesystem::path& picture,
                                  ExecutionContext& context) override {
    return stub_.draw(model, format, options, picture, context);
  }

  std::atomic<bool> full{true};
  std::atomic<int> runs{0};

 private:
  StubEngine stub_;
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
  ASSERT_TRUE(eventually([&] { return engine.runs >= 1; }));
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
  ASSERT_TRUE(eventually([&] { return engine.runs >= 1; }));
  EXPECT_TRUE(jobs.finish_stop(std::chrono::milliseconds(0)));
  EXPECT_EQ(jobs.find(id)->state, JobState::kQueued);
}

}  // namespace
}  // namespace symcell::server::test
