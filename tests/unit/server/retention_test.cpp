#include "server/jobs/retention.hpp"

#include <gtest/gtest.h>

#include "server/jobs/sqlite_job_store.hpp"
#include "tests/support/test_files.hpp"

namespace symcell::server {
namespace {

constexpr std::int64_t kHourMs = 3'600'000;

class RetentionTest : public ::testing::Test {
 protected:
  void add_finished(const std::string& id, std::int64_t finished_ms) {
    Job job;
    job.id = id;
    job.model_bytes = 10;
    store_.insert(job, std::nullopt);
    store_.apply(id, JobEvent::kStart, {.time_ms = finished_ms});
    store_.apply(id, JobEvent::kSucceed, {.time_ms = finished_ms, .result_bytes = 90});
  }
  std::size_t apply(const RetentionRules& rules) {
    return apply_retention(rules, store_, files_, 100 * kHourMs);
  }

  symcell::test::TemporaryFolder folder_;
  JobFiles files_{folder_.path()};
  SqliteJobStore store_{files_.database()};
};

TEST_F(RetentionTest, NoRulesKeepEverything) {
  add_finished("a", 0);
  EXPECT_EQ(apply({}), 0U);
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

TEST_F(RetentionTest, UnfinishedJobsStay) {
  Job job;
  job.id = "waiting";
  job.model_bytes = 1000;
  store_.insert(job, std::nullopt);
  EXPECT_EQ(apply({.max_age_s = 1, .max_jobs = 1, .max_bytes = 1}), 0U);
  EXPECT_TRUE(store_.find("waiting"));
}

}  // namespace
}  // namespace symcell::server
