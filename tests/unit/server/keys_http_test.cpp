// Who may call: keys, scopes, limits, and jobs that are nobody else's.
#include "server/keys/sqlite_key_store.hpp"
#include "tests/unit/server/http_fixture.hpp"

namespace symcell::server::test {
namespace {

class KeysHttpTest : public HttpTest {
 protected:
  // Makes a key as `symcell keys create` does; returns its text.
  std::string make(const std::string& scopes, KeyLimits limits = {}) {
    const NewKey made = make_key();
    ApiKey key;
    key.id = made.id;
    key.name = "of a test";
    key.hash = made.hash;
    key.scopes = *parse_scopes(scopes);
    key.limits = limits;
    keys().insert(key);
    // Known at once: a key that nobody knows makes the server look again.
    EXPECT_TRUE(eventually([&] { return with(made.text).Get("/v1/jobs")->status != 401; }));
    return made.text;
  }

  [[nodiscard]] SqliteKeyStore keys() const {
    return SqliteKeyStore(folder_ / "jobs.sqlite", false);
  }

  [[nodiscard]] httplib::Client with(const std::string& key) const {
    httplib::Client caller = client();
    caller.set_default_headers({{"Authorization", "Bearer " + key}});
    return caller;
  }

  static nlohmann::json accepted(const httplib::Result& answer) {
    EXPECT_TRUE(answer);
    if (!answer) return {};
    EXPECT_EQ(answer->status, 202) << answer->body;
    return nlohmann::json::parse(answer->body);
  }

