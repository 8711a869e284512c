// What is said to last is on the disk before it is said, and a disk that refuses once is not believed when it says
// yes the next time.
#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <functional>
#include <semaphore>
#include <thread>

#include "server/base/identifiers.hpp"
#include "server/jobs/copy_keeper.hpp"
#include "server/jobs/sqlite_job_store.hpp"
#include "server/jobs/staged_model.hpp"
#include "server/jobs/watched_job_store.hpp"
#include "tests/unit/server/service_under_test.hpp"
#include "tests/unit/server/watched_disk.hpp"

namespace symcell::server::test {
namespace {

using Call = WatchedDisk::Call;
constexpr int kAlways = 1'000'000;

Job new_job(const std::string& id) {
  Job job;
  job.id = id;
  job.created_ms = 1000;
  job.options_json = "{}";
  job.model_bytes = 10;
  return job;
}

class DurableStoreTest : public ::testing::Test {
 protected:
  // What the database alone has, as a machine finds it whose disk lost the log.
  [[nodiscard]] bool lasts_without_the_log(const std::string& id) const {
    const symcell::test::TemporaryFolder other;
    std::filesystem::copy_file(folder_ / "jobs.sqlite", other / "jobs.sqlite");
    SqliteJobStore store(other / "jobs.sqlite");
    return store.find(id).has_value();
  }

