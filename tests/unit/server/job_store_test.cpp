// What every store promises, of both.
#include "server/jobs/job_store.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <pqxx/pqxx>
#include <set>
#include <thread>
#include <vector>

#include "server/jobs/postgres_job_store.hpp"
#include "server/jobs/sqlite_job_store.hpp"
#include "tests/support/test_files.hpp"
#include "tests/unit/server/postgres_server.hpp"

namespace symcell::server::test {
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

Job job_of(const std::string& id, const std::string& client, int weight = 1) {
  Job job = new_job(id);
  job.client = client;
  job.weight = weight;
  return job;
}

class JobStoreTest : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (!shared()) {
      store_ = std::make_unique<SqliteJobStore>(folder_ / "jobs.sqlite");
      return;
    }
    PostgresServer* server = PostgresServer::instance();
    if (server == nullptr) GTEST_SKIP() << "no PostgreSQL server is installed";
    server->clear();
    store_ = std::make_unique<PostgresJobStore>(server->url(), "folder");
  }

  [[nodiscard]] bool shared() const { return GetParam() == std::string_view("postgres"); }

  symcell::test::TemporaryFolder folder_;
  std::unique_ptr<JobStore> store_;
};

INSTANTIATE_TEST_SUITE_P(Stores,
                         JobStoreTest,
                         ::testing::Values("sqlite", "postgres"),
                         [](const auto& store) { return std::string(store.param); });

TEST_P(JobStoreTest, AJobComesBackAsItWasStored) {
  store_->insert(new_job("a"), std::nullopt, {});
  const auto job = store_->find("a");
  ASSERT_TRUE(job);
  EXPECT_EQ(job->state, JobState::kQueued);
  if (!shared()) {
    EXPECT_EQ(job->created_ms, 1000);
  }
  EXPECT_FALSE(job->started_ms);
  EXPECT_EQ(job->model_format, ModelFormat::kPoly);
  EXPECT_EQ(job->model_name, "part.poly");
  EXPECT_EQ(job->options_json, "{\"fold\":3}");
  EXPECT_EQ(job->model_bytes, 10);
  EXPECT_FALSE(store_->find("b"));
}

TEST_P(JobStoreTest, EventsChangeStateAndTimes) {
  store_->insert(new_job("a"), std::nullopt, {});
  const auto started = store_->apply("a", JobEvent::kStart, {.time_ms = 2000});
  if (!shared()) {
    EXPECT_EQ(started->started_ms, 2000);
  }
  const auto failed = store_->apply(
      "a", JobEvent::kFail, {.time_ms = 3000, .error_code = "time_limit", .error_json = "{}"});
  ASSERT_TRUE(failed);
  EXPECT_EQ(failed->state, JobState::kFailed);
  const auto stored = store_->find("a");
  // PostgreSQL has a clock of its own.
  if (!shared()) {
    EXPECT_EQ(stored->started_ms, 2000);
    EXPECT_EQ(stored->finished_ms, 3000);
  }
  EXPECT_GE(stored->finished_ms, stored->started_ms);
  EXPECT_EQ(stored->error_code, "time_limit");
}

TEST_P(JobStoreTest, ClientsTakeTurns) {
  for (const char* id : {"a1", "a2", "a3", "a4"}) store_->insert(job_of(id, "a"), std::nullopt, {});
  EXPECT_EQ(store_->claim(1)->id, "a1");
  store_->insert(job_of("b1", "b"), std::nullopt, {});
  store_->insert(job_of("b2", "b"), std::nullopt, {});
  store_->insert(job_of("c1", "c"), std::nullopt, {});
  store_->apply("a3", JobEvent::kCancel, {.time_ms = 1});
  std::string order;
  while (const auto job = store_->claim(1)) order += job->id + " ";
  EXPECT_EQ(order, "a2 b1 c1 b2 a4 ");
}

