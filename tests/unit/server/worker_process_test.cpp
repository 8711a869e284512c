// What the end of a process means, and real worker processes under the engine, without HTTP.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <future>
#include <thread>
#include <vector>

#include "api/formats/cell_archive.hpp"
#include "server/base/files.hpp"
#include "server/worker/process_end.hpp"
#include "server/worker/process_limits.hpp"
#include "server/worker/worker_engine.hpp"
#include "tests/support/test_files.hpp"
#include "tests/unit/server/http_fixture.hpp"

namespace symcell::server::test {
namespace {

TEST(ProcessEnd, IsTakenForWhatItIs) {
  constexpr WorkerLimits kLimits{1000, 5};
  const auto kind = [&](const ProcessEnd& end) { return kind_of(end, kLimits); };
  EXPECT_EQ(kind({.signal = SIGSEGV}), EndKind::kCrash);
  EXPECT_EQ(kind({.signal = SIGABRT, .peak_bytes = 100}), EndKind::kCrash);
  EXPECT_EQ(kind({.signal = SIGABRT, .peak_bytes = 900}), EndKind::kMemoryLimit);
  EXPECT_EQ(kind_of({.signal = SIGABRT, .peak_bytes = 900}, {}), EndKind::kCrash);
  EXPECT_EQ(kind({.exit_status = kMemoryExitStatus}), EndKind::kMemoryLimit);
  EXPECT_EQ(kind({.exit_status = 0}), EndKind::kCrash);
  EXPECT_EQ(kind({.signal = SIGXCPU}), EndKind::kTimeLimit);
  EXPECT_EQ(kind({.signal = SIGKILL}), EndKind::kOutside);
  EXPECT_EQ(kind({.signal = SIGKILL, .killed = KillReason::kCancel}), EndKind::kCancelled);
  EXPECT_EQ(kind({.signal = SIGKILL, .killed = KillReason::kTimeLimit}), EndKind::kTimeLimit);
}

TEST(ProcessEnd, IsToldWithPlaceAndMend) {
  const Progress progress{Phase::kRefine, 0.5, 1234, 0};
  const Error crash = error_of({.signal = SIGSEGV}, {}, kInfinity, progress);
  EXPECT_EQ(crash.code, ErrorCode::kWorkerCrashed);
  for (const char* part : {"SIGSEGV", "refine", "1234"}) {
    EXPECT_NE(crash.message.find(part), std::string::npos) << crash.message;
  }
  const Error memory =
      error_of({.exit_status = kMemoryExitStatus}, {512UL << 20U, 0}, kInfinity, progress);
  EXPECT_EQ(memory.code, ErrorCode::kMemoryLimit);
  EXPECT_NE(memory.message.find("512 MiB"), std::string::npos) << memory.message;
}

class WorkerEngineTest : public ::testing::Test {
 protected:
  static WorkerSettings settings() {
    WorkerSettings result;
    result.pool.program = SYMCELL_PROGRAM;
    return result;
  }

  EngineJob job(const std::string& name, double max_area = 0.01) {
    EngineJob result;
    result.model = folder_ / (name + ".model");  // one each: a mapped file must not change
    symcell::test::write_file(result.model, square_json());
    result.cell = folder_ / (name + ".cell");
    result.statistics = folder_ / (name + ".json");
    result.options.max_area = max_area;
    return result;
  }