  symcell::test::TemporaryFolder folder_;
  SqliteJobStore store_{folder_ / "jobs.sqlite"};
  WatchedDisk disk_;
};

TEST_F(DurableStoreTest, AfterARefusalTheLogIsEmptiedAndItsEmptinessSynchronised) {
  store_.insert(new_job("a"), std::nullopt, {});
  WatchedDisk::refuse(Call::kData, "-wal", 1);
  EXPECT_THROW(store_.make_durable(), StoreError);
  WatchedDisk::forget();
  store_.make_durable();
  const auto logs = WatchedDisk::granted(Call::kData, "-wal");
  ASSERT_FALSE(logs.empty());
  EXPECT_EQ(logs.back().bytes, 0);
  EXPECT_TRUE(lasts_without_the_log("a"));
  // The log is believed again.
  WatchedDisk::forget();
  store_.insert(new_job("b"), std::nullopt, {});
  store_.make_durable();
  ASSERT_FALSE(WatchedDisk::granted(Call::kData, "-wal").empty());
  EXPECT_GT(WatchedDisk::granted(Call::kData, "-wal").back().bytes, 0);
  EXPECT_TRUE(WatchedDisk::granted(Call::kData, "/jobs.sqlite").empty());
}

TEST_F(DurableStoreTest, TheLogIsNotBelievedUntilTheDiskTookAllOfIt) {
  store_.insert(new_job("a"), std::nullopt, {});
  // Ours, and SQLite's own before it reads the log into the database.
  WatchedDisk::refuse(Call::kData, "-wal", 2);
  EXPECT_THROW(store_.make_durable(), StoreError);
  EXPECT_THROW(store_.make_durable(), StoreError);
  store_.make_durable();
  EXPECT_EQ(WatchedDisk::granted(Call::kData, "-wal").back().bytes, 0);
  EXPECT_TRUE(lasts_without_the_log("a"));
}

TEST_F(DurableStoreTest, AProbeWaitsForItsOwnWrite) {
  store_.make_durable();
  WatchedDisk::forget();
  store_.check_health();
  EXPECT_EQ(WatchedDisk::granted(Call::kData, "-wal").size(), 1U);
  WatchedDisk::refuse(Call::kData, "-wal", 1);
  EXPECT_THROW(store_.check_health(), StoreError);
}

TEST_F(DurableStoreTest, WhatCommitsNothingWaitsForNothing) {
  store_.insert(new_job("a"), std::nullopt, {});
  store_.make_durable();
  WatchedDisk::forget();
  EXPECT_FALSE(store_.claim_delivery(std::chrono::seconds(60)));
  EXPECT_EQ(store_.newest_copy(), 0);
  EXPECT_FALSE(store_.apply("b", JobEvent::kStart, {}));
  EXPECT_FALSE(store_.erase("b"));
  store_.make_durable();
  EXPECT_TRUE(WatchedDisk::granted(Call::kData, "-wal").empty());
}

// Whoever hears of a failure may ask again.
TEST_F(DurableStoreTest, ACallThatThrowsHasChangedNothing) {
  store_.insert(new_job("a"), std::nullopt, {});
  store_.make_durable();
  WatchedDisk::refuse(Call::kData, "-wal", kAlways);
  const auto throws = [](const auto& call) {
    try {
      call();
      return false;
    } catch (const StoreError&) {
      return true;
    }
  };
  const bool not_counted = throws([&] { store_.count_lost_worker("a"); });
  EXPECT_EQ(not_counted, store_.find("a")->lost_workers == 0);
  const bool not_failed = throws([&] { store_.apply("a", JobEvent::kFail, {}); });
  EXPECT_EQ(not_failed, store_.find("a")->state == JobState::kQueued);
  const bool not_forgotten = throws([&] { store_.forget_model("a"); });
  EXPECT_EQ(not_forgotten, store_.find("a")->model_kept);
  const bool not_erased = throws([&] { store_.erase("a"); });
  EXPECT_EQ(not_erased, store_.find("a").has_value());
  EXPECT_THROW(store_.make_durable(), StoreError);
}

// A write that nobody has waited for says nothing of the disk.
TEST(DurabilityTest, AStoreIsWellAgainWhenAWriteLasts) {
  const WatchedDisk disk;
  const symcell::test::TemporaryFolder folder;
  Metrics metrics;
  Logger logger{LogLevel::kOff, LogFormat::kText};
  WatchedJobStore store(std::make_unique<SqliteJobStore>(folder / "jobs.sqlite"), metrics, logger);
  WatchedDisk::refuse(Call::kData, "-wal", kAlways);
  store.insert(new_job("a"), std::nullopt, {});
  EXPECT_THROW(store.check_health(), StoreError);
  store.insert(new_job("b"), std::nullopt, {});
  EXPECT_THROW(store.check_health(), StoreError);
  WatchedDisk::refuse(Call::kData, "", 0);
  store.make_durable();
  WatchedDisk::refuse(Call::kData, "-wal", kAlways);
  EXPECT_NO_THROW(store.check_health()) << "a write that lasts is as good as a probe";
}

class DurableServiceTest : public ::testing::Test {
 protected:
  WatchedDisk disk_;
  ServiceUnderTest service_;
};

TEST_F(DurableServiceTest, ARepeatedRequestIsNotToldOfAnEndThatMightBeUndone) {
  service_.engine.close_gate();
  const std::string id = service_.submit("key").job.id;
  ASSERT_TRUE(service_.reaches(id, JobState::kRunning));
  WatchedDisk::refuse(Call::kData, "-wal", kAlways);
  service_.engine.open_gate();
  ASSERT_TRUE(eventually([&] { return service_.jobs->store().find(id)->finished_ms.has_value(); }));
  const auto arrived = service_.jobs->files().incoming();
  symcell::test::write_file(arrived, square_json());
  Submission again;
  again.model = arrived;
  again.idempotency_key = "key";
  again.durable_soon = true;
  EXPECT_THROW(static_cast<void>(service_.jobs->submit(again)), StoreError);
  WatchedDisk::refuse(Call::kData, "", 0);
  const auto outcome = service_.jobs->submit(again);
  EXPECT_EQ(outcome.status, SubmitStatus::kReplayed);
  EXPECT_EQ(outcome.job.state, JobState::kSucceeded);
}

TEST_F(DurableServiceTest, WhatIsDeletedWhileTheDiskRefusesGoesWithTheNextTidying) {
  const std::string id = service_.submit().job.id;
  ASSERT_TRUE(service_.reaches(id, JobState::kSucceeded));
  ASSERT_TRUE(eventually([&] { return service_.jobs->runner().running() == 0; }));
  const auto folder = service_.jobs->files().model(id).parent_path();
  WatchedDisk::refuse(Call::kData, "-wal", 1);
  EXPECT_THROW(service_.jobs->erase(id), StoreError);
  EXPECT_TRUE(std::filesystem::exists(folder)) << "the row may come back";
  JobStore& store = service_.jobs->store();
  tidy_erased(store, service_.jobs->files(), 1);
  EXPECT_FALSE(std::filesystem::exists(folder));
  EXPECT_FALSE(store.was_erased(id));
}

TEST_F(DurableServiceTest, RetentionRemovesFilesOnceTheirRowsAreGoneForGood) {
  const std::string id = service_.submit().job.id;
  ASSERT_TRUE(service_.reaches(id, JobState::kSucceeded));
  ASSERT_TRUE(service_.reaches(service_.submit().job.id, JobState::kSucceeded));
  ASSERT_TRUE(eventually([&] { return service_.jobs->runner().running() == 0; }));
  service_.jobs->make_durable();
  const auto folder = service_.jobs->files().model(id).parent_path();
  const RetentionRules rules{.max_jobs = 1};
  WatchedDisk::refuse(Call::kData, "-wal", 1);
  EXPECT_THROW(apply_retention(rules, service_.jobs->store(), service_.jobs->files()), StoreError);
  EXPECT_TRUE(std::filesystem::exists(folder));
}

// Runs one job to its end; returns it. Calls `submitted` once the disk has the job.
Job run_one(
    JobEngine& engine,
    const std::filesystem::path& folder,
    const std::function<void()>& submitted = [] {}) {
  Metrics metrics;
  Logger logger{LogLevel::kOff, LogFormat::kText};
  JobService jobs(folder, {}, engine, metrics, logger);
  jobs.start();
  Submission submission;
  submission.model = jobs.files().incoming();
  symcell::test::write_file(submission.model, square_json());
  const std::string id = jobs.submit(submission).job.id;
  submitted();
  EXPECT_TRUE(eventually([&] { return is_finished(jobs.find(id)->state); }));
  return *jobs.find(id);
}

class LosingEngine final : public StubEngine {
 public:
  [[nodiscard]] Result<void> run(const EngineJob& job, ExecutionContext& context) override {
    submitted_.acquire();
    WatchedDisk::refuse(Call::kData, "-wal", 3);
    job.on_lost_worker();
    WatchedDisk::refuse(Call::kData, "", 0);
    return StubEngine::run(job, context);
  }
  // Submitting waits for the disk beside the run, which may have begun.
  void submitted() { submitted_.release(); }

