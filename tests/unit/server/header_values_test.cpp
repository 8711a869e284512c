#include "server/http/header_values.hpp"

#include <gtest/gtest.h>

namespace symcell::server {
namespace {

TEST(HeaderValuesTest, MediaTypesLoseParametersAndCase) {
  EXPECT_EQ(media_type_of("Text/Plain; charset=utf-8"), "text/plain");
  EXPECT_EQ(media_type_of(""), "");
}

TEST(HeaderValuesTest, TheMostSpecificRangeDecides) {
  EXPECT_TRUE(accepts_media_type("", "application/json"));
  EXPECT_TRUE(accepts_media_type("*/*", "application/json"));
  EXPECT_TRUE(accepts_media_type("application/*;q=0.1", "application/json"));
  EXPECT_FALSE(accepts_media_type("text/html", "application/json"));
  EXPECT_FALSE(accepts_media_type("*/*, application/json;q=0", "application/json"));
}

TEST(HeaderValuesTest, PreferNamesSeconds) {
  EXPECT_EQ(prefer_wait_seconds("wait=30"), 30);
  EXPECT_EQ(prefer_wait_seconds("respond-async, Wait = 5"), 5);
  EXPECT_EQ(prefer_wait_seconds("wait=-1"), std::nullopt);
  EXPECT_EQ(prefer_wait_seconds("wait=x"), std::nullopt);
  EXPECT_EQ(prefer_wait_seconds(""), std::nullopt);
}

TEST(HeaderValuesTest, ETagsMatchInListsAndByStar) {
  EXPECT_TRUE(etag_matches("\"a\"", "\"a\""));
  EXPECT_TRUE(etag_matches("\"b\", W/\"a\"", "\"a\""));
  EXPECT_TRUE(etag_matches("*", "\"a\""));
  EXPECT_FALSE(etag_matches("\"b\"", "\"a\""));
  EXPECT_FALSE(etag_matches("", "\"a\""));
}

TEST(HeaderValuesTest, WholeNumbersAreDigitsOnly) {
  EXPECT_EQ(parse_whole_number("12"), 12);
  EXPECT_EQ(parse_whole_number("-1"), std::nullopt);
  EXPECT_EQ(parse_whole_number("1.5"), std::nullopt);
  EXPECT_EQ(parse_whole_number("99999999999999999999"), std::nullopt);
  EXPECT_EQ(parse_whole_number(""), std::nullopt);
}

}  // namespace
}  // namespace symcell::server
