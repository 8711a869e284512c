// A job service with a stub engine, without HTTP.
#pragma once

#include <cstdint>
#include <fstream>
#include <limits>
#include <memory>

#include "server/base/files.hpp"
#include "server/jobs/job_service.hpp"
#include "tests/support/test_files.hpp"
#include "tests/unit/server/http_fixture.hpp"
#include "tests/unit/server/stub_engine.hpp"

namespace symcell::server::test {

class ServiceUnderTest {
 public:
  ServiceUnderTest() {
    limits.workers = 1;
    limits.queue_limit = 2;
    open();
  }

  void open() {
    jobs = std::make_unique<JobService>(folder.path(), limits, engine, metrics, logger);
    jobs->start();
  }
  [[nodiscard]] bool close() {
    const bool joined = jobs->finish_stop(std::chrono::milliseconds(0));
    jobs.reset();
    return joined;
  }

  // As if all files had been synchronised: what is lost from now on stays lost.
  void forget_copies() const {
    jobs->store().forget_copies(std::numeric_limits<std::int64_t>::max());
  }

  SubmitOutcome submit(const std::string& key = "",
                       double max_area = kInfinity,
                       const std::string& client = "") {
    const auto arrived = jobs->files().incoming();
    symcell::test::write_file(arrived, square_json());
    Submission submission;
    submission.model = arrived;
    submission.options.max_area = max_area;
    submission.idempotency_key = key;
    submission.client = client;
    return jobs->submit(submission);
  }

  [[nodiscard]] bool reaches(const std::string& id, JobState state) const {
    return eventually([&] {
      const auto job = jobs->find(id);
      return job && job->state == state;
    });
  }

  symcell::test::TemporaryFolder folder;
  StubEngine engine;
  Metrics metrics;
  Logger logger{LogLevel::kOff, LogFormat::kText};
  JobLimits limits;
  std::unique_ptr<JobService> jobs;
};

}  // namespace symcell::server::test
