#include "server/jobs/sqlite_job_store.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include "tests/support/test_files.hpp"

namespace symcell::server {
namespace {

Job new_job(const std::string& id) {
  Job job;
  job.id = id;
  job.created_ms = 1000;
  job.model_format = ModelFormat::kPoly;
  job.model_name = "part.poly";
  job.options_json = "{\"fold\":3}";
  job.model_bytes = 10;
  return job;
}

class SqliteJobStoreTest : public ::testing::Test {
 protected:
  symcell::test::TemporaryFolder folder_;
  SqliteJobStore store_{folder_ / "jobs.sqlite"};
};

TEST_F(SqliteJobStoreTest, TotalsCountStatesAndBytes) {
  store_.insert(new_job("a"), std::nullopt, {});
  store_.insert(new_job("b"), std::nullopt, {});
  store_.apply("b", JobEvent::kStart, {.time_ms = 1});
  store_.apply("b", JobEvent::kSucceed, {.time_ms = 2, .result_bytes = 5});
  const StoreTotals totals = store_.totals();
  EXPECT_EQ(totals.by_state[static_cast<std::size_t>(JobState::kQueued)], 1);
  EXPECT_EQ(totals.by_state[static_cast<std::size_t>(JobState::kSucceeded)], 1);
  EXPECT_EQ(totals.bytes, 25);
}

TEST_F(SqliteJobStoreTest, TotalsFollowEveryChangeAndAreThoseOfAnotherOpening) {
  const auto expect = [&](std::int64_t queued, std::int64_t failed, std::int64_t bytes) {
    SqliteJobStore again(folder_ / "jobs.sqlite");
    for (SqliteJobStore* store : {&store_, &again}) {
      const StoreTotals totals = store->totals();
      EXPECT_EQ(totals.by_state[static_cast<std::size_t>(JobState::kQueued)], queued);
      EXPECT_EQ(totals.by_state[static_cast<std::size_t>(JobState::kFailed)], failed);
      EXPECT_EQ(totals.bytes, bytes);
    }
  };
  const IdempotencyKey key{"k", "d"};
  store_.insert(new_job("a"), key, {});
  store_.insert(new_job("b"), std::nullopt, {});
  store_.insert(new_job("c"), key, {});  // a repetition: not stored
  expect(2, 0, 20);
  store_.apply("a", JobEvent::kStart, {.time_ms = 1});
  store_.apply("a", JobEvent::kRequeue, {.time_ms = 1});
  store_.apply("b", JobEvent::kFail, {.time_ms = 1, .result_bytes = 7});
  store_.apply("b", JobEvent::kFail, {.time_ms = 1, .result_bytes = 7});  // forbidden
  expect(1, 1, 27);
  store_.erase("b");
  store_.erase("b");
  expect(1, 0, 10);
}

// What every submission costs must not grow with what is stored: no statement of a job's life scans
// the table.
TEST_F(SqliteJobStoreTest, NothingScansTheTable) {
  SQLite::Database database((folder_ / "jobs.sqlite").string(), SQLite::OPEN_READONLY);
  for (const char* statement :
       {"SELECT * FROM jobs WHERE id = 'a'", "DELETE FROM jobs WHERE id = 'a'",
        "UPDATE jobs SET state = 'x' WHERE id = 'a'",
        "SELECT * FROM jobs WHERE finished_clock_ms IS NOT NULL ORDER BY finished_clock_ms, "
        "sequence LIMIT 9",
        "SELECT * FROM jobs WHERE sequence < 9 AND state = 'x' ORDER BY sequence DESC LIMIT 9",
        "SELECT * FROM jobs WHERE sequence < 9 ORDER BY sequence DESC LIMIT 9",
        "SELECT 1 FROM erased WHERE id = 'a'",
        "SELECT id FROM jobs INDEXED BY jobs_waiting WHERE state = 'queued' ORDER BY turn, "
        "sequence LIMIT 1",
        "SELECT COUNT(*) FROM jobs INDEXED BY jobs_waiting_by_client WHERE state = 'queued' AND "
        "client = 'x'",
        "SELECT MAX(turn) FROM jobs INDEXED BY jobs_waiting_by_client WHERE state = 'queued' AND "
        "client = 'x'",
        "SELECT MAX(turn) FROM jobs INDEXED BY jobs_running WHERE state = 'running'",
        "SELECT digest, job_id FROM idempotency_keys WHERE owner = '' AND key = 'a'",
        "SELECT * FROM jobs WHERE sequence < 9 AND owner = 'x' ORDER BY sequence DESC LIMIT 9",
        "SELECT * FROM jobs WHERE sequence < 9 AND state = 'y' AND owner = 'x' ORDER BY sequence "
        "DESC LIMIT 9"}) {
    SQLite::Statement plan(database, std::string("EXPLAIN QUERY PLAN ") + statement);
    while (plan.executeStep()) {
      const std::string step = plan.getColumn(3).getString();
      const bool scans =
          step.find("SCAN") != std::string::npos && step.find("INDEX") == std::string::npos;
      EXPECT_FALSE(scans) << statement << ": " << step;
      EXPECT_EQ(step.find("TEMP B-TREE"), std::string::npos) << statement << ": " << step;
    }
  }
}

TEST_F(SqliteJobStoreTest, AnotherOpeningFindsTheJobs) {
  store_.insert(new_job("a"), std::nullopt, {});
  SqliteJobStore again(folder_ / "jobs.sqlite");
  EXPECT_TRUE(again.find("a"));
}

TEST(SqliteJobStoreVersionTest, ANewerSchemaIsRefused) {
  const symcell::test::TemporaryFolder folder;
  {
    SQLite::Database database((folder / "jobs.sqlite").string(),
                              SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    database.exec("PRAGMA user_version = 1000");
  }
  EXPECT_THROW(SqliteJobStore(folder / "jobs.sqlite"), std::runtime_error);
}

TEST(SqliteJobStoreVersionTest, AFileThatIsNoDatabaseIsRefused) {
  const symcell::test::TemporaryFolder folder;
  symcell::test::write_file(folder / "jobs.sqlite", std::string(5000, 'x'));
  EXPECT_THROW(SqliteJobStore(folder / "jobs.sqlite"), std::runtime_error);
}

}  // namespace
}  // namespace symcell::server
