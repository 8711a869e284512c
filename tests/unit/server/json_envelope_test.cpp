#include "server/http/json_envelope.hpp"

#include <gtest/gtest.h>

namespace symcell::server {
namespace {

ErrorCode code_of(std::string_view body) {
  const auto parts = split_envelope(body);
  EXPECT_FALSE(parts.has_value()) << body;
  return parts ? ErrorCode::kInternal : parts.error().code;
}

TEST(JsonEnvelopeTest, MembersAreCutOutAsTheyStand) {
  const auto parts =
      split_envelope(R"( { "options" : {"fold": 3, "x": "}\"{"} , "model":[1, {"a": "]"}, 2] } )");
  ASSERT_TRUE(parts);
  EXPECT_EQ(parts->options, R"({"fold": 3, "x": "}\"{"})");
  EXPECT_EQ(parts->model, R"([1, {"a": "]"}, 2])");
  EXPECT_FALSE(parts->bare);
}

TEST(JsonEnvelopeTest, OptionsMayBeMissing) {
  const auto parts = split_envelope(R"({"model":{}})");
  ASSERT_TRUE(parts);
  EXPECT_TRUE(parts->options.empty());
}

TEST(JsonEnvelopeTest, ABareModelIsTaken) {
  const auto parts = split_envelope(R"({"type":"pslg","vertices":[]})");
  ASSERT_TRUE(parts);
  EXPECT_TRUE(parts->bare);
  EXPECT_EQ(parts->model, R"({"type":"pslg","vertices":[]})");
}

TEST(JsonEnvelopeTest, WhatIsWrongIsTold) {
  EXPECT_EQ(code_of(""), ErrorCode::kEmptyFile);
  EXPECT_EQ(code_of("  \n"), ErrorCode::kEmptyFile);
  EXPECT_EQ(code_of("[1]"), ErrorCode::kWrongType);
  EXPECT_EQ(code_of("\"model\""), ErrorCode::kWrongType);
  EXPECT_EQ(code_of("hello"), ErrorCode::kJsonSyntax);
  EXPECT_EQ(code_of("{}"), ErrorCode::kMissingField);
  EXPECT_EQ(code_of(R"({"options":{}})"), ErrorCode::kMissingField);
  EXPECT_EQ(code_of(R"({"model":{},"fold":3})"), ErrorCode::kBadOption);
  EXPECT_EQ(code_of(R"({"model":{},"model":{}})"), ErrorCode::kJsonSyntax);
  EXPECT_EQ(code_of(R"({"model":{}} x)"), ErrorCode::kJsonSyntax);
}

TEST(JsonEnvelopeTest, EveryPrefixOfABodyIsRefused) {
  const std::string body = R"({"model":{"a":["\"}",1]},"options":{"fold":3}})";
  for (std::size_t n = 0; n < body.size(); ++n) {
    EXPECT_FALSE(split_envelope(std::string_view(body).substr(0, n))) << n;
  }
  EXPECT_TRUE(split_envelope(body));
}

TEST(JsonEnvelopeTest, DepthCostsNoStack) {
  std::string body = R"({"model":)";
  body += std::string(1'000'000, '[') + std::string(1'000'000, ']') + "}";
  EXPECT_TRUE(split_envelope(body));
}

}  // namespace
}  // namespace symcell::server
