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

TEST_F(SqliteJobStoreTest, AJobComesBackAsItWasStored) {
  store_.insert(new_job("a"), std::nullopt, {});
  const auto job = store_.find("a");
  ASSERT_TRUE(job);
  EXPECT_EQ(job->state, JobState::kQueued);
  EXPECT_EQ(job->created_ms, 1000);
  EXPECT_FALSE(job->started_ms);
  EXPECT_EQ(job->model_format, ModelFormat::kPoly);
  EXPECT_EQ(job->model_name, "part.poly");
  EXPECT_EQ(job->options_json, "{\"fold\":3}");
  EXPECT_EQ(job->model_bytes, 10);
  EXPECT_FALSE(store_.find("b"));
}

TEST_F(SqliteJobStoreTest, EventsChangeStateAndTimes) {
  store_.insert(new_job("a"), std::nullopt, {});
  EXPECT_EQ(store_.apply("a", JobEvent::kStart, {.time_ms = 2000})->started_ms, 2000);
  const auto failed = store_.apply(
      "a", JobEvent::kFail, {.time_ms = 3000, .error_code = "time_limit", .error_json = "{}"});
  ASSERT_TRUE(failed);
  EXPECT_EQ(failed->state, JobState::kFailed);
  const auto stored = store_.find("a");
  EXPECT_EQ(stored->started_ms, 2000);
  EXPECT_EQ(stored->finished_ms, 3000);
  EXPECT_EQ(stored->error_code, "time_limit");
}

Job job_of(const std::string& id, const std::string& client, int weight = 1) {
  Job job = new_job(id);
  job.client = client;
  job.weight = weight;
  return job;
}

TEST_F(SqliteJobStoreTest, ClientsTakeTurns) {
  for (const char* id : {"a1", "a2", "a3", "a4"}) store_.insert(job_of(id, "a"), std::nullopt, {});
  EXPECT_EQ(store_.claim(1)->id, "a1");
  store_.insert(job_of("b1", "b"), std::nullopt, {});
  store_.insert(job_of("b2", "b"), std::nullopt, {});
  store_.insert(job_of("c1", "c"), std::nullopt, {});
  store_.apply("a3", JobEvent::kCancel, {.time_ms = 1});
  std::string order;
  while (const auto job = store_.claim(1)) order += job->id + " ";
  EXPECT_EQ(order, "a2 b1 c1 b2 a4 ");
}

TEST_F(SqliteJobStoreTest, AClientOfWeightTwoHasTwoTurns) {
  for (const char* id : {"a1", "a2", "a3"}) store_.insert(job_of(id, "a"), std::nullopt, {});
  for (const char* id : {"b1", "b2", "b3", "b4"}) {
    store_.insert(job_of(id, "b", 2), std::nullopt, {});
  }
  std::string order;
  while (const auto job = store_.claim(1)) order += job->client;
  EXPECT_EQ(order, "ababbab");  // after the first, two of b for one of a
}

TEST_F(SqliteJobStoreTest, AJobIsStartedOnceAndARunThatWasGivenUpWritesNothing) {
  store_.insert(new_job("a"), std::nullopt, {});
  const auto first = store_.claim(2000);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->state, JobState::kRunning);
  EXPECT_EQ(first->started_ms, 2000);
  EXPECT_EQ(first->attempt, 1);
  EXPECT_FALSE(store_.claim(2000));
  ASSERT_TRUE(store_.apply("a", JobEvent::kRequeue, {.time_ms = 1, .attempt = 1}));
  EXPECT_EQ(store_.claim(3000)->attempt, 2);
  EXPECT_FALSE(store_.apply("a", JobEvent::kSucceed, {.time_ms = 1, .attempt = 1}));
  EXPECT_EQ(store_.find("a")->state, JobState::kRunning);
  EXPECT_TRUE(store_.apply("a", JobEvent::kSucceed, {.time_ms = 1, .attempt = 2}));
}

