// A running service on a free port with a stub engine, and a client.
#pragma once

#include <gtest/gtest.h>
#include <httplib.h>

#include <chrono>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "server/http/service.hpp"
#include "tests/support/test_files.hpp"
#include "tests/unit/server/stub_engine.hpp"

namespace symcell::server::test {

// Looks every few milliseconds until `holds` or ten seconds have passed.
[[nodiscard]] bool eventually(const std::function<bool()>& holds);

// A model every reader takes.
[[nodiscard]] std::string square_json();
[[nodiscard]] std::string job_body(const std::string& options = "{}");

class HttpTest : public ::testing::Test {
 protected:
  void SetUp() override { start(); }
  void TearDown() override;

  // Settings may be changed before start() by overriding this.
  virtual void configure(ServiceSettings& settings) { static_cast<void>(settings); }
  void start();
  // As a restart does: the data stay.
  void stop();

  [[nodiscard]] httplib::Client client() const;
  [[nodiscard]] int port() const { return port_; }
  // Posts a job as JSON; fails the test unless accepted.  Returns the job document.
  nlohmann::json submit(const std::string& options = "{}");
  [[nodiscard]] nlohmann::json job(const std::string& id) const;
  [[nodiscard]] bool reaches(const std::string& id, const std::string& state) const;

  symcell::test::TemporaryFolder folder_;
  StubEngine engine_;
  Logger logger_{LogLevel::kOff, LogFormat::kText};
  std::unique_ptr<Service> service_;

 private:
  int port_ = 0;
};

// The problem document of an answer; fails the test if it is none.
nlohmann::json problem_of(const httplib::Result& answer, int status);

}  // namespace symcell::server::test
