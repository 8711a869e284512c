#include "api/problem.hpp"

#include <gtest/gtest.h>

#include <set>

namespace symcell {
namespace {

// Every number that has a name is a code: the switch in error_code_name lists them all.
std::vector<ErrorCode> all_codes() {
  std::vector<ErrorCode> codes;
  for (int number = 0; number < 1000; ++number) {
    const auto code = static_cast<ErrorCode>(number);
    if (error_code_name(code) != "internal" || code == ErrorCode::kInternal) codes.push_back(code);
  }
  return codes;
}

TEST(Problem, EveryCodeHasExactlyOneRow) {
  for (const ErrorCode code : all_codes()) {
    int rows = 0;
    for (const ProblemRow& row : problem_table()) rows += row.code == code ? 1 : 0;
    EXPECT_EQ(rows, 1) << error_code_name(code);
    EXPECT_EQ(problem_row(code).code, code);
  }
  EXPECT_EQ(all_codes().size(), problem_table().size());
}

TEST(Problem, RowsAreWithinTheInterface) {
  const std::set<int> statuses{400, 409, 413, 415, 422, 500};
  std::set<std::string_view> titles;
  for (const ProblemRow& row : problem_table()) {
    EXPECT_TRUE(statuses.contains(row.http_status)) << row.http_status;
    EXPECT_GE(row.exit_code, 1);
    EXPECT_LE(row.exit_code, 4);
    EXPECT_TRUE(titles.insert(row.title).second) << row.title;
  }
  EXPECT_EQ(problem_row(ErrorCode::kBadFold).exit_code, 2);
  EXPECT_EQ(problem_row(ErrorCode::kNotSymmetric).exit_code, 3);
  EXPECT_EQ(problem_row(ErrorCode::kElementLimit).exit_code, 4);
  EXPECT_EQ(problem_row(ErrorCode::kBoundUnreachable).exit_code, 1);
}

TEST(Problem, DocumentHasTheFieldsOfRfc9457) {
  const Error error{ErrorCode::kSelfIntersection, "segments 3 and 5 cross", {3, 5}, "/segments/3"};
  const auto document = problem_document(error, "/v1/jobs/7", "/model");
  EXPECT_EQ(document["type"], "/problems/self_intersection");
  EXPECT_EQ(document["status"], 422);
  EXPECT_EQ(document["title"], "The model intersects itself");
  EXPECT_EQ(document["detail"], "segments 3 and 5 cross");
  EXPECT_EQ(document["instance"], "/v1/jobs/7");
  EXPECT_EQ(document["code"], "self_intersection");
  EXPECT_EQ(document["elements"], nlohmann::json({3, 5}));
  EXPECT_EQ(document["errors"][0]["pointer"], "/model/segments/3");
}

TEST(Problem, PointersToOptionsAreNotPrefixed) {
  const Error error{ErrorCode::kBadFold, "fold must be", {}, "/options/fold"};
  const auto document = problem_document(error, "", "/model");
  EXPECT_EQ(document["errors"][0]["pointer"], "/options/fold");
  EXPECT_FALSE(document.contains("instance"));
}

}  // namespace
}  // namespace symcell