TEST_P(JobStoreTest, AClientOfWeightTwoHasTwoTurns) {
  for (const char* id : {"a1", "a2", "a3"}) store_->insert(job_of(id, "a"), std::nullopt, {});
  for (const char* id : {"b1", "b2", "b3", "b4"}) {
    store_->insert(job_of(id, "b", 2), std::nullopt, {});
  }
  std::string order;
  while (const auto job = store_->claim(1)) order += job->client;
  EXPECT_EQ(order, "ababbab");  // after the first, two of b for one of a
}

TEST_P(JobStoreTest, AJobIsStartedOnceAndARunThatWasGivenUpWritesNothing) {
  store_->insert(new_job("a"), std::nullopt, {});
  const auto first = store_->claim(2000);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->state, JobState::kRunning);
  if (!shared()) {
    EXPECT_EQ(first->started_ms, 2000);
  }
  EXPECT_EQ(first->attempt, 1);
  EXPECT_FALSE(store_->claim(2000));
  ASSERT_TRUE(store_->apply("a", JobEvent::kRequeue, {.time_ms = 1, .attempt = 1}));
  EXPECT_EQ(store_->claim(3000)->attempt, 2);
  EXPECT_FALSE(store_->apply("a", JobEvent::kSucceed, {.time_ms = 1, .attempt = 1}));
  EXPECT_EQ(store_->find("a")->state, JobState::kRunning);
  EXPECT_TRUE(store_->apply("a", JobEvent::kSucceed, {.time_ms = 1, .attempt = 2}));
}

TEST_P(JobStoreTest, NoClientHasMoreRunsThanItMay) {
  for (const char* id : {"a1", "a2"}) {
    Job job = job_of(id, "a");
    job.most_running = 1;
    store_->insert(job, std::nullopt, {});
  }
  store_->insert(job_of("b1", "b"), std::nullopt, {});
  EXPECT_EQ(store_->claim(1)->id, "a1");
  EXPECT_EQ(store_->claim(1)->id, "b1");
  EXPECT_FALSE(store_->claim(1));
  store_->apply("a1", JobEvent::kSucceed, {.time_ms = 1, .attempt = 1});
  EXPECT_EQ(store_->claim(1)->id, "a2");
}

TEST_P(JobStoreTest, MessagesAreOnTheirWayUntilTheyArrive) {
  Job job = new_job("a");
  job.webhook = "https://hooks.example/";
  store_->insert(job, std::nullopt, {});
  store_->insert(new_job("b"), std::nullopt, {});
  EXPECT_FALSE(store_->claim_delivery(std::chrono::seconds(60)));
  for (const char* id : {"a", "b"}) store_->apply(id, JobEvent::kCancel, {.time_ms = 1});
  const auto first = store_->claim_delivery(std::chrono::milliseconds(-1));  // due again at once
  ASSERT_TRUE(first);
  EXPECT_EQ(first->job_id, "a");
  EXPECT_EQ(first->address, "https://hooks.example/");
  store_->delivery_failed("a", std::chrono::milliseconds(-1));
  EXPECT_EQ(store_->claim_delivery(std::chrono::seconds(60))->tries, 1);
  EXPECT_FALSE(store_->claim_delivery(std::chrono::seconds(60))) << "somebody is at it";
  store_->delivery_failed("a", std::nullopt);
  EXPECT_FALSE(store_->claim_delivery(std::chrono::milliseconds(-1)));
}

TEST_P(JobStoreTest, AFullQueueTakesNothingInAllOrOfAClient) {
  const Admission two_and_one{2, 1};
  EXPECT_EQ(store_->insert(job_of("a", "x"), std::nullopt, two_and_one).result,
            InsertResult::kInserted);
  EXPECT_EQ(store_->insert(job_of("b", "x"), std::nullopt, two_and_one).result,
            InsertResult::kQueueFull);
  EXPECT_EQ(store_->usage("x", 0).queued, 1);
  EXPECT_EQ(store_->insert(job_of("c", "y"), std::nullopt, two_and_one).result,
            InsertResult::kInserted);
  EXPECT_EQ(store_->insert(job_of("d", "z"), std::nullopt, two_and_one).result,
            InsertResult::kQueueFull);
  EXPECT_FALSE(store_->find("d"));
}

