// Jobs over HTTP: submit, look up, list, wait, cancel, delete.
#include "tests/unit/server/http_fixture.hpp"

namespace symcell::server::test {
namespace {

class JobsHttpTest : public HttpTest {};

TEST_F(JobsHttpTest, AJobIsAcceptedRunsAndTellsItsResult) {
  const auto answer = client().Post("/v1/jobs", job_body("{\"min_angle\":25}"), "application/json");
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->status, 202);
  const auto document = nlohmann::json::parse(answer->body);
  const std::string id = document["id"];
  EXPECT_EQ(answer->get_header_value("Location"), "/v1/jobs/" + id);
  EXPECT_EQ(document["options"]["min_angle"], 25);
  ASSERT_TRUE(reaches(id, "succeeded"));
  const auto done = job(id);
  EXPECT_EQ(done["progress"]["fraction"], 1);
  EXPECT_EQ(done["progress"]["phase"], "done");
  EXPECT_EQ(done["statistics"]["cell"]["elements"], 12);
  EXPECT_TRUE(done["finished_at"].is_string());
  EXPECT_EQ(done["links"]["cell"], "/v1/jobs/" + id + "/cell");
}

TEST_F(JobsHttpTest, PreferWaitAnswersWithTheFinishedJob) {
  const auto answer =
      client().Post("/v1/jobs", {{"Prefer", "wait=30"}}, job_body(), "application/json");
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 201);
  EXPECT_EQ(answer->get_header_value("Preference-Applied"), "wait=30");
  EXPECT_EQ(nlohmann::json::parse(answer->body)["state"], "succeeded");
}

TEST_F(JobsHttpTest, PreferWaitGivesUpInTime) {
  engine_.close_gate();
  const auto answer =
      client().Post("/v1/jobs", {{"Prefer", "wait=0"}}, job_body(), "application/json");
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 202);
}

TEST_F(JobsHttpTest, ARunningJobShowsItsProgress) {
  engine_.close_gate();
  const std::string id = submit()["id"];
  ASSERT_TRUE(reaches(id, "running"));
  ASSERT_TRUE(eventually([&] { return job(id)["progress"]["elements"] == 42; }));
  EXPECT_EQ(job(id)["progress"]["phase"], "refine");
  EXPECT_EQ(job(id)["progress"]["fraction"], 0.5);
}

TEST_F(JobsHttpTest, AFinishedJobCanBeRepeated) {
  const std::string id = submit("{\"fold\":2}")["id"];
  ASSERT_TRUE(reaches(id, "succeeded"));
  EXPECT_EQ(job(id)["links"]["rerun"], "/v1/jobs/" + id + "/rerun");
  const httplib::Headers headers{{"Idempotency-Key", "again"}, {"Prefer", "wait=30"}};
  const auto again = client().Post("/v1/jobs/" + id + "/rerun", headers, "", "");
  ASSERT_TRUE(again);
  ASSERT_EQ(again->status, 201) << again->body;
  const auto document = nlohmann::json::parse(again->body);
  EXPECT_NE(document["id"], id);
  EXPECT_EQ(document["state"], "succeeded");
  EXPECT_EQ(document["options"], job(id)["options"]);
  const auto replayed = client().Post("/v1/jobs/" + id + "/rerun", headers, "", "");
  EXPECT_EQ(nlohmann::json::parse(replayed->body)["id"], document["id"]);
  // Each has a model of its own.
  EXPECT_EQ(client().Delete("/v1/jobs/" + id)->status, 204);
  EXPECT_EQ(client().Get("/v1/jobs/" + std::string(document["id"]) + "/model")->body,
            square_json());
  EXPECT_EQ(client().Post("/v1/jobs/" + id + "/rerun")->status, 404);
}

TEST_F(JobsHttpTest, AJobIsRunAgainWithNoOptionsButItsOwn) {
  const std::string id = submit("{\"fold\":2}")["id"];
  ASSERT_TRUE(reaches(id, "succeeded"));
  const std::string path = "/v1/jobs/" + id + "/rerun";
  for (const char* query : {"?max_area=1", "?zz=1", "?options[fold]=3"}) {
    problem_of(client().Post(path + query, "", ""), 400);
  }
  for (const char* body : {"{\"options\":{\"fold\":3}}", "{bad", " "}) {
    problem_of(client().Post(path, body, "application/json"), 400);
  }
  // Without a length nobody knows that it is empty; the parts of a form have a reader of their own.
  for (const char* type : {"application/json", "multipart/form-data; boundary=x"}) {
    const auto nothing = [](std::size_t, httplib::DataSink& sink) {
      sink.done();
      return true;
    };
    problem_of(client().Post(path, nothing, type), 400);
  }
  EXPECT_EQ(client().Post(path, "", "application/json")->status, 202);
}

