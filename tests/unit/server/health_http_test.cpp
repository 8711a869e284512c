// Probes, metrics, pages, draining.
#include <future>

#include "api/problem.hpp"
#include "server/http/problem_response.hpp"
#include "tests/unit/server/http_fixture.hpp"

namespace symcell::server::test {
namespace {

class HealthHttpTest : public HttpTest {};

TEST_F(HealthHttpTest, ProbesAnswer) {
  EXPECT_EQ(client().Get("/healthz")->body, "ok\n");
  EXPECT_EQ(client().Get("/readyz")->body, "ready\n");
}

TEST_F(HealthHttpTest, AnEngineThatCanRunNothingIsNotReady) {
  engine_.break_down(true);
  EXPECT_EQ(problem_of(client().Get("/readyz"), 503)["code"], "overloaded");
  EXPECT_EQ(client().Get("/healthz")->status, 200);
  engine_.break_down(false);
  EXPECT_EQ(client().Get("/readyz")->status, 200);
  EXPECT_NE(client().Get("/metrics")->body.find("stub_engine 1"), std::string::npos);
}

TEST_F(HealthHttpTest, MetricsCountWhatHappened) {
  ASSERT_TRUE(reaches(submit()["id"], "succeeded"));
  engine_.fail_with({ErrorCode::kNotSymmetric, "no", {}, ""});
  ASSERT_TRUE(reaches(submit()["id"], "failed"));
  problem_of(client().Post("/v1/jobs", "{", "application/json"), 400);
  problem_of(client().Get("/nothing"), 404);
  for (const char* line :
       {"symcell_jobs{state=\"succeeded\"} 1", "symcell_jobs{state=\"failed\"} 1",
        "symcell_job_errors_total{code=\"not_symmetric\"} 1",
        "symcell_request_errors_total{code=\"json_syntax\"} 1",
        "symcell_http_requests_total{method=\"POST\",route=\"/v1/jobs\",status=\"202\"} 2",
        "symcell_http_requests_total{method=\"GET\",route=\"none\",status=\"404\"} 1",
        "symcell_job_duration_seconds_count{state=\"succeeded\"} 1", "symcell_queue_length 0",
        "symcell_queue_limit 3"}) {
    // Requests are counted once their answer is out, jobs once their row is written.
    EXPECT_TRUE(eventually([&] {
      return client().Get("/metrics")->body.find(line) != std::string::npos;
    })) << line
        << "\n"
        << client().Get("/metrics")->body;
  }
}

TEST_F(HealthHttpTest, PagesAndDescriptionAreServed) {
  for (const char* path : {"/", "/docs", "/docs/plain"}) {
    const auto page = client().Get(path);
    ASSERT_TRUE(page);
    EXPECT_EQ(page->status, 200);
    EXPECT_EQ(page->get_header_value("Content-Type"), "text/html; charset=utf-8");
    EXPECT_NE(page->body.find("Symcell"), std::string::npos);
    // Pages that run scripts name whose, and all have one policy.
    EXPECT_EQ(page->get_header_value_count("Content-Security-Policy"), 1U);
    const std::string policy = page->get_header_value("Content-Security-Policy");
    EXPECT_TRUE(policy.starts_with("default-src 'none'"));
    EXPECT_EQ(policy.find("script-src 'unsafe"), std::string::npos);
  }
  EXPECT_NE(client().Get("/docs/plain")->body.find("curl"), std::string::npos);
  const auto description = client().Get("/openapi.yaml");
  ASSERT_TRUE(description);
  EXPECT_EQ(description->body,
            symcell::test::read_file(std::string(SYMCELL_SOURCE_DIR) + "/openapi.yaml"));
}

TEST_F(HealthHttpTest, EveryProblemTypeHasAPageAndStandsInTheDescription) {
  const std::string description = client().Get("/openapi.yaml")->body;
  std::vector<std::string> names;
  for (const ProblemRow& row : problem_table()) names.emplace_back(error_code_name(row.code));
  for (const ServiceProblemRow& row : service_problem_table()) names.emplace_back(row.name);
  for (const std::string& name : names) {
    EXPECT_EQ(client().Get("/problems/" + name)->status, 200) << name;
    EXPECT_NE(description.find("- " + name + "\n"), std::string::npos) << name;
  }
  problem_of(client().Get("/problems/none_such"), 404);
}

class DrainingHttpTest : public HttpTest {
 protected:
  void configure(ServiceSettings& settings) override {
    settings.grace = std::chrono::milliseconds(10'000);
  }
};

TEST_F(DrainingHttpTest, AStoppingServerFinishesWhatRunsAndTakesNothingNew) {
  engine_.close_gate();
  const std::string id = submit()["id"];
  ASSERT_TRUE(reaches(id, "running"));
  auto stopped = std::async(std::launch::async, [this] { return service_->stop(); });
  ASSERT_TRUE(eventually([&] {
    const auto ready = client().Get("/readyz");
    return ready && ready->status == 503;
  }));
  const auto refused = client().Post("/v1/jobs", job_body(), "application/json");
  EXPECT_EQ(problem_of(refused, 503)["code"], "stopping");
  EXPECT_FALSE(refused->get_header_value("Retry-After").empty());
  EXPECT_EQ(client().Get("/healthz")->status, 200);
  EXPECT_EQ(job(id)["state"], "running");
  engine_.open_gate();
  EXPECT_TRUE(stopped.get());
  EXPECT_EQ(service_->jobs().find(id)->state, JobState::kSucceeded);
  service_.reset();
}

class StubbornHttpTest : public HttpTest {};

TEST_F(StubbornHttpTest, AnEngineThatIgnoresItsCancellationIsReported) {
  engine_.ignore_cancel();
  engine_.close_gate();
  ASSERT_TRUE(reaches(submit()["id"], "running"));
  EXPECT_FALSE(service_->stop());
  engine_.open_gate();
  service_.reset();
}

}  // namespace
}  // namespace symcell::server::test