  static httplib::Result post(httplib::Client caller, const httplib::Headers& headers = {}) {
    return caller.Post("/v1/jobs", headers, job_body(), "application/json");
  }
};

TEST_F(KeysHttpTest, AKeyIsAskedForAsSoonAsThereIsOne) {
  EXPECT_EQ(client().Get("/v1/jobs")->status, 200);
  const std::string key = make("submit,read");
  ASSERT_TRUE(eventually([&] { return client().Get("/v1/jobs")->status == 401; }));
  const auto refused = client().Get("/v1/jobs");
  EXPECT_EQ(problem_of(refused, 401)["code"], "unauthorized");
  EXPECT_EQ(refused->get_header_value("WWW-Authenticate"), "Bearer realm=\"symcell\"");
  EXPECT_EQ(with(key).Get("/v1/jobs")->status, 200);
  EXPECT_EQ(client().Get("/v1/jobs", {{"X-API-Key", key}})->status, 200);
  std::string wrong = key;
  wrong.back() = wrong.back() == 'A' ? 'B' : 'A';
  for (const std::string& text : {wrong, key.substr(1), std::string("x"), std::string()}) {
    EXPECT_EQ(with(text).Get("/v1/jobs")->status, 401) << text;
  }
  EXPECT_EQ(client().Get("/v1/jobs", {{"Authorization", "Basic eDp5"}})->status, 401);
  for (const char* open : {"/healthz", "/readyz", "/metrics", "/openapi.yaml", "/docs"}) {
    EXPECT_EQ(client().Get(open)->status, 200) << open;
  }
}

TEST_F(KeysHttpTest, ARevokedKeyIsRefusedSoon) {
  const std::string key = make("read");
  const std::string id = keys().list().front().id;
  EXPECT_TRUE(keys().revoke(id, 1));
  EXPECT_FALSE(keys().revoke("none", 1));
  EXPECT_TRUE(eventually([&] { return with(key).Get("/v1/jobs")->status == 401; }));
  // Revoking the last one opens nothing.
  EXPECT_EQ(client().Get("/v1/jobs")->status, 401);
}

TEST_F(KeysHttpTest, ScopesDecideWhatAKeyMayDo) {
  const std::string reads = make("read");
  const std::string submits = make("submit");
  EXPECT_EQ(problem_of(post(with(reads)), 403)["code"], "scope_missing");
  const std::string id = accepted(post(with(submits)))["id"];
  EXPECT_EQ(problem_of(with(submits).Get("/v1/jobs/" + id), 403)["code"], "scope_missing");
  for (const std::string& key : {reads, submits}) {
    EXPECT_EQ(problem_of(with(key).Get("/v1/keys"), 403)["code"], "scope_missing");
  }
  EXPECT_EQ(with(submits).Delete("/v1/jobs/" + id)->status, 204);
}

TEST_F(KeysHttpTest, JobsOfOthersDoNotExist) {
  const std::string mine = make("submit,read");
  const std::string other = make("submit,read");
  const std::string admin = make("admin");
  const httplib::Headers order{{"Idempotency-Key", "order-7"}};
  const auto job = accepted(post(with(mine), order));
  const std::string path = "/v1/jobs/" + std::string(job["id"]);
  EXPECT_NE(accepted(post(with(other), order))["id"], job["id"]);
  EXPECT_EQ(with(mine).Get(path)->status, 200);
  for (const char* end : {"", "/cell", "/full", "/statistics", "/model", "/events"}) {
    EXPECT_EQ(with(other).Get(path + end)->status, 404) << end;
  }
  EXPECT_EQ(with(other).Post(path + "/cancel")->status, 404);
  EXPECT_EQ(with(other).Post(path + "/rerun")->status, 404);
  EXPECT_EQ(with(other).Delete(path)->status, 404);
  const auto ids = [&](const std::string& key, const std::string& query) {
    return nlohmann::json::parse(with(key).Get("/v1/jobs" + query)->body)["jobs"].size();
  };
  EXPECT_EQ(ids(mine, ""), 1U);
  EXPECT_EQ(ids(admin, ""), 2U);
  EXPECT_EQ(ids(admin, "?key=" + std::string(job["key"])), 1U);
  EXPECT_EQ(ids(other, "?key=" + std::string(job["key"])), 1U) << "its own, whatever it asks for";
  EXPECT_EQ(with(admin).Get(path)->status, 200);
  EXPECT_EQ(with(admin).Delete(path)->status, 204);
}

TEST_F(KeysHttpTest, ARateIsToldAndKept) {
  const std::string key = make("read", {.requests_per_minute = 4});
  int allowed = 1;  // one was used by make()
  for (int i = 0; i < 10; ++i) {
    const auto answer = with(key).Get("/v1/jobs");
    if (answer->status == 200) ++allowed;
    EXPECT_EQ(answer->get_header_value("RateLimit-Policy"), "\"requests\";q=4;w=60");
    if (answer->status == 200) continue;
    EXPECT_EQ(problem_of(answer, 429)["code"], "rate_limited");
    EXPECT_EQ(answer->get_header_value_count("Retry-After"), 1U);
    const int wait = std::stoi(answer->get_header_value("Retry-After"));
    EXPECT_GE(wait, 1);
    EXPECT_LE(wait, 15);
  }
  EXPECT_EQ(allowed, 4);
}

TEST_F(KeysHttpTest, JobsAndBytesOfAKeyAreLimited) {
  const auto bytes = static_cast<std::int64_t>(square_json().size());
  const std::string key = make("submit,read", {.queued = 1, .bytes_per_day = 2 * bytes + 1});
  engine_.close_gate();
  const std::string running = accepted(post(with(key)))["id"];
  ASSERT_TRUE(eventually([&] {
    const auto answer = with(key).Get("/v1/jobs/" + running);
    return nlohmann::json::parse(answer->body)["state"] == "running";
  }));
  const std::string waiting = accepted(post(with(key)))["id"];
  EXPECT_EQ(problem_of(post(with(key)), 429)["code"], "queue_full");
  EXPECT_EQ(with(key).Delete("/v1/jobs/" + waiting)->status, 204);
  // What was deleted has been sent all the same.
  const auto spent = post(with(key));
  EXPECT_EQ(problem_of(spent, 429)["code"], "quota_spent");
  EXPECT_LE(std::stoi(spent->get_header_value("Retry-After")), 24 * 3600 + 1);
}

TEST_F(KeysHttpTest, AnAdministratorSeesKeysAndTheirUse) {
  const std::string admin = make("admin");
  const std::string key = make("submit,read", {.running = 3});
  accepted(post(with(key)));
  const auto listed = nlohmann::json::parse(with(admin).Get("/v1/keys")->body)["keys"];
  ASSERT_EQ(listed.size(), 2U);
  const auto& row = listed[0]["limits"]["running"].is_null() ? listed[1] : listed[0];
  EXPECT_EQ(row["limits"]["running"], 3);
  EXPECT_EQ(row["usage"]["jobs_today"], 1);
  EXPECT_EQ(row["usage"]["bytes_today"], square_json().size());
  EXPECT_EQ(row["scopes"], nlohmann::json({"submit", "read"}));
  EXPECT_FALSE(row.contains("hash"));
}

class OpenAddressHttpTest : public KeysHttpTest {
 protected:
  void configure(ServiceSettings& settings) override {
    settings.http.host = "0.0.0.0";
    settings.access.insecure_open = insecure_;
  }
  bool insecure_ = false;
};

TEST_F(OpenAddressHttpTest, AnAddressThatOthersReachNeedsKeysUnlessItIsSaidOtherwise) {
  EXPECT_EQ(problem_of(client().Get("/v1/jobs"), 401)["code"], "unauthorized");
  EXPECT_EQ(client().Get("/healthz")->status, 200);
  stop();
  insecure_ = true;
  start();
  EXPECT_EQ(client().Get("/v1/jobs")->status, 200);
}

TEST(ApiKeyTest, AKeyIsItsIdAndASecretThatOnlyItsHashTells) {
  const NewKey one = make_key();
  const NewKey two = make_key();
  EXPECT_NE(one.id, two.id);
  EXPECT_NE(one.hash, two.hash);
  const auto parts = parse_key(one.text);
  ASSERT_TRUE(parts);
  EXPECT_EQ(parts->id, one.id);
  EXPECT_TRUE(same_hash(parts->hash, one.hash));
  EXPECT_FALSE(same_hash(parts->hash, two.hash));
  EXPECT_FALSE(same_hash(parts->hash, ""));
  EXPECT_EQ(one.text.find(one.hash), std::string::npos);
  for (const std::string& text : {one.text + "x", one.text.substr(1), std::string()}) {
    EXPECT_FALSE(parse_key(text)) << text;
  }
}

TEST(ApiKeyTest, ScopesAreNamed) {
  EXPECT_EQ(scopes_text(*parse_scopes("read,submit,read")), "read,submit");
  EXPECT_FALSE(parse_scopes(""));
  EXPECT_FALSE(parse_scopes("read,write"));
}

TEST(TokenBucketTest, GivesItsShareAndNoMore) {
  TokenBucket bucket;
  TokenBucket::Clock::time_point now{};
  int allowed = 0;
  for (int i = 0; i < 20; ++i) allowed += bucket.take(6, now).allowed ? 1 : 0;
  EXPECT_EQ(allowed, 6);
  EXPECT_EQ(bucket.take(6, now).reset_s, 10);
  now += std::chrono::seconds(10);
  EXPECT_TRUE(bucket.take(6, now).allowed);
  EXPECT_FALSE(bucket.take(6, now).allowed);
  now += std::chrono::hours(5);
  EXPECT_EQ(bucket.take(6, now).remaining, 5);
}

}  // namespace
}  // namespace symcell::server::test
