#include "server/base/clock.hpp"

#include <gtest/gtest.h>

#include "server/base/identifiers.hpp"

namespace symcell::server {
namespace {

TEST(ClockTest, TimesAreTextOfTheirStandards) {
  EXPECT_EQ(format_timestamp(1'714'564'800'123), "2024-05-01T12:00:00.123Z");
  EXPECT_EQ(format_http_date(1'714'564'800'123), "Wed, 01 May 2024 12:00:00 GMT");
}

TEST(IdentifiersTest, JobIdsSortByTimeAndAreTold) {
  const std::string early = make_job_id(1000);
  const std::string late = make_job_id(2000);
  EXPECT_LT(early, late);
  EXPECT_NE(make_job_id(1000), early);
  EXPECT_TRUE(is_job_id(early));
  EXPECT_FALSE(is_job_id(early.substr(1)));
  EXPECT_FALSE(is_job_id("../../../../etc/passwd----"));
}

TEST(IdentifiersTest, DigestsAreThoseOfSha256) {
  Sha256 digest;
  digest.append("a");
  digest.append("bc");
  EXPECT_EQ(digest.finish(), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

}  // namespace
}  // namespace symcell::server