 private:
  std::binary_semaphore submitted_{0};
};

TEST(DurabilityTest, ALostWorkerIsCountedOnceHoweverOftenTheDiskRefuses) {
  const WatchedDisk disk;
  const symcell::test::TemporaryFolder folder;
  LosingEngine engine;
  EXPECT_EQ(run_one(engine, folder.path(), [&] { engine.submitted(); }).lost_workers, 1);
}

class LargeEngine final : public StubEngine {
 public:
  [[nodiscard]] Result<void> run(const EngineJob& job, ExecutionContext& context) override {
    auto done = StubEngine::run(job, context);
    std::ofstream(job.statistics, std::ios::app) << std::string(2 * kSmallFileBytes, ' ');
    return done;
  }
};

// The folder got its name without waiting: its model is small, and has a copy in the store.
TEST(DurabilityTest, LargeResultsAreSynchronisedWithAllFoldersAboveThem) {
  const WatchedDisk disk;
  const symcell::test::TemporaryFolder folder;
  LargeEngine engine;
  const Job job = run_one(engine, folder.path());
  ASSERT_EQ(job.state, JobState::kSucceeded);
  for (const std::string& path :
       {"/jobs/" + job.id + "/cell", "/jobs/" + job.id + "/statistics.json", "/jobs/" + job.id,
        std::string("/jobs")}) {
    EXPECT_FALSE(WatchedDisk::granted(Call::kFile, path).empty()) << path;
  }
}

class CopyKeeperTest : public ::testing::Test {
 protected:
  CopyKeeperTest() {
    const auto arrived = files_.incoming();
    symcell::test::write_file(arrived, square_json());
    Job job = new_job(make_job_id(1000));
    id_ = job.id;
    files_.adopt_model(arrived, id_, false);
    store_.insert(job, std::nullopt, {}, {{"model", square_json()}});
  }

  [[nodiscard]] std::string model() const { return symcell::test::read_file(files_.model(id_)); }
  // What the kernel shows of pages that it could not write, once it has let go of them.
  void lose_model() const { symcell::test::write_file(files_.model(id_), "lost"); }

  symcell::test::TemporaryFolder folder_;
  SqliteJobStore store_{folder_ / "jobs.sqlite"};
  JobFiles files_{folder_.path()};
  Logger logger_{LogLevel::kOff, LogFormat::kText};
  std::string id_;
  WatchedDisk disk_;
};

TEST_F(CopyKeeperTest, CopiesAreForgottenWhenAllFilesAreSynchronised) {
  settle_model(files_, id_);
  const CopyKeeper keeper(store_, files_, logger_, std::chrono::milliseconds(1));
  EXPECT_TRUE(eventually([&] { return !store_.copy_after(0); }));
  EXPECT_EQ(WatchedDisk::granted(Call::kFileSystem, "/jobs").size(), 1U);
  EXPECT_EQ(store_.copied_bytes(), 0U);
}

TEST_F(CopyKeeperTest, AfterARefusalFilesAreWrittenAgainBeforeTheirCopiesAreForgotten) {
  settle_model(files_, id_);
  lose_model();
  WatchedDisk::refuse(Call::kFileSystem, "/jobs", 2);
  const CopyKeeper keeper(store_, files_, logger_, std::chrono::milliseconds(1));
  EXPECT_TRUE(eventually([&] { return !store_.copy_after(0); }));
  EXPECT_EQ(model(), square_json());
}

// The folder of a job that is just accepted lacks its name for a moment.
TEST_F(CopyKeeperTest, AFolderGetsItsNameOnce) {
  WatchedDisk::refuse(Call::kFileSystem, "/jobs", 1);
  const CopyKeeper keeper(store_, files_, logger_, std::chrono::milliseconds(1));
  EXPECT_TRUE(eventually([&] { return !store_.copy_after(0); }));
  EXPECT_EQ(model(), square_json());
  EXPECT_FALSE(std::filesystem::exists(staged_folder(files_, id_)));
  EXPECT_NO_THROW(settle_model(files_, id_));
}

TEST_F(CopyKeeperTest, AStartWritesFilesThatLookSoundForAnEarlierServerMayHaveMetARefusal) {
  settle_model(files_, id_);
  // Another name for the file that is there now: a file that is written again is another one.
  std::filesystem::create_hard_link(files_.model(id_), folder_ / "before");
  restore_copies(store_, files_, logger_);
  EXPECT_FALSE(std::filesystem::equivalent(files_.model(id_), folder_ / "before"));
  EXPECT_EQ(model(), square_json());
  EXPECT_FALSE(store_.copy_after(0));
}

}  // namespace
}  // namespace symcell::server::test
