#include "server/http/json_guard.hpp"

#include <gtest/gtest.h>

#include <string>

#include "core/model/pslg.hpp"

namespace symcell::server {
namespace {

TEST(JsonGuardTest, WhatIsNoBombPassesInPiecesOfAnyLength) {
  const std::string body =
      R"({"model": {"vertices": [[0,0],[1,0]], "name": "a\"[[[{\\"}, "options": {"fold": [1]}})";
  for (std::size_t size = 1; size <= body.size(); ++size) {
    JsonGuard guard;
    for (std::size_t at = 0; at < body.size(); at += size) {
      EXPECT_TRUE(guard.pass(std::string_view(body).substr(at, size))) << size;
    }
  }
}

TEST(JsonGuardTest, NestingIsBounded) {
  JsonGuard guard;
  EXPECT_TRUE(guard.pass(std::string(JsonGuard::kMostDepth, '[')));
  EXPECT_FALSE(guard.pass("["));
  EXPECT_EQ(guard.error().code, ErrorCode::kJsonSyntax);
  JsonGuard strings;
  EXPECT_TRUE(strings.pass("\"" + std::string(1000, '[') + "\""));
}

TEST(JsonGuardTest, MoreVerticesThanAreTakenAreRefusedAtTheFirstTooMany) {
  JsonGuard guard;
  ASSERT_TRUE(guard.pass(R"({"model":{"vertices":[)"));
  std::string piece;
  for (int i = 0; i < 1000; ++i) piece += "[0,0],";
  std::size_t passed = 0;
  while (guard.pass(piece)) passed += 1000;
  EXPECT_EQ(passed, kMaxPslgVertices - 1000);
  EXPECT_EQ(guard.error().code, ErrorCode::kTooLarge);
}

TEST(JsonGuardTest, OtherListsMayBeLonger) {
  JsonGuard guard;
  ASSERT_TRUE(guard.pass(R"({"vertices":1,"other":[)"));
  const std::string piece(1'000'000, ',');
  for (int i = 0; i < 40; ++i) ASSERT_TRUE(guard.pass(piece));
}

}  // namespace
}  // namespace symcell::server
