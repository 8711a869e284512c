#include "core/solid/initial/tetgen.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <thread>

#include "core/base/child_process.hpp"

namespace symcell::solid {
namespace {

// Volatile, so that no loop or write is taken away.
volatile int sink = 0;

void loop() {
  while (true) sink = sink + 1;
}

TriangleComplex one_tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}},
          {}};
}

Result<ChildResult> child(const std::function<bool(ChildOutput&)>& body,
                          const ChildLimits& limits = {}) {
  ExecutionContext context;
  return run_in_child(body, limits, context);
}

TEST(ChildProcessTest, BytesComeBack) {
  const std::vector<double> numbers(100'000, 1.5);
  const auto result = child([&](ChildOutput& out) {
    out.write_array(numbers);
    return true;
  });
  ASSERT_TRUE(result);
  EXPECT_EQ(result->failure, ChildFailure::kNone);
  EXPECT_EQ(result->bytes.size(), numbers.size() * sizeof(double));
}

TEST(ChildProcessTest, EveryBadEndIsAValue) {
  EXPECT_EQ(child([](ChildOutput&) { return false; })->failure, ChildFailure::kRefused);
  EXPECT_EQ(child([](ChildOutput&) -> bool { throw 3; })->failure, ChildFailure::kRefused);
  EXPECT_EQ(child([](ChildOutput&) -> bool { std::abort(); })->failure, ChildFailure::kCrashed);
  EXPECT_EQ(child([](ChildOutput&) -> bool { std::_Exit(0); })->failure, ChildFailure::kCrashed);
}

TEST(ChildProcessTest, LoopsEndAtTheCpuLimit) {
  const auto result = child(
      [](ChildOutput&) {
        loop();
        return true;
      },
      {.cpu_seconds = 1});
  ASSERT_TRUE(result);
  EXPECT_EQ(result->failure, ChildFailure::kCpuLimit);
  EXPECT_TRUE(result->bytes.empty());
}

TEST(ChildProcessTest, LoopsEndWithTheContext) {
  ExecutionContext context;
  context.set_time_limit(0.05);
  const auto late = run_in_child(
      [](ChildOutput&) {
        loop();
        return true;
      },
      {}, context);
  ASSERT_FALSE(late);
  EXPECT_EQ(late.error().code, ErrorCode::kTimeLimit);
}

TEST(ChildProcessTest, CancelFromAnotherThreadEndsIt) {
  ExecutionContext context;
  const std::jthread other([&] { context.cancel(); });
  const auto result = run_in_child(
      [](ChildOutput&) {
        loop();
        return true;
      },
      {}, context);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::kCancelled);
}

TEST(TetgenBackendTest, OneTetrahedron) {
  ExecutionContext context;
  const auto mesh = run_tetgen(one_tetrahedron(), {}, context);
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->points, one_tetrahedron().points);
  EXPECT_EQ(mesh->tets.size(), 1U);
}

TEST(TetgenBackendTest, TheOrderOfInsertionDoesNotShowInTheResult) {
  ExecutionContext context;
  TetgenOptions options;
  options.order = 5;
  TriangleComplex complex = one_tetrahedron();
  complex.points.push_back({0.2, 0.2, 0.2});
  const auto mesh = run_tetgen(complex, options, context);
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->points, complex.points);
  EXPECT_EQ(mesh->tets.size(), 4U);
  for (const auto& t : mesh->tets) EXPECT_EQ(std::count(t.begin(), t.end(), 4), 1);
}

TEST(TetgenBackendTest, CrashesAreErrors) {
  for (const auto& crash : std::vector<std::function<void()>>{
           [] { std::abort(); }, [] { std::exit(0); }, [] { throw 4; }, [] { throw "text"; }}) {
    ExecutionContext context;
    TetgenOptions options;
    options.before = crash;
    const auto mesh = run_tetgen(one_tetrahedron(), options, context);
    ASSERT_FALSE(mesh);
    EXPECT_EQ(mesh.error().code, ErrorCode::kTetrahedralizationFailed);
  }
}

TEST(TetgenBackendTest, FacetsThatCrossAreRefused) {
  TriangleComplex complex = one_tetrahedron();
  complex.points.insert(complex.points.end(), {{-1, 0.2, 0.3}, {2, 0.2, 0.1}, {0.2, 0.3, 2}});
  complex.triangles.push_back({4, 5, 6});
  ExecutionContext context;
  EXPECT_FALSE(run_tetgen(complex, {}, context));
}

}  // namespace
}  // namespace symcell::solid