TEST_F(SqliteJobStoreTest, AFullQueueTakesNothingInAllOrOfAClient) {
  const Admission two_and_one{2, 1};
  EXPECT_EQ(store_.insert(job_of("a", "x"), std::nullopt, two_and_one).result,
            InsertResult::kInserted);
  EXPECT_EQ(store_.insert(job_of("b", "x"), std::nullopt, two_and_one).result,
            InsertResult::kQueueFull);
  EXPECT_EQ(store_.usage("x").queued, 1);
  EXPECT_EQ(store_.insert(job_of("c", "y"), std::nullopt, two_and_one).result,
            InsertResult::kInserted);
  EXPECT_EQ(store_.insert(job_of("d", "z"), std::nullopt, two_and_one).result,
            InsertResult::kQueueFull);
  EXPECT_FALSE(store_.find("d"));
}

TEST_F(SqliteJobStoreTest, ForbiddenEventsChangeNothing) {
  store_.insert(new_job("a"), std::nullopt, {});
  EXPECT_FALSE(store_.apply("a", JobEvent::kSucceed, {.time_ms = 1}));
  EXPECT_FALSE(store_.apply("unknown", JobEvent::kStart, {.time_ms = 1}));
  EXPECT_EQ(store_.find("a")->state, JobState::kQueued);
}

TEST_F(SqliteJobStoreTest, LostWorkersAreCountedAcrossRequeues) {
  store_.insert(new_job("a"), std::nullopt, {});
  for (int i = 1; i <= 2; ++i) {
    store_.apply("a", JobEvent::kStart, {.time_ms = 1});
    store_.count_lost_worker("a");
    const auto requeued = store_.apply("a", JobEvent::kRequeue, {.time_ms = 1});
    EXPECT_EQ(requeued->lost_workers, i);
    EXPECT_FALSE(requeued->started_ms);
  }
  EXPECT_EQ(store_.find("a")->lost_workers, 2);
}

TEST_F(SqliteJobStoreTest, TheSameKeyGivesTheSameJobOrAConflict) {
  const IdempotencyKey key{"k", "digest"};
  EXPECT_FALSE(store_.find_key(key));
  EXPECT_EQ(store_.insert(new_job("a"), key, {}).result, InsertResult::kInserted);
  const auto replayed = store_.insert(new_job("b"), key, {});
  EXPECT_EQ(replayed.result, InsertResult::kReplayed);
  EXPECT_EQ(replayed.job.id, "a");
  EXPECT_FALSE(store_.find("b"));
  EXPECT_EQ(store_.insert(new_job("c"), IdempotencyKey{"k", "other"}, {}).result,
            InsertResult::kConflict);
  EXPECT_EQ(store_.find_key({"k", "other"})->result, InsertResult::kConflict);
}

TEST_F(SqliteJobStoreTest, AnErasedJobFreesItsKey) {
  const IdempotencyKey key{"k", "digest"};
  store_.insert(new_job("a"), key, {});
  EXPECT_TRUE(store_.erase("a"));
  EXPECT_FALSE(store_.erase("a"));
  EXPECT_FALSE(store_.find_key(key));
}

TEST_F(SqliteJobStoreTest, ListsNewestFirstByStateInPages) {
  for (const char* id : {"a", "b", "c", "d"}) store_.insert(new_job(id), std::nullopt, {});
  store_.apply("b", JobEvent::kCancel, {.time_ms = 1});
  JobFilter filter;
  filter.limit = 2;
  auto page = store_.list(filter);
  ASSERT_EQ(page.size(), 2U);
  EXPECT_EQ(page[0].id, "d");
  EXPECT_EQ(page[1].id, "c");
  filter.before_sequence = page[1].sequence;
  page = store_.list(filter);
  ASSERT_EQ(page.size(), 2U);
  EXPECT_EQ(page[0].id, "b");
  EXPECT_EQ(page[1].id, "a");
  filter = {};
  filter.state = JobState::kCancelled;
  EXPECT_EQ(store_.list(filter).size(), 1U);
  EXPECT_EQ(store_.unfinished().front().id, "a");
  EXPECT_EQ(store_.unfinished().size(), 3U);
  EXPECT_EQ(store_.oldest_finished(10).size(), 1U);
}

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
        "SELECT digest, job_id FROM idempotency_keys WHERE key = 'a'"}) {
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
