#include "server/http/webhook_rules.hpp"

#include <gtest/gtest.h>

namespace symcell::server {
namespace {

TEST(WebhookRulesTest, AddressesAreTakenApart) {
  const auto target = parse_webhook_target("https://Hooks.Example:8443/in?x=1");
  ASSERT_TRUE(target);
  EXPECT_TRUE(target->tls);
  EXPECT_EQ(target->host, "hooks.example");
  EXPECT_EQ(target->port, 8443);
  EXPECT_EQ(target->path, "/in?x=1");
  EXPECT_EQ(parse_webhook_target("http://a.example")->path, "/");
  EXPECT_EQ(parse_webhook_target("http://[::1]:90/")->host, "::1");
  for (const char* bad :
       {"ftp://a/", "file:///etc/passwd", "http://", "http://u@a.example/", "http://a.example:0/",
        "http://a.example:99999/", "http://a b/", "http://a/#x", "http://[::1/", "//a/", ""}) {
    EXPECT_FALSE(parse_webhook_target(bad)) << bad;
  }
}

TEST(WebhookRulesTest, PrivateAddressesAreKnown) {
  for (const char* own : {"127.0.0.1",       "10.1.2.3",        "172.16.0.1",   "172.31.255.255",
                          "192.168.0.1",     "169.254.169.254", "100.64.0.1",   "0.0.0.0",
                          "224.0.0.1",       "255.255.255.255", "::1",          "::",
                          "fe80::1",         "fc00::1",         "fd00::1",      "ff02::1",
                          "::ffff:10.0.0.1", "64:ff9b::a00:1",  "2002:a00:1::", "2001:db8::1",
                          "nonsense"}) {
    EXPECT_FALSE(is_public_address(own)) << own;
  }
  for (const char* open : {"8.8.8.8", "172.32.0.1", "100.128.0.1", "2a00:1450:4001::1"}) {
    EXPECT_TRUE(is_public_address(open)) << open;
  }
}

TEST(WebhookRulesTest, HostsMustBeOnTheList) {
  const std::string secret(32, 's');
  const WebhookRules rules({{"hooks.example", "*.part.example"}, false, secret});
  EXPECT_EQ(rules.refusal_of("https://hooks.example/x"), "");
  EXPECT_EQ(rules.refusal_of("https://a.part.example/x"), "");
  for (const char* bad : {"https://part.example/", "https://xpart.example/",
                          "https://other.example/", "hooks.example"}) {
    EXPECT_NE(rules.refusal_of(bad), "") << bad;
  }
  const WebhookRules any({{"*"}, false, secret});
  EXPECT_EQ(any.refusal_of("http://8.8.8.8/"), "");
  EXPECT_NE(any.refusal_of("http://169.254.169.254/latest"), "");
  EXPECT_NE(any.refusal_of("http://[::1]/"), "");
  EXPECT_NE(WebhookRules({}).refusal_of("http://8.8.8.8/"), "");
}

TEST(WebhookRulesTest, NamesOfThisMachineAreResolvedAndRefused) {
  std::string fault;
  const WebhookTarget target{false, "localhost", 80, "/"};
  EXPECT_FALSE(WebhookRules({{"*"}, false, "s"}).resolve(target, fault));
  EXPECT_NE(fault, "");
  EXPECT_TRUE(WebhookRules({{"*"}, true, "s"}).resolve(target, fault));
}

// The example of the Standard Webhooks specification.
TEST(WebhookRulesTest, SignaturesAreThoseOfTheStandard) {
  const auto secret = parse_webhook_secret("whsec_MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaSw\n");
  ASSERT_TRUE(secret);
  EXPECT_EQ(webhook_signature(*secret, "msg_p5jXN8AQM9LWM0D4loKWxJek", "1614265330",
                              "{\"test\": 2432232314}"),
            "v1,g0hM9SsE+OTPJTGt/tmIKtSyZlE3uFJELVlNIOLJ1OE=");
  for (const char* bad :
       {"", "whsec_", "whsec_QUJD", "MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaSw", "whsec_not base64!"}) {
    EXPECT_FALSE(parse_webhook_secret(bad)) << bad;
  }
}

}  // namespace
}  // namespace symcell::server