TEST_F(JobsHttpTest, AnOptionGivenTwiceIsRefused) {
  const auto refused = client().Post("/v1/jobs", job_body("{\"min_angle\":30,\"min_angle\":20}"),
                                     "application/json");
  const auto problem = problem_of(refused, 400);
  EXPECT_EQ(problem["code"], "bad_option");
  EXPECT_NE(std::string(problem["detail"]).find("twice"), std::string::npos);
}

TEST_F(JobsHttpTest, AByteOrderMarkBeforeJsonMeansNothing) {
  const std::string mark = "\xef\xbb\xbf";
  for (const std::string& body : {job_body(), square_json()}) {
    EXPECT_EQ(client().Post("/v1/jobs", mark + body, "application/json")->status, 202);
  }
}

TEST_F(JobsHttpTest, OnlyWhatHasEndedAndHasItsModelCanBeRepeated) {
  engine_.close_gate();
  const std::string id = submit()["id"];
  EXPECT_EQ(problem_of(client().Post("/v1/jobs/" + id + "/rerun"), 409)["code"], "not_finished");
  ASSERT_TRUE(reaches(id, "running"));
  client().Post("/v1/jobs/" + id + "/cancel");
  ASSERT_TRUE(reaches(id, "cancelled"));
  service_->jobs().store().forget_model(id);
  EXPECT_EQ(problem_of(client().Post("/v1/jobs/" + id + "/rerun"), 410)["code"], "model_gone");
  EXPECT_EQ(problem_of(client().Get("/v1/jobs/" + id + "/model"), 410)["code"], "model_gone");
  EXPECT_FALSE(job(id)["links"].contains("rerun"));
  EXPECT_FALSE(job(id)["links"].contains("model"));
}

TEST_F(JobsHttpTest, WebhooksAreRefusedWhereNoneAreSent) {
  const auto refused = client().Post("/v1/jobs", {{"Webhook-Url", "https://hooks.example/"}},
                                     job_body(), "application/json");
  EXPECT_EQ(problem_of(refused, 422)["code"], "webhook_refused");
}

TEST_F(JobsHttpTest, TheKeyMakesRequestsOne) {
  const httplib::Headers key{{"Idempotency-Key", "order-7"}};
  const auto first = client().Post("/v1/jobs", key, job_body(), "application/json");
  const auto second = client().Post("/v1/jobs", key, job_body(), "application/json");
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->get_header_value("Location"), second->get_header_value("Location"));
  EXPECT_EQ(second->get_header_value("Idempotency-Replayed"), "true");
  const auto other = client().Post("/v1/jobs", key, job_body("{\"fold\":2}"), "application/json");
  EXPECT_EQ(problem_of(other, 422)["code"], "idempotency_conflict");
  const httplib::Headers long_key{{"Idempotency-Key", std::string(300, 'k')}};
  EXPECT_EQ(
      problem_of(client().Post("/v1/jobs", long_key, job_body(), "application/json"), 400)["code"],
      "bad_request");
}

TEST_F(JobsHttpTest, AFullQueueSaysWhenToComeAgain) {
  engine_.close_gate();
  ASSERT_TRUE(reaches(submit()["id"], "running"));
  for (int i = 0; i < 3; ++i) submit();
  const auto refused = client().Post("/v1/jobs", job_body(), "application/json");
  EXPECT_EQ(problem_of(refused, 429)["code"], "queue_full");
  EXPECT_FALSE(refused->get_header_value("Retry-After").empty());
}

TEST_F(JobsHttpTest, AFailedJobCarriesItsProblem) {
  engine_.fail_with({ErrorCode::kNotSymmetric, "not symmetric at fold 6: error 0.2", {5}, ""});
  const std::string id = submit()["id"];
  ASSERT_TRUE(reaches(id, "failed"));
  const auto document = job(id);
  EXPECT_EQ(document["error"]["status"], 422);
  EXPECT_EQ(document["error"]["code"], "not_symmetric");
  EXPECT_EQ(document["error"]["instance"], "/v1/jobs/" + id);
}

