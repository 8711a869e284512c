#include "server/http/site_policy.hpp"

#include <gtest/gtest.h>

namespace symcell::server {
namespace {

TEST(SitePolicy, ASingleAddressGoesByItsNumberAndByLoopbackNames) {
  const SitePolicy policy("192.0.2.7", {"mesh.example", "Other.Example:8443"}, {});
  for (const char* host : {"192.0.2.7", "192.0.2.7:8080", "localhost:8080", "mesh.example",
                           "mesh.example:99", "other.example:8443"}) {
    EXPECT_TRUE(policy.allows_host(host)) << host;
  }
  for (const char* host : {"192.0.2.8", "evil.example", "other.example", "mesh.example.evil"}) {
    EXPECT_FALSE(policy.allows_host(host)) << host;
  }
}

TEST(SitePolicy, AllAddressesGoByAnyNumber) {
  for (const char* bound : {"0.0.0.0", "::"}) {
    const SitePolicy policy(bound, {}, {});
    EXPECT_TRUE(policy.allows_host("10.1.2.3:8080"));
    EXPECT_TRUE(policy.allows_host("[fe80::1]:8080"));
    EXPECT_FALSE(policy.allows_host("evil.example:8080"));
    EXPECT_FALSE(policy.allows_host("10.1.2.3.evil.example"));
    EXPECT_TRUE(SitePolicy(bound, {"*"}, {}).allows_host("anything.example"));
  }
}

TEST(SitePolicy, AChangeComesFromTheSameOriginOrOneThatIsNamed) {
  const SitePolicy closed("127.0.0.1", {}, {});
  EXPECT_TRUE(closed.allows_change("localhost:8080", "", ""));
  EXPECT_TRUE(closed.allows_change("localhost:8080", "http://localhost:8080", ""));
  EXPECT_TRUE(closed.allows_change("mesh.example", "https://mesh.example", "same-origin"));
  EXPECT_FALSE(closed.allows_change("localhost:8080", "http://localhost:9090", "same-site"));
  EXPECT_FALSE(closed.allows_change("localhost", "http://localhost:8080", ""));
  EXPECT_FALSE(closed.allows_change("localhost:8080", "null", ""));
  EXPECT_FALSE(closed.allows_change("localhost:8080", "", "cross-site"));
  const SitePolicy open("127.0.0.1", {}, {"https://a.example", "https://b.example"});
  EXPECT_TRUE(open.allows_change("localhost:8080", "https://b.example", "cross-site"));
  EXPECT_FALSE(open.allows_change("localhost:8080", "https://c.example", "cross-site"));
  EXPECT_EQ(open.shared_with("https://b.example"), "https://b.example");
  EXPECT_EQ(open.shared_with("https://c.example"), "");
  EXPECT_EQ(SitePolicy("127.0.0.1", {}, {"*"}).shared_with("https://c.example"), "*");
  EXPECT_EQ(closed.shared_with("https://c.example"), "");
}

}  // namespace
}  // namespace symcell::server
