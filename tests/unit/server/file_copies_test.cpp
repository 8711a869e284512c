// What a failure of the machine takes of files that were not synchronised comes back from their copies.
#include <gtest/gtest.h>

#include "server/base/identifiers.hpp"
#include "server/jobs/sqlite_job_store.hpp"
#include "server/jobs/staged_model.hpp"
#include "server/jobs/stored_files.hpp"
#include "tests/unit/server/service_under_test.hpp"

namespace symcell::server::test {
namespace {

class FileCopiesTest : public ::testing::Test {
 protected:
  ServiceUnderTest service_;
};

TEST_F(FileCopiesTest, ResultsThatWereLostAreThereAfterAStart) {
  const std::string id = service_.submit().job.id;
  ASSERT_TRUE(service_.reaches(id, JobState::kSucceeded));
  const Job job = *service_.jobs->find(id);
  const std::string statistics = read_statistics(job, service_.jobs->files());
  const auto cell = service_.jobs->files().cell(id);
  const auto model = service_.jobs->files().model(id);
  ASSERT_TRUE(service_.close());
  // As the kernel leaves files whose names it had written and whose bytes it had not.
  std::filesystem::resize_file(cell, 0);
  std::filesystem::remove_all(model.parent_path() / "statistics.json");
  service_.open();
  EXPECT_EQ(read_statistics(job, service_.jobs->files()), statistics);
  EXPECT_NO_THROW(static_cast<void>(read_cell(job, service_.jobs->files())));
  EXPECT_EQ(service_.engine.runs(), 1);
}

TEST_F(FileCopiesTest, ALostFolderComesBackWithItsModelAndTheJobRuns) {
  service_.engine.close_gate();
  const std::string id = service_.submit().job.id;
  ASSERT_TRUE(service_.reaches(id, JobState::kRunning));
  const auto folder = service_.jobs->files().model(id).parent_path();
  ASSERT_TRUE(service_.close());
  std::filesystem::remove_all(folder);
  service_.engine.open_gate();
  service_.open();
  EXPECT_TRUE(service_.reaches(id, JobState::kSucceeded));
}

TEST_F(FileCopiesTest, CopiesAreForgottenOnceTheFilesAreSynchronised) {
  const std::string id = service_.submit().job.id;
  ASSERT_TRUE(service_.reaches(id, JobState::kSucceeded));
  ASSERT_TRUE(eventually([&] { return !service_.jobs->find(id)->statistics_sha256.empty(); }));
  EXPECT_TRUE(service_.jobs->store().copy_after(0));
  EXPECT_GT(service_.jobs->store().copied_bytes(), 0U);
  ASSERT_TRUE(service_.close());
  service_.open();
  EXPECT_FALSE(service_.jobs->store().copy_after(0));
  ASSERT_TRUE(service_.jobs->erase(id));
}

TEST_F(FileCopiesTest, WhatWasDeletedStaysAway) {
  const std::string id = service_.submit().job.id;
  ASSERT_TRUE(service_.reaches(id, JobState::kSucceeded));
  const auto folder = service_.jobs->files().model(id).parent_path();
  ASSERT_TRUE(service_.jobs->erase(id));
  ASSERT_TRUE(service_.close());
  service_.open();
  EXPECT_FALSE(std::filesystem::exists(folder));
  EXPECT_FALSE(service_.jobs->store().copy_after(0));
}

// A job thread that just became free may claim a job before whoever accepted it has named its folder.
TEST(StagedModelTest, AJobThatIsClaimedBeforeItsFolderHasItsNameRuns) {
  const symcell::test::TemporaryFolder folder;
  SqliteJobStore store(folder / "jobs.sqlite");
  const JobFiles files(folder.path());
  const auto arrived = files.incoming();
  symcell::test::write_file(arrived, square_json());
  Job job;
  job.id = make_job_id(1000);
  job.created_ms = 1000;
  job.options_json = "{}";
  job.model_bytes = static_cast<std::int64_t>(std::filesystem::file_size(arrived));
  files.adopt_model(arrived, job.id, true);
  ASSERT_EQ(store.insert(job, std::nullopt, {}).result, InsertResult::kInserted);
  StubEngine engine;
  const FaultArchive faults(folder / "faults");
  ChangeSignal changes;
  Metrics metrics;
  Logger logger{LogLevel::kOff, LogFormat::kText};
  JobRunner::declare_metrics(metrics);
  JobRunner runner(RunnerParts{engine, store, files, faults, changes, metrics, logger}, 1);
  runner.start();
  EXPECT_TRUE(eventually([&] { return is_finished(store.find(job.id)->state); }));
  EXPECT_EQ(store.find(job.id)->state, JobState::kSucceeded);
  // Whoever accepted it comes late.
  EXPECT_NO_THROW(settle_model(files, job.id));
  EXPECT_TRUE(runner.stop(std::chrono::milliseconds(0)));
}

}  // namespace
}  // namespace symcell::server::test