TEST_F(JobsHttpTest, ListsAreNewestFirstInPages) {
  std::vector<std::string> ids;
  for (int i = 0; i < 3; ++i) {
    ids.push_back(submit()["id"]);
    ASSERT_TRUE(reaches(ids.back(), "succeeded"));
  }
  const auto first = client().Get("/v1/jobs?limit=2");
  ASSERT_TRUE(first);
  const auto page = nlohmann::json::parse(first->body);
  ASSERT_EQ(page["jobs"].size(), 2U);
  EXPECT_EQ(page["jobs"][0]["id"], ids[2]);
  EXPECT_FALSE(page["jobs"][0].contains("statistics"));
  const std::string cursor = page["next_cursor"];
  const auto second = client().Get("/v1/jobs?limit=2&state=succeeded&cursor=" + cursor);
  const auto rest = nlohmann::json::parse(second->body);
  ASSERT_EQ(rest["jobs"].size(), 1U);
  EXPECT_EQ(rest["jobs"][0]["id"], ids[0]);
  EXPECT_TRUE(rest["next_cursor"].is_null());
  const auto none = client().Get("/v1/jobs?state=failed");
  EXPECT_TRUE(nlohmann::json::parse(none->body)["jobs"].empty());
}

TEST_F(JobsHttpTest, BadFiltersAreRefused) {
  for (const char* query : {"state=done", "limit=0", "limit=x", "limit=501", "cursor=-1"}) {
    problem_of(client().Get(std::string("/v1/jobs?") + query), 400);
  }
}

TEST_F(JobsHttpTest, CancelStopsARunningJobAndForgivesRepetition) {
  engine_.close_gate();
  const std::string id = submit()["id"];
  ASSERT_TRUE(reaches(id, "running"));
  const auto answer = client().Post("/v1/jobs/" + id + "/cancel");
  ASSERT_TRUE(answer);
  EXPECT_TRUE(answer->status == 202 || answer->status == 200) << answer->status;
  EXPECT_TRUE(reaches(id, "cancelled"));
  EXPECT_EQ(client().Post("/v1/jobs/" + id + "/cancel")->status, 200);
}

TEST_F(JobsHttpTest, AWaitingJobIsCancelledAtOnce) {
  engine_.close_gate();
  ASSERT_TRUE(reaches(submit()["id"], "running"));
  const std::string id = submit()["id"];
  const auto answer = client().Post("/v1/jobs/" + id + "/cancel");
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 200);
  EXPECT_EQ(nlohmann::json::parse(answer->body)["state"], "cancelled");
}

TEST_F(JobsHttpTest, AFinishedJobCannotBeCancelled) {
  const std::string id = submit()["id"];
  ASSERT_TRUE(reaches(id, "succeeded"));
  EXPECT_EQ(problem_of(client().Post("/v1/jobs/" + id + "/cancel"), 409)["code"],
            "already_finished");
}

TEST_F(JobsHttpTest, DeleteForgetsTheJob) {
  const std::string id = submit()["id"];
  ASSERT_TRUE(reaches(id, "succeeded"));
  EXPECT_EQ(client().Delete("/v1/jobs/" + id)->status, 204);
  problem_of(client().Get("/v1/jobs/" + id), 404);
  problem_of(client().Delete("/v1/jobs/" + id), 404);
}

TEST_F(JobsHttpTest, UnknownJobsAreNotFoundEverywhere) {
  for (const char* tail : {"", "/cell", "/full", "/statistics", "/model", "/events"}) {
    problem_of(client().Get(std::string("/v1/jobs/0123456789abcdefghjkmnpqrs") + tail), 404);
    problem_of(client().Get(std::string("/v1/jobs/..%2f..%2fetc") + tail), 404);
  }
  problem_of(client().Post("/v1/jobs/nothing/cancel"), 404);
}

TEST_F(JobsHttpTest, JobsSurviveARestart) {
  const std::string finished = submit()["id"];
  ASSERT_TRUE(reaches(finished, "succeeded"));
  engine_.close_gate();
  const std::string running = submit()["id"];
  ASSERT_TRUE(reaches(running, "running"));
  stop();
  engine_.open_gate();
  start();
  EXPECT_EQ(job(finished)["state"], "succeeded");
  EXPECT_TRUE(reaches(running, "succeeded"));
}

}  // namespace
}  // namespace symcell::server::test