TEST_P(JobStoreTest, ForbiddenEventsChangeNothing) {
  store_->insert(new_job("a"), std::nullopt, {});
  EXPECT_FALSE(store_->apply("a", JobEvent::kSucceed, {.time_ms = 1}));
  EXPECT_FALSE(store_->apply("unknown", JobEvent::kStart, {.time_ms = 1}));
  EXPECT_EQ(store_->find("a")->state, JobState::kQueued);
}

TEST_P(JobStoreTest, LostWorkersAreCountedAcrossRequeues) {
  store_->insert(new_job("a"), std::nullopt, {});
  for (int i = 1; i <= 2; ++i) {
    store_->apply("a", JobEvent::kStart, {.time_ms = 1});
    store_->count_lost_worker("a");
    const auto requeued = store_->apply("a", JobEvent::kRequeue, {.time_ms = 1});
    EXPECT_EQ(requeued->lost_workers, i);
    EXPECT_FALSE(requeued->started_ms);
  }
  EXPECT_EQ(store_->find("a")->lost_workers, 2);
}

TEST_P(JobStoreTest, TheSameKeyGivesTheSameJobOrAConflict) {
  const IdempotencyKey key{"k", "digest"};
  EXPECT_FALSE(store_->find_key(key));
  EXPECT_EQ(store_->insert(new_job("a"), key, {}).result, InsertResult::kInserted);
  const auto replayed = store_->insert(new_job("b"), key, {});
  EXPECT_EQ(replayed.result, InsertResult::kReplayed);
  EXPECT_EQ(replayed.job.id, "a");
  EXPECT_FALSE(store_->find("b"));
  EXPECT_EQ(store_->insert(new_job("c"), IdempotencyKey{"k", "other"}, {}).result,
            InsertResult::kConflict);
  EXPECT_EQ(store_->find_key({"k", "other"})->result, InsertResult::kConflict);
}

TEST_P(JobStoreTest, AnErasedJobFreesItsKey) {
  const IdempotencyKey key{"k", "digest"};
  store_->insert(new_job("a"), key, {});
  EXPECT_TRUE(store_->erase("a"));
  EXPECT_FALSE(store_->erase("a"));
  EXPECT_FALSE(store_->find_key(key));
}

TEST_P(JobStoreTest, ListsNewestFirstByStateInPages) {
  for (const char* id : {"a", "b", "c", "d"}) store_->insert(new_job(id), std::nullopt, {});
  store_->apply("b", JobEvent::kCancel, {.time_ms = 1});
  JobFilter filter;
  filter.limit = 2;
  auto page = store_->list(filter);
  ASSERT_EQ(page.size(), 2U);
  EXPECT_EQ(page[0].id, "d");
  EXPECT_EQ(page[1].id, "c");
  filter.before_sequence = page[1].sequence;
  page = store_->list(filter);
  ASSERT_EQ(page.size(), 2U);
  EXPECT_EQ(page[0].id, "b");
  EXPECT_EQ(page[1].id, "a");
  filter = {};
  filter.state = JobState::kCancelled;
  EXPECT_EQ(store_->list(filter).size(), 1U);
  EXPECT_EQ(store_->unfinished().front().id, "a");
  EXPECT_EQ(store_->unfinished().size(), 3U);
  EXPECT_EQ(store_->oldest_finished(10).size(), 1U);
}

class SharedJobStoreTest : public JobStoreTest {
 protected:
  [[nodiscard]] std::unique_ptr<JobStore> another() const {
    return std::make_unique<PostgresJobStore>(PostgresServer::instance()->url(), "folder");
  }
};

INSTANTIATE_TEST_SUITE_P(Stores, SharedJobStoreTest, ::testing::Values("postgres"));