  symcell::test::TemporaryFolder folder_;
  Logger logger_{LogLevel::kOff, LogFormat::kText};
};

TEST_F(WorkerEngineTest, MeshesAndInspects) {
  WorkerEngine engine(settings(), logger_);
  ExecutionContext context;
  const EngineJob work = job("a");
  const auto done = engine.run(work, context);
  ASSERT_TRUE(done) << done.error().message;
  const auto cell = read_cell_archive(MappedFile(work.cell).bytes());
  ASSERT_TRUE(cell);
  EXPECT_EQ(cell->fold, 4);
  EXPECT_NE(symcell::test::read_file(work.statistics).find("\"fold\": 4"), std::string::npos);
  EXPECT_EQ(context.progress().phase, Phase::kDone);
  const auto inspection = engine.inspect(work.model, ModelFormat::kPslgJson, {}, context);
  ASSERT_TRUE(inspection) << inspection.error().message;
  EXPECT_NE(inspection->find("\"fold\": 4"), std::string::npos) << *inspection;
}

TEST_F(WorkerEngineTest, ReadsLargeModelsInAWorker) {
  WorkerEngine engine(settings(), logger_);
  ExecutionContext context;
  const auto model = folder_ / "large";
  const std::string blanks(std::size_t{9} << 20U, ' ');
  symcell::test::write_file(model, square_json() + blanks);
  const auto format = engine.recognise(model, std::nullopt, context);
  ASSERT_TRUE(format) << format.error().message;
  EXPECT_EQ(*format, ModelFormat::kPslgJson);
  symcell::test::write_file(model, blanks + "{\"type\": \"pslg\", \"vertices\": 7}");
  const auto refused = engine.recognise(model, ModelFormat::kPslgJson, context);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kWrongType);
  EXPECT_EQ(refused.error().pointer, "/vertices");
}

// The last report of progress and the end arrive together: the end must not wait for the next tick
// of 20 ms.  The shortest of many, for a loaded machine lengthens some.
TEST_F(WorkerEngineTest, LosesNoTickOnASmallJob) {
  WorkerEngine engine(settings(), logger_);
  auto shortest = std::chrono::nanoseconds::max();
  for (int i = 0; i < 20; ++i) {
    const EngineJob small = job("small" + std::to_string(i), 0.5);
    ExecutionContext context;
    const auto start = std::chrono::steady_clock::now();
    ASSERT_TRUE(engine.run(small, context));
    shortest =
        std::min<std::chrono::nanoseconds>(shortest, std::chrono::steady_clock::now() - start);
  }
  EXPECT_LT(shortest, std::chrono::milliseconds(20));
}

TEST_F(WorkerEngineTest, PassesErrorsOn) {
  WorkerEngine engine(settings(), logger_);
  ExecutionContext context;
  EngineJob work = job("a");
  work.options.fold = 5;
  const auto done = engine.run(work, context);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, ErrorCode::kNotSymmetric);
  work.model = folder_ / "none";
  EXPECT_EQ(engine.run(work, context).error().code, ErrorCode::kInternal);
}

TEST_F(WorkerEngineTest, GivesMoreRequestsThanWorkersTheirTurn) {
  WorkerEngine engine(settings(), logger_);
  std::vector<std::future<Result<void>>> runs;
  for (int i = 0; i < 6; ++i) {
    const EngineJob work = job(std::to_string(i));
    runs.push_back(std::async(std::launch::async, [&engine, work] {
      ExecutionContext context;
      return engine.run(work, context);
    }));
  }
  for (auto& run : runs) {
    const auto done = run.get();
    EXPECT_TRUE(done) << done.error().message;
  }
  Metrics metrics;
  engine.declare_metrics(metrics);
  engine.report_metrics(metrics);
  const std::string text = metrics.text();
  EXPECT_NE(text.find("symcell_worker_processes{state=\"busy\"} 0"), std::string::npos);
  EXPECT_NE(text.find("symcell_worker_processes{state=\"idle\"} 1"), std::string::npos) << text;
}

TEST_F(WorkerEngineTest, HearsACancel) {
  WorkerEngine engine(settings(), logger_);
  ExecutionContext context;
  auto run = std::async(std::launch::async, [&] { return engine.run(job("a", 1e-8), context); });
  ASSERT_TRUE(eventually([&] { return context.progress().elements > 100; }));
  context.cancel();
  ASSERT_EQ(run.wait_for(std::chrono::seconds(5)), std::future_status::ready);
  EXPECT_EQ(run.get().error().code, ErrorCode::kCancelled);
}

TEST_F(WorkerEngineTest, TellsThatNoWorkerCanBeStarted) {
  WorkerSettings wrong = settings();
  wrong.pool.program = folder_ / "no_such_program";
  WorkerEngine engine(wrong, logger_);
  ExecutionContext context;
  EXPECT_EQ(engine.run(job("a"), context).error().code, ErrorCode::kInternal);
  EXPECT_FALSE(engine.fault().empty());
  wrong.pool.program = "/bin/false";
  WorkerEngine other(wrong, logger_);
  EXPECT_EQ(other.run(job("b"), context).error().code, ErrorCode::kInternal);
}

}  // namespace
}  // namespace symcell::server::test
