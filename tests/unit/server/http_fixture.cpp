#include "tests/unit/server/http_fixture.hpp"

#include <thread>

namespace symcell::server::test {

bool eventually(const std::function<bool()>& holds) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (std::chrono::steady_clock::now() < deadline) {
    if (holds()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return holds();
}

std::string square_json() {
  return R"({"type":"pslg","vertices":[[0,0],[1,0],[1,1],[0,1]],)"
         R"("segments":[[0,1],[1,2],[2,3],[3,0]]})";
}

std::string job_body(const std::string& options) {
  return "{\"model\":" + square_json() + ",\"options\":" + options + "}";
}

void HttpTest::start() {
  ServiceSettings settings;
  settings.http.port = 0;
  settings.http.threads = 8;
  settings.http.patient_threads = 8;
  settings.http.max_waiting = 8;
  settings.http.allowed_hosts = {"x"};  // what requests made by hand call the server
  settings.http.max_body_bytes = 1UL << 20U;
  settings.jobs.workers = 1;
  settings.jobs.queue_limit = 3;
  settings.data_directory = folder_.path();
  settings.grace = std::chrono::milliseconds(0);
  configure(settings);
  service_ = std::make_unique<Service>(settings, engine_, logger_);
  port_ = service_->start();
}

void HttpTest::stop() {
  ASSERT_TRUE(service_->stop());
  service_.reset();
}

void HttpTest::TearDown() {
  if (service_) stop();
}

httplib::Client HttpTest::client() const {
  httplib::Client client("127.0.0.1", port_);
  client.set_read_timeout(std::chrono::seconds(20));
  return client;
}

nlohmann::json HttpTest::submit(const std::string& options) {
  const auto answer = client().Post("/v1/jobs", job_body(options), "application/json");
  EXPECT_TRUE(answer);
  if (!answer) return {};
  EXPECT_EQ(answer->status, 202) << answer->body;
  return nlohmann::json::parse(answer->body);
}

nlohmann::json HttpTest::job(const std::string& id) const {
  const auto answer = client().Get("/v1/jobs/" + id);
  if (!answer || answer->status != 200) return nullptr;
  return nlohmann::json::parse(answer->body);
}

bool HttpTest::reaches(const std::string& id, const std::string& state) const {
  return eventually([&] {
    const auto document = job(id);
    return document.is_object() && document["state"] == state;
  });
}

nlohmann::json problem_of(const httplib::Result& answer, int status) {
  EXPECT_TRUE(answer);
  if (!answer) return {};
  EXPECT_EQ(answer->status, status) << answer->body;
  EXPECT_EQ(answer->get_header_value("Content-Type"), "application/problem+json");
  const auto document = nlohmann::json::parse(answer->body);
  for (const char* member : {"type", "title", "status", "detail", "instance", "code"}) {
    EXPECT_TRUE(document.contains(member)) << member << " is missing in " << answer->body;
  }
  EXPECT_EQ(document["status"], status);
  return document;
}

}  // namespace symcell::server::test
