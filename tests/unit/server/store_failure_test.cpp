// A store that fails for a while: nothing is stuck once the cause is gone, and meanwhile it is told.
#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include "server/jobs/sqlite_job_store.hpp"
#include "server/jobs/watched_job_store.hpp"
#include "tests/unit/server/http_fixture.hpp"
#include "tests/unit/server/service_under_test.hpp"

namespace symcell::server::test {
namespace {

// Another process that holds the database, a backup that hangs for instance.
class Lock {
 public:
  explicit Lock(const std::filesystem::path& folder)
      : database_((folder / "jobs.sqlite").string(), SQLite::OPEN_READWRITE) {
    database_.setBusyTimeout(5000);
    database_.exec("BEGIN IMMEDIATE");
  }
  void release() { database_.exec("ROLLBACK"); }

 private:
  SQLite::Database database_;
};

class StoreFailureTest : public ::testing::Test {
 protected:
  // Waits until the store was asked in vain.
  [[nodiscard]] bool fails() {
    return eventually([&] {
      const std::string text = service_.metrics.text();
      return text.find("symcell_store_errors_total{operation=\"apply\"}") != std::string::npos ||
             text.find("symcell_store_errors_total{operation=\"claim\"}") != std::string::npos;
    });
  }

  ServiceUnderTest service_;
};

TEST_F(StoreFailureTest, AJobWhoseEndCannotBeWrittenEndsWhenItCan) {
  service_.engine.close_gate();
  const std::string id = service_.submit().job.id;
  ASSERT_TRUE(service_.reaches(id, JobState::kRunning));
  Lock lock(service_.folder.path());
  service_.engine.open_gate();
  ASSERT_TRUE(fails());
  EXPECT_EQ(service_.jobs->find(id)->state, JobState::kRunning);
  EXPECT_THROW(service_.jobs->check_health(), StoreError);
  lock.release();
  EXPECT_TRUE(service_.reaches(id, JobState::kSucceeded));
  EXPECT_NO_THROW(service_.jobs->check_health());
}

TEST_F(StoreFailureTest, AJobWhoseStartCannotBeWrittenStartsWhenItCan) {
  service_.engine.close_gate();
  const std::string first = service_.submit().job.id;
  const std::string second = service_.submit().job.id;
  ASSERT_TRUE(service_.reaches(first, JobState::kRunning));
  ASSERT_TRUE(service_.jobs->erase(first));  // frees the worker for the second one soon
  Lock lock(service_.folder.path());
  service_.engine.open_gate();
  ASSERT_TRUE(fails());
  lock.release();
  EXPECT_TRUE(service_.reaches(second, JobState::kSucceeded));
}

TEST_F(StoreFailureTest, ACancelThatCannotBeWrittenLeavesTheJobInTheQueue) {
  service_.engine.close_gate();
  ASSERT_TRUE(service_.reaches(service_.submit().job.id, JobState::kRunning));
  const std::string waiting = service_.submit().job.id;
  Lock lock(service_.folder.path());
  EXPECT_THROW(service_.jobs->cancel(waiting), StoreError);
  EXPECT_THROW(service_.jobs->erase(waiting), StoreError);
  lock.release();
  service_.engine.open_gate();
  EXPECT_TRUE(service_.reaches(waiting, JobState::kSucceeded));
}

TEST_F(StoreFailureTest, AServerThatStopsMeanwhileStops) {
  service_.engine.close_gate();
  const std::string id = service_.submit().job.id;
  ASSERT_TRUE(service_.reaches(id, JobState::kRunning));
  Lock lock(service_.folder.path());
  service_.engine.open_gate();
  ASSERT_TRUE(fails());
  EXPECT_TRUE(service_.close());
  lock.release();
  service_.open();
  EXPECT_TRUE(service_.reaches(id, JobState::kSucceeded));
}

class StoreFailureHttpTest : public HttpTest {};

TEST_F(StoreFailureHttpTest, IsToldAndPasses) {
  ASSERT_TRUE(reaches(submit()["id"], "succeeded"));
  {
    Lock lock(folder_.path());
    const auto refused = client().Post("/v1/jobs", job_body(), "application/json");
    EXPECT_EQ(problem_of(refused, 503)["code"], "store_unavailable");
    EXPECT_FALSE(refused->get_header_value("Retry-After").empty());
    EXPECT_EQ(problem_of(client().Get("/readyz"), 503)["code"], "store_unavailable");
    EXPECT_EQ(client().Get("/healthz")->status, 200);
    EXPECT_EQ(client().Get("/v1/jobs")->status, 200);
    lock.release();
  }
  EXPECT_EQ(client().Get("/readyz")->status, 200);
  EXPECT_TRUE(reaches(submit()["id"], "succeeded"));
}

}  // namespace
}  // namespace symcell::server::test
