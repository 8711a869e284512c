#include "server/jobs/retention.hpp"

#include <gtest/gtest.h>

#include "server/jobs/sqlite_job_store.hpp"
#include "server/jobs/staged_model.hpp"
#include "tests/support/test_files.hpp"

namespace symcell::server {
namespace {

constexpr std::int64_t kHourMs = 3'600'000;

class RetentionTest : public ::testing::Test {
 protected:
  [[nodiscard]] MachineClocks clocks() {
    return {[this] { return wall_; }, [this] { return steady_; }};
  }
  void add_finished(const std::string& id, std::int64_t finished_ms) {
    Job job;
    job.id = id;
    job.model_bytes = 10;
    store_.insert(job, std::nullopt, {});
    steady_ = finished_ms;
    store_.apply(id, JobEvent::kStart, {.time_ms = finished_ms});
    store_.apply(id, JobEvent::kSucceed, {.time_ms = finished_ms, .result_bytes = 90});
  }
  std::size_t apply(const RetentionRules& rules) {
    steady_ = 100 * kHourMs;
    return apply_retention(rules, store_, files_);
  }

  symcell::test::TemporaryFolder folder_;
  JobFiles files_{folder_.path()};
  std::int64_t wall_ = 0;
  std::int64_t steady_ = 0;
  SqliteJobStore store_{files_.database(), {}, clocks()};
};

TEST_F(RetentionTest, NoRulesKeepEverything) {
  add_finished("a", 0);
  EXPECT_EQ(apply({}), 0U);
}

TEST_F(RetentionTest, ModelsOfJobsWithoutAResultGoBeforeTheirJobs) {
  add_finished("succeeded", 0);
  for (const char* id : {"failed", "late"}) {
    Job job;
    job.id = id;
    job.model_bytes = 10;
    store_.insert(job, std::nullopt, {});
    steady_ = id == std::string("late") ? 90 * kHourMs : 0;
    store_.apply(id, JobEvent::kFail, {.time_ms = 1});
    symcell::test::write_file(folder_ / (std::string("arrived") + id), "model");
    files_.adopt_model(folder_ / (std::string("arrived") + id), id, true);
    settle_model(files_, id);
  }
  steady_ = 100 * kHourMs;
  const RetentionRules rules{.spent_model_age_s = 24L * 3600};
  EXPECT_EQ(remove_spent_models(rules, store_, files_), 1U);
  EXPECT_FALSE(std::filesystem::exists(files_.model("failed")));
  EXPECT_TRUE(std::filesystem::exists(files_.model("late")));
  EXPECT_FALSE(store_.find("failed")->model_kept);
  EXPECT_TRUE(store_.find("succeeded")->model_kept);
  EXPECT_EQ(store_.totals().bytes, 110);
  EXPECT_EQ(remove_spent_models(rules, store_, files_), 0U);
}

TEST_F(RetentionTest, OldJobsGo) {
  add_finished("old", 10 * kHourMs);
  add_finished("new", 99 * kHourMs);
  EXPECT_EQ(apply({.max_age_s = 3600 * 24}), 1U);
  EXPECT_FALSE(store_.find("old"));
  EXPECT_TRUE(store_.find("new"));
}

TEST_F(RetentionTest, TheOldestGoWhenThereAreTooMany) {
  add_finished("b", 2 * kHourMs);
  add_finished("a", 1 * kHourMs);
  add_finished("c", 3 * kHourMs);
  EXPECT_EQ(apply({.max_jobs = 1}), 2U);
  EXPECT_TRUE(store_.find("c"));
}

TEST_F(RetentionTest, TheOldestGoWhenTheyTakeTooMuchRoom) {
  add_finished("a", 1 * kHourMs);
  add_finished("b", 2 * kHourMs);
  EXPECT_EQ(apply({.max_bytes = 150}), 1U);
  EXPECT_FALSE(store_.find("a"));
}

TEST_F(RetentionTest, AClockThatIsSetRemovesNothing) {
  add_finished("a", 1 * kHourMs);
  wall_ += 30 * 24 * kHourMs;
  EXPECT_EQ(apply({.max_age_s = 7 * 24 * 3600}), 0U);
  // Also when the server starts with the clock set.
  wall_ += 300 * 24 * kHourMs;
  SqliteJobStore again(files_.database(), {}, clocks());
  EXPECT_EQ(apply_retention({.max_age_s = 7 * 24 * 3600}, again, files_), 0U);
  wall_ -= 700 * 24 * kHourMs;
  SqliteJobStore third(files_.database(), {}, clocks());
  EXPECT_EQ(apply_retention({.max_age_s = 7 * 24 * 3600}, third, files_), 0U);
  // And time that really passes counts, with the server up and down.
  for (int day = 0; day < 6; ++day) {
    SqliteJobStore next(files_.database(), {}, clocks());
    steady_ += 12 * kHourMs;
    next.tidy(0);
    wall_ += 24 * kHourMs;  // down for as long again
  }
  SqliteJobStore last(files_.database(), {}, clocks());
  EXPECT_EQ(apply_retention({.max_age_s = 7 * 24 * 3600}, last, files_), 1U);
}

TEST_F(RetentionTest, OneSweepRemovesAShareOfWhatIsTooOld) {
  for (int i = 0; i < 130; ++i) add_finished("job" + std::to_string(i), i);
  EXPECT_EQ(apply({.max_age_s = 1}), 100U);
  EXPECT_EQ(apply({.max_age_s = 1}), 30U);
  // Room and number are no matter of clocks.
  for (int i = 0; i < 110; ++i) add_finished("job" + std::to_string(i), i);
  EXPECT_EQ(apply({.max_jobs = 1}), 109U);
}

TEST_F(RetentionTest, NoJobEndsBeforeItStarts) {
  Job job;
  job.id = "a";
  job.created_ms = 5000;
  store_.insert(job, std::nullopt, {});
  EXPECT_EQ(store_.apply("a", JobEvent::kStart, {.time_ms = 1000})->started_ms, 5000);
  EXPECT_EQ(store_.apply("a", JobEvent::kSucceed, {.time_ms = 2000})->finished_ms, 5000);
}

TEST_F(RetentionTest, UnfinishedJobsStay) {
  Job job;
  job.id = "waiting";
  job.model_bytes = 1000;
  store_.insert(job, std::nullopt, {});
  EXPECT_EQ(apply({.max_age_s = 1, .max_jobs = 1, .max_bytes = 1}), 0U);
  EXPECT_TRUE(store_.find("waiting"));
}

}  // namespace
}  // namespace symcell::server
