#include "server/jobs/job_service.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/unit/server/service_under_test.hpp"

namespace symcell::server::test {
namespace {

class JobServiceTest : public ::testing::Test {
 protected:
  // Runs a job that occupies the only worker.
  std::string occupy_worker() {
    service_.engine.close_gate();
    const std::string id = service_.submit().job.id;
    EXPECT_TRUE(service_.reaches(id, JobState::kRunning));
    return id;
  }

  ServiceUnderTest service_;
};

TEST_F(JobServiceTest, ASubmittedJobRunsAndLeavesItsFiles) {
  const auto outcome = service_.submit();
  ASSERT_EQ(outcome.status, SubmitStatus::kAccepted);
  ASSERT_TRUE(service_.reaches(outcome.job.id, JobState::kSucceeded));
  const auto job = service_.jobs->find(outcome.job.id);
  EXPECT_TRUE(job->started_ms);
  EXPECT_TRUE(job->finished_ms);
  EXPECT_GT(job->result_bytes, 0);
  EXPECT_TRUE(std::filesystem::exists(service_.jobs->files().cell(job->id)));
  EXPECT_TRUE(std::filesystem::exists(service_.jobs->files().statistics(job->id)));
  EXPECT_TRUE(std::filesystem::exists(service_.jobs->files().model(job->id)));
}

TEST_F(JobServiceTest, AFullQueueRefusesAndHasRoomAgainLater) {
  occupy_worker();
  const auto first = service_.submit();
  EXPECT_EQ(first.status, SubmitStatus::kAccepted);
  EXPECT_EQ(service_.submit().status, SubmitStatus::kAccepted);
  EXPECT_TRUE(service_.jobs->queue_is_full());
  EXPECT_EQ(service_.submit().status, SubmitStatus::kQueueFull);
  service_.jobs->cancel(first.job.id);
  EXPECT_EQ(service_.submit().status, SubmitStatus::kAccepted);
}

TEST_F(JobServiceTest, ClientsTakeTurnsAndNoneTakesAllPlaces) {
  ASSERT_TRUE(service_.close());
  service_.limits.queue_limit = 20;
  service_.open();
  occupy_worker();
  std::vector<std::string> greedy;
  for (int i = 0; i < 18; ++i) greedy.push_back(service_.submit("", kInfinity, "greedy").job.id);
  EXPECT_EQ(service_.submit("", kInfinity, "greedy").status, SubmitStatus::kQueueFull);
  EXPECT_TRUE(service_.jobs->queue_is_full("greedy"));
  EXPECT_FALSE(service_.jobs->queue_is_full("modest"));
  const auto modest = service_.submit("", kInfinity, "modest");
  ASSERT_EQ(modest.status, SubmitStatus::kAccepted);
  service_.engine.open_gate();
  ASSERT_TRUE(service_.reaches(greedy.back(), JobState::kSucceeded));
  // Its turn came after the first of the other's.
  const auto started = [&](const std::string& id) { return *service_.jobs->find(id)->started_ms; };
  EXPECT_LE(started(modest.job.id), started(greedy[1]));
  EXPECT_GE(started(modest.job.id), started(greedy[0]));
}

TEST_F(JobServiceTest, AWaitingJobIsCancelledAtOnce) {
  occupy_worker();
  const std::string id = service_.submit().job.id;
  EXPECT_EQ(service_.jobs->cancel(id)->state, JobState::kCancelled);
  service_.engine.open_gate();
  EXPECT_EQ(service_.jobs->find(id)->state, JobState::kCancelled);
}

TEST_F(JobServiceTest, ARunningJobIsCancelledSoon) {
  const std::string id = occupy_worker();
  EXPECT_TRUE(eventually(
      [&] { return service_.jobs->progress(*service_.jobs->find(id))->elements == 42U; }));
  service_.jobs->cancel(id);
  EXPECT_TRUE(service_.reaches(id, JobState::kCancelled));
}

TEST_F(JobServiceTest, DeletingARunningJobStopsItAndRemovesItsFiles) {
  const std::string id = occupy_worker();
  EXPECT_TRUE(service_.jobs->erase(id));
  EXPECT_FALSE(service_.jobs->find(id));
  const auto folder = service_.jobs->files().model(id).parent_path();
  EXPECT_TRUE(eventually([&] { return !std::filesystem::exists(folder); }));
  EXPECT_FALSE(service_.jobs->erase(id));
}

TEST_F(JobServiceTest, ErrorsOfTheEngineBecomeProblemDocuments) {
  service_.engine.fail_with(
      {ErrorCode::kSelfIntersection, "segments 3 and 7 cross", {3, 7}, "/segments/3"});
  const std::string id = service_.submit().job.id;
  ASSERT_TRUE(service_.reaches(id, JobState::kFailed));
  const auto job = service_.jobs->find(id);
  EXPECT_EQ(job->error_code, "self_intersection");
  const auto problem = nlohmann::json::parse(job->error_json);
  EXPECT_EQ(problem["status"], 422);
  EXPECT_EQ(problem["errors"][0]["pointer"], "/model/segments/3");
}

TEST_F(JobServiceTest, TheModelOfAnInternalErrorIsKeptUntilTheJobIsDeleted) {
  service_.engine.fail_with({ErrorCode::kInternal, "mesh check 'facets': facet 3", {}, {}});
  const std::string id = service_.submit().job.id;
  ASSERT_TRUE(service_.reaches(id, JobState::kFailed));
  const auto kept = service_.jobs->files().faults() / id;
  EXPECT_EQ(symcell::test::read_file(kept / "model"), square_json());
  const auto request = nlohmann::json::parse(symcell::test::read_file(kept / "request.json"));
  EXPECT_EQ(request["error"]["detail"], "mesh check 'facets': facet 3");
  EXPECT_TRUE(request["options"].is_object());
  EXPECT_TRUE(service_.jobs->erase(id));
  EXPECT_FALSE(std::filesystem::exists(kept));
}

TEST_F(JobServiceTest, ErrorsOfTheModelLeaveNoCase) {
  service_.engine.fail_with({ErrorCode::kSelfIntersection, "segments 3 and 7 cross", {3, 7}, {}});
  const std::string id = service_.submit().job.id;
  ASSERT_TRUE(service_.reaches(id, JobState::kFailed));
  EXPECT_FALSE(std::filesystem::exists(service_.jobs->files().faults() / id));
}

// The worker still holds the job and meets the error afterwards.
TEST_F(JobServiceTest, AJobDeletedWhileItRunsLeavesNoCase) {
  service_.engine.ignore_cancel();
  service_.engine.fail_with({ErrorCode::kInternal, "too late", {}, {}});
  const std::string id = occupy_worker();
  EXPECT_TRUE(service_.jobs->erase(id));
  service_.engine.open_gate();
  const auto folder = service_.jobs->files().model(id).parent_path();
  EXPECT_TRUE(eventually([&] { return !std::filesystem::exists(folder); }));
  EXPECT_TRUE(
      eventually([&] { return !std::filesystem::exists(service_.jobs->files().faults() / id); }));
}

TEST_F(JobServiceTest, AnEngineThatThrowsFailsItsJobOnly) {
  service_.engine.throw_from_now_on();
  const std::string id = service_.submit().job.id;
  ASSERT_TRUE(service_.reaches(id, JobState::kFailed));
  EXPECT_EQ(service_.jobs->find(id)->error_code, "internal");
  const std::string next = service_.submit().job.id;
  EXPECT_TRUE(service_.reaches(next, JobState::kFailed));
}

TEST_F(JobServiceTest, TheSameKeyMeansTheSameJobHoweverFullTheQueueIs) {
  occupy_worker();
  const auto first = service_.submit("key");
  EXPECT_EQ(service_.submit().status, SubmitStatus::kAccepted);
  const auto again = service_.submit("key");
  EXPECT_EQ(again.status, SubmitStatus::kReplayed);
  EXPECT_EQ(again.job.id, first.job.id);
  EXPECT_EQ(service_.submit("key", 0.5).status, SubmitStatus::kKeyConflict);
  EXPECT_EQ(service_.submit("another").status, SubmitStatus::kQueueFull);
}

TEST_F(JobServiceTest, TheServersLimitsCapTheOptions) {
  MeshOptions options;
  options.time_limit_s = 1e6;
  options.max_elements = 7;
  service_.limits.time_limit_s = 60;
  service_.limits.max_elements = 1000;
  ASSERT_TRUE(service_.close());
  service_.open();
  EXPECT_EQ(service_.jobs->capped(options).time_limit_s, 60);
  EXPECT_EQ(service_.jobs->capped(options).max_elements, 7U);
}

TEST_F(JobServiceTest, AStoppingServiceRefusesJobs) {
  service_.jobs->begin_stop();
  EXPECT_EQ(service_.submit().status, SubmitStatus::kStopping);
}

TEST_F(JobServiceTest, ADirectoryServesOneServerOnly) {
  EXPECT_THROW(JobService(service_.folder.path(), service_.limits, service_.engine,
                          service_.metrics, service_.logger),
               std::runtime_error);
}

}  // namespace
}  // namespace symcell::server::test