TEST_P(SharedJobStoreTest, ARunIsItsServersAsLongAsThatKeepsIt) {
  const auto other = another();
  store_->insert(new_job("a"), std::nullopt, {});
  const auto run = store_->claim(0);
  ASSERT_TRUE(run);
  EXPECT_FALSE(other->claim(0));
  EXPECT_TRUE(store_->keep({{"a", 1, {Phase::kRefine, 0.5, 42, 0.25}}}).empty());
  EXPECT_EQ(other->find("a")->progress->elements, 42U);
  EXPECT_EQ(other->find("a")->progress->phase, Phase::kRefine);
  EXPECT_EQ(other->rescue(), 0U) << "it is kept";
  // Another server's word about it counts for nothing.
  EXPECT_TRUE(other->keep({{"a", 1, {}}}).front().lost);
  other->request_cancel("a");
  const auto orders = store_->keep({{"a", 1, {}}});
  ASSERT_EQ(orders.size(), 1U);
  EXPECT_TRUE(orders.front().cancel);
  EXPECT_FALSE(orders.front().lost);
  other->erase("a");
  EXPECT_TRUE(store_->keep({{"a", 1, {}}}).front().lost);
}

TEST_P(SharedJobStoreTest, ARunThatNobodyKeepsGoesToAnotherAndItsFormerServerIsNotHeard) {
  const auto other = another();
  store_->insert(new_job("a"), std::nullopt, {});
  ASSERT_TRUE(store_->claim(0));
  {
    pqxx::connection connection(PostgresServer::instance()->url());
    pqxx::work transaction(connection);
    transaction.exec("UPDATE symcell_jobs SET leased_until_ms = symcell_now_ms() - 1");
    transaction.commit();
  }
  EXPECT_EQ(other->rescue(), 1U);
  EXPECT_EQ(other->claim(0)->attempt, 2);
  EXPECT_TRUE(store_->keep({{"a", 1, {}}}).front().lost);
  EXPECT_FALSE(store_->apply("a", JobEvent::kSucceed, {.attempt = 1, .result_bytes = 7}));
  EXPECT_FALSE(store_->apply("a", JobEvent::kRequeue, {.attempt = 1}));
  EXPECT_TRUE(other->apply("a", JobEvent::kSucceed, {.attempt = 2, .result_bytes = 9}));
  EXPECT_EQ(store_->find("a")->result_bytes, 9);
}

TEST_P(SharedJobStoreTest, ServersThatClaimAtOnceGetDifferentJobs) {
  constexpr int kJobs = 60;
  for (int i = 0; i < kJobs; ++i) store_->insert(new_job(std::to_string(i)), std::nullopt, {});
  const auto other = another();
  std::mutex mutex;
  std::multiset<std::string> claimed;
  std::vector<std::thread> threads;
  for (JobStore* store : {store_.get(), other.get(), store_.get(), other.get()}) {
    threads.emplace_back([&, store] {
      while (const auto job = store->claim(0)) {
        const std::lock_guard lock(mutex);
        claimed.insert(job->id);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  // Whom another just takes is passed over, so a thread may end early; nothing is taken twice.
  while (const auto job = store_->claim(0)) claimed.insert(job->id);
  EXPECT_EQ(claimed.size(), static_cast<std::size_t>(kJobs));
  EXPECT_EQ(std::set<std::string>(claimed.begin(), claimed.end()).size(), claimed.size());
}

TEST_P(SharedJobStoreTest, OthersHearOfChanges) {
  const auto other = another();
  std::atomic<int> heard{0};
  other->listen([&](std::string_view) { ++heard; });
  const auto until = [&](int least) {
    for (int i = 0; i < 500 && heard < least; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return heard >= least;
  };
  ASSERT_TRUE(until(1)) << "it begins by looking";
  store_->insert(new_job("a"), std::nullopt, {});
  EXPECT_TRUE(until(2));
}

TEST_P(SharedJobStoreTest, AnotherFolderOrANewerSchemaIsRefused) {
  EXPECT_THROW(PostgresJobStore(PostgresServer::instance()->url(), "another"), std::runtime_error);
  pqxx::connection connection(PostgresServer::instance()->url());
  pqxx::work transaction(connection);
  transaction.exec("UPDATE symcell_schema SET version = 1000");
  transaction.commit();
  EXPECT_THROW(another(), std::runtime_error);
}

}  // namespace
}  // namespace symcell::server::test
