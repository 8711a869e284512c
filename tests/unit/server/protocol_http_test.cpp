// HTTP itself: methods, unknown paths, request ids, framing, hostile clients.
#include "tests/unit/server/http_fixture.hpp"
#include "tests/unit/server/raw_connection.hpp"

namespace symcell::server::test {
namespace {

class ProtocolHttpTest : public HttpTest {
 protected:
  [[nodiscard]] std::string exchange(const std::string& request) const {
    RawConnection connection(port());
    connection.send(request);
    return connection.receive_all();
  }
};

TEST_F(ProtocolHttpTest, UnknownPathsAreProblems) {
  EXPECT_EQ(problem_of(client().Get("/nothing"), 404)["instance"], "/nothing");
  problem_of(client().Get("/v1/jobs/"), 404);
  problem_of(client().Post("/nothing", std::string(100'000, 'x'), "text/plain"), 404);
}

TEST_F(ProtocolHttpTest, OtherMethodsAreToldWhatIsAllowed) {
  const auto answer = client().Put("/v1/jobs", "x", "text/plain");
  problem_of(answer, 405);
  EXPECT_EQ(answer->get_header_value("Allow"), "POST, GET, HEAD, OPTIONS");
  problem_of(client().Delete("/healthz"), 405);
  problem_of(client().Post("/metrics", "x", "text/plain"), 405);
  const auto options = client().Options("/v1/inspect");
  ASSERT_TRUE(options);
  EXPECT_EQ(options->status, 204);
  EXPECT_EQ(options->get_header_value("Allow"), "POST, OPTIONS");
}

TEST_F(ProtocolHttpTest, RequestIdsAreKeptIfTheyAreHarmless) {
  EXPECT_EQ(
      client().Get("/healthz", {{"X-Request-Id", "abc-1.2_3"}})->get_header_value("X-Request-Id"),
      "abc-1.2_3");
  const std::string made =
      client().Get("/healthz", {{"X-Request-Id", "a b"}})->get_header_value("X-Request-Id");
  EXPECT_EQ(made.size(), 16U);
  EXPECT_FALSE(client().Get("/nothing")->get_header_value("X-Request-Id").empty());
}

TEST_F(ProtocolHttpTest, AnswersCarrySecurityHeadersAndNoCors) {
  const auto answer = client().Get("/", {{"Origin", "http://elsewhere.example"}});
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->get_header_value("X-Content-Type-Options"), "nosniff");
  EXPECT_FALSE(answer->get_header_value("Content-Security-Policy").empty());
  EXPECT_FALSE(answer->has_header("Access-Control-Allow-Origin"));
}

TEST_F(ProtocolHttpTest, AnswersWithoutBodyTellNoLength) {
  const auto answer = client().Options("/v1/jobs");
  ASSERT_TRUE(answer);
  EXPECT_FALSE(answer->has_header("Content-Length"));
  EXPECT_TRUE(answer->get_header_value("Date").ends_with(" GMT"));
}

TEST_F(ProtocolHttpTest, AConnectionServesSeveralRequests) {
  RawConnection connection(port());
  for (int i = 0; i < 3; ++i) {
    connection.send("GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n");
    EXPECT_NE(connection.receive_until("ok\n").find("200 OK"), std::string::npos) << i;
  }
}

TEST_F(ProtocolHttpTest, ABodyNobodyReadEndsTheConnection) {
  // Otherwise its bytes would be taken for the next request.
  const std::string hidden = "GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n";
  const std::string answer = exchange("POST /nothing HTTP/1.1\r\nHost: x\r\nContent-Length: " +
                                      std::to_string(hidden.size()) + "\r\n\r\n" + hidden);
  EXPECT_TRUE(answer.starts_with("HTTP/1.1 404 ")) << answer;
  EXPECT_EQ(answer.find("200 OK"), std::string::npos) << answer;
}

TEST_F(ProtocolHttpTest, AmbiguousFramingIsRefused) {
  const std::string head = "POST /v1/jobs HTTP/1.1\r\nHost: x\r\nContent-Type: text/plain\r\n";
  for (const char* framing : {"Content-Length: 5\r\nTransfer-Encoding: chunked\r\n",
                              "Content-Length: 5\r\nContent-Length: 6\r\n",
                              "Content-Length: abc\r\n", "Content-Length: -1\r\n"}) {
    const std::string answer = exchange(head + framing + "\r\nhello");
    EXPECT_TRUE(answer.starts_with("HTTP/1.1 400 ")) << framing << answer;
  }
  const std::string unknown = exchange(head + "Transfer-Encoding: gzip\r\n\r\nhello");
  EXPECT_TRUE(unknown.starts_with("HTTP/1.1 501 ")) << unknown;
}

// Each of these has two readings, and a proxy may have the other one.
TEST_F(ProtocolHttpTest, HeadsOfTwoReadingsAreRefusedAndTheConnectionEnds) {
  const std::string next = "GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n";
  const std::string length = std::to_string(next.size());
  for (const std::string& fields : std::vector<std::string>{
           "Host: x\r\nContent-Length : " + length,
           "Host: x\r\nContent-Length\t: " + length,
           "Host: x\r\nContent-Length:\r\n " + length,
           "Host: x\r\nA: b\r\n\tContent-Length: " + length,
           "Host: x\r\nContent-Length: 5, 5",
           "Host: x\r\nContent-Length: +5",
           "Host: x\r\nContent-Length: 0x5",
           "Host: x\r\nContent-Length:",
           "Host: x\r\nTransfer-Encoding: chunked\r\nTransfer-Encoding: chunked",
           "Host: x\r\n" + std::string("Conte\0nt-Length: 5", 19),
           "Host: x\r\n" + std::string("A: b\0c", 7),
           std::string("Host: x\r\nA: b\rContent-Length: 5"),
           std::string("Host: x\nContent-Length: 5"),
           std::string("Host: x\r\n: nameless"),
           std::string("Host: x\r\nno colon"),
           std::string("Host: x\r\nHost: y"),
           std::string("Host: x\r\nHost: x"),
           std::string("Host: x y"),
           std::string("Host: x/y"),
           std::string("Host: a@x"),
           std::string("Accept: */*"),
       }) {
    const auto begin = std::chrono::steady_clock::now();
    const std::string answer = exchange("POST /v1/jobs HTTP/1.1\r\n" + fields + "\r\n\r\n" + next);
    EXPECT_TRUE(answer.starts_with("HTTP/1.1 400 ")) << fields << "\n" << answer;
    EXPECT_NE(answer.find("application/problem+json"), std::string::npos) << fields;
    EXPECT_EQ(answer.find("200 OK"), std::string::npos) << fields << "\n" << answer;
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(4)) << fields;
  }
  for (const char* line :
       {"GET  / HTTP/1.1", "GET / HTTP/1.1 ", "GET /\t HTTP/1.1", " GET / HTTP/1.1",
        "G(T / HTTP/1.1", "GET / HTTP/2.0", "GET / http/1.1", "GET /"}) {
    const std::string answer = exchange(std::string(line) + "\r\nHost: x\r\n\r\n" + next);
    EXPECT_TRUE(answer.starts_with("HTTP/1.1 400 ")) << line << "\n" << answer;
    EXPECT_EQ(answer.find("200 OK"), std::string::npos) << line;
  }
}

TEST_F(ProtocolHttpTest, ChunksOfTwoReadingsAreRefusedAtOnce) {
  const std::string head =
      "POST /v1/jobs HTTP/1.1\r\nHost: x\r\nContent-Type: text/plain\r\n"
      "Transfer-Encoding: chunked\r\n\r\n";
  for (const std::string& chunk :
       {std::string("-5\r\nhello\r\n0\r\n\r\n"), std::string("+5\r\nhello\r\n0\r\n\r\n"),
        std::string("0x5\r\nhello\r\n0\r\n\r\n"), std::string(" 5\r\nhello\r\n0\r\n\r\n"),
        std::string("5 \r\nhello\r\n0\r\n\r\n"), std::string("5\nhello\r\n0\r\n\r\n"),
        std::string("5\r\nhello!\r\n0\r\n\r\n"), std::string("\r\nhello"),
        std::string("g\r\nhello"), std::string(4000, 'f'), std::string(4000, '0'),
        "5;" + std::string(4000, 'x')}) {
    const auto begin = std::chrono::steady_clock::now();
    const std::string answer = exchange(head + chunk);
    EXPECT_TRUE(answer.starts_with("HTTP/1.1 400 ")) << chunk.substr(0, 40) << "\n" << answer;
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(4))
        << chunk.substr(0, 40);
  }
}

TEST_F(ProtocolHttpTest, TrailersAreReadAndIgnored) {
  const std::string model = square_json();
  char size[32];
  std::snprintf(size, sizeof size, "%zX\r\n", model.size());
  const std::string begin =
      "POST /v1/jobs HTTP/1.1\r\nHost: x\r\nContent-Type: text/plain\r\n"
      "Transfer-Encoding: chunked\r\n\r\n" +
      (size + model) + "\r\n0\r\n";
  const std::string next = "GET /healthz HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n";
  for (const char* trailer : {"", "X-Sum: 1\r\n", "X-Sum: 1\r\nExpires: never\r\n"}) {
    const std::string answers = exchange(begin + trailer + "\r\n" + next);
    EXPECT_TRUE(answers.starts_with("HTTP/1.1 202 ")) << answers;
    // What follows the trailer is the next request, and nothing else is.
    EXPECT_NE(answers.find("HTTP/1.1 200 "), std::string::npos) << trailer << answers;
  }
  std::string many;
  for (int i = 0; i < 501; ++i) many += "X: y\r\n";
  for (const std::string& trailer :
       {std::string("X-Sum : 1\r\n"), std::string("X: 1\r\n y\r\n"), std::string("X: 1\n"),
        std::string("nothing\r\n"), std::string("X: a\rb\r\n"),
        std::string("Content-Length: 5\r\n"), std::string("transfer-encoding: chunked\r\n"),
        std::string("Host: y\r\n"), "X: " + std::string(70'000, 'y') + "\r\n", many}) {
    const std::string answers = exchange(begin + trailer + "\r\n" + next);
    EXPECT_TRUE(answers.starts_with("HTTP/1.1 400 ")) << trailer.substr(0, 40) << answers;
    EXPECT_EQ(answers.find("HTTP/1.1 200 "), std::string::npos) << trailer.substr(0, 40);
  }
}

TEST_F(ProtocolHttpTest, MethodsThatThereAreNotAreToldFromThoseThatAreNotTaken) {
  const std::string end = " HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n";
  for (const char* method : {"FOO", "get", "PROPFIND"}) {
    const std::string answer = exchange(std::string(method) + " /healthz" + end);
    EXPECT_TRUE(answer.starts_with("HTTP/1.1 501 ")) << answer;
  }
  const std::string trace = exchange("TRACE /healthz" + end);
  EXPECT_TRUE(trace.starts_with("HTTP/1.1 405 ")) << trace;
  EXPECT_NE(trace.find("\r\nAllow: GET, HEAD, OPTIONS\r\n"), std::string::npos) << trace;
  EXPECT_TRUE(exchange("TRACE /nothing" + end).starts_with("HTTP/1.1 404 "));
}

TEST_F(ProtocolHttpTest, RangesOfOtherUnitsAreIgnored) {
  for (const char* range : {"lines=1-2", "bytes=b-a", "nonsense"}) {
    const auto answer = client().Get("/healthz", {{"Range", range}});
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, 200) << range;
  }
}

TEST_F(ProtocolHttpTest, WhatTheGrammarAllowsIsTaken) {
  const std::string head = "POST /v1/jobs HTTP/1.1\r\nHost:x\r\nContent-Type:  text/plain \r\n";
  const std::string model = square_json();
  char size[32];
  std::snprintf(size, sizeof size, "%zX;a=b\r\n", model.size());
  const std::string chunked =
      exchange("\r\n" + head + "Transfer-Encoding: Chunked\r\nConnection: close\r\n\r\n" + size +
               model + "\r\n0\r\n\r\n");
  EXPECT_TRUE(chunked.starts_with("HTTP/1.1 202 ")) << chunked;
  const std::string plain = exchange(head + "Content-Length: 00" + std::to_string(model.size()) +
                                     "\r\nConnection: close\r\n\r\n" + model);
  EXPECT_TRUE(plain.starts_with("HTTP/1.1 202 ")) << plain;
  EXPECT_TRUE(exchange("GET /healthz HTTP/1.0\r\n\r\n").starts_with("HTTP/1.1 200 "));
}

// A megabyte is the limit here.
TEST_F(ProtocolHttpTest, ABodyThatIsTooLargeIsRefusedBeforeItIsSent) {
  for (const char* path : {"/v1/jobs", "/v1/inspect"}) {
    for (const char* length : {"540000000", "999999999999999999999999"}) {
      RawConnection connection(port());
      connection.send("POST " + std::string(path) +
                      " HTTP/1.1\r\nHost: x\r\nContent-Type: text/plain\r\n"
                      "Expect: 100-continue\r\nContent-Length: " +
                      length + "\r\n\r\n");
      const std::string answer = connection.receive_until("body_too_large");
      EXPECT_TRUE(answer.starts_with("HTTP/1.1 413 ")) << answer;
      EXPECT_EQ(answer.find("100 Continue"), std::string::npos) << answer;
    }
  }
  RawConnection connection(port());
  connection.send(
      "POST /v1/jobs HTTP/1.1\r\nHost: x\r\nContent-Type: text/plain\r\nExpect: 100-continue\r\n"
      "Content-Length: " +
      std::to_string(square_json().size()) + "\r\n\r\n");
  EXPECT_TRUE(connection.receive_until("\r\n\r\n").starts_with("HTTP/1.1 100 "));
  connection.send(square_json());
  EXPECT_TRUE(connection.receive_until("\r\n\r\n").starts_with("HTTP/1.1 202 "));
}

// Many clients look for an answer only when all is sent.
TEST_F(ProtocolHttpTest, AClientThatSendsAllOfALargeBodyFirstCanReadItsRefusal) {
  constexpr std::size_t kBytes = 200UL << 20U;
  RawConnection connection(port());
  ASSERT_TRUE(
      connection.send("POST /v1/jobs HTTP/1.1\r\nHost: x\r\nContent-Type: text/plain\r\n"
                      "Content-Length: " +
                      std::to_string(kBytes) + "\r\n\r\n"));
  const std::string piece(1UL << 20U, 'x');
  for (std::size_t sent = 0; sent < kBytes; sent += piece.size())
    ASSERT_TRUE(connection.send(piece)) << sent;
  EXPECT_TRUE(connection.receive_until("body_too_large").starts_with("HTTP/1.1 413 "));
}

TEST_F(ProtocolHttpTest, GarbageAndEndlessHeadersAreRefused) {
  EXPECT_TRUE(exchange("this is not http\r\n\r\n").starts_with("HTTP/1.1 400 "));
  EXPECT_TRUE(
      exchange("GET / HTTP/1.1\r\nX: " + std::string(200'000, 'x')).starts_with("HTTP/1.1 431 "));
  EXPECT_TRUE(exchange("GET /" + std::string(20'000, 'x') + " HTTP/1.1\r\n\r\n")
                  .starts_with("HTTP/1.1 414 "));
  std::string many = "GET / HTTP/1.1\r\n";
  for (int i = 0; i < 10'000; ++i) many += "X-Header: some value\r\n";
  EXPECT_EQ(exchange(many + "\r\n").find("200 OK"), std::string::npos);
  EXPECT_EQ(client().Get("/healthz")->status, 200);
}

TEST_F(ProtocolHttpTest, IdleConnectionsMakeWay) {
  // More than there are threads; each has been served once and keeps its connection.
  std::vector<std::unique_ptr<RawConnection>> idle;
  for (int i = 0; i < 20; ++i) {
    idle.push_back(std::make_unique<RawConnection>(port()));
    idle.back()->send("GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n");
  }
  for (auto& connection : idle) {
    EXPECT_NE(connection->receive_until("ok\n").find("200 OK"), std::string::npos);
  }
}

// Far more than there are threads: silent, idle, in the middle of a head, of a small body, of a large
// one.
TEST_F(ProtocolHttpTest, SlowClientsHoldNobodyUp) {
  std::vector<std::unique_ptr<RawConnection>> slow;
  const auto add = [&](const std::string& bytes) {
    slow.push_back(std::make_unique<RawConnection>(port()));
    slow.back()->send(bytes);
  };
  const std::string post =
      "POST /v1/jobs HTTP/1.1\r\nHost: x\r\nContent-Type: text/plain\r\nContent-Length: ";
  for (int i = 0; i < 40; ++i) {
    add("");
    add("GET /healthz HTTP/1.1\r\n");
    add(post + "1000\r\n\r\nhalf");
  }
  // As many as there are threads for such.
  for (int i = 0; i < 8; ++i) add(post + "1000000\r\n\r\nhalf");
  for (int i = 0; i < 5; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    for (const char* path : {"/healthz", "/readyz", "/metrics", "/v1/jobs"}) {
      const auto answer = client().Get(path);
      ASSERT_TRUE(answer) << path;
      EXPECT_EQ(answer->status, 200) << path;
    }
    EXPECT_EQ(client().Post("/v1/jobs", job_body(), "application/json")->status, 202);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(2));
  }
}

class FewConnectionsHttpTest : public ProtocolHttpTest {
 protected:
  void configure(ServiceSettings& settings) override {
    settings.http.lobby.connections = 50;
    settings.http.lobby.connections_per_client = 50;
  }
};

TEST_F(FewConnectionsHttpTest, ConnectionsBeyondTheLimitAreRefusedAtOnceUnlessAnIdleOneMakesWay) {
  std::vector<std::unique_ptr<RawConnection>> held;
  for (int i = 0; i < 50; ++i) {
    held.push_back(std::make_unique<RawConnection>(port()));
    held.back()->send("GET /healthz HTTP/1.1\r\n");  // and never finishes
  }
  ASSERT_TRUE(eventually(
      [&] { return exchange("GET /healthz HTTP/1.0\r\n\r\n").starts_with("HTTP/1.1 503 "); }));
  held[0]->send("Host: x\r\n\r\n");
  EXPECT_NE(held[0]->receive_until("ok\n").find("200 OK"), std::string::npos);
  EXPECT_TRUE(eventually(
      [&] { return exchange("GET /healthz HTTP/1.0\r\n\r\n").starts_with("HTTP/1.1 200 "); }));
}

TEST_F(ProtocolHttpTest, AClientThatClosesItsSideIsAnswered) {
  RawConnection connection(port());
  connection.send("GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n");
  connection.close_sending();
  EXPECT_NE(connection.receive_all().find("200 OK"), std::string::npos);
}

TEST_F(ProtocolHttpTest, RequestsThatComeTogetherAreAnsweredInTurn) {
  std::string several;
  for (int i = 0; i < 5; ++i) several += "GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n";
  const std::string answers =
      exchange(several + "GET /healthz HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n");
  std::size_t count = 0;
  for (std::size_t at = answers.find("200 OK"); at != std::string::npos;
       at = answers.find("200 OK", at + 1))
    ++count;
  EXPECT_EQ(count, 6U) << answers;
}

TEST_F(ProtocolHttpTest, StopDoesNotWaitForIdleConnections) {
  RawConnection idle(port());
  idle.send("GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n");
  ASSERT_NE(idle.receive_until("ok\n").find("200"), std::string::npos);
  const auto begin = std::chrono::steady_clock::now();
  stop();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(2));
}

TEST_F(ProtocolHttpTest, StopWaitsForHalfARequestOnlyShortly) {
  RawConnection half(port());
  half.send("GET /healthz HTTP/1.1\r\n");
  const auto begin = std::chrono::steady_clock::now();
  stop();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
}

class CorsHttpTest : public HttpTest {
 protected:
  void configure(ServiceSettings& settings) override {
    settings.http.cors_origins = {"https://viewer.example"};
  }
};

TEST_F(CorsHttpTest, TheConfiguredOriginMayCall) {
  const auto answer = client().Options("/v1/jobs");
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 204);
  EXPECT_EQ(answer->get_header_value("Access-Control-Allow-Origin"), "https://viewer.example");
  EXPECT_NE(answer->get_header_value("Access-Control-Allow-Methods").find("POST"),
            std::string::npos);
  const httplib::Headers from{{"Origin", "https://viewer.example"},
                              {"Sec-Fetch-Site", "cross-site"}};
  EXPECT_EQ(client().Post("/v1/jobs", from, job_body(), "application/json")->status, 202);
  const httplib::Headers other{{"Origin", "https://evil.example"},
                               {"Sec-Fetch-Site", "cross-site"}};
  EXPECT_EQ(
      problem_of(client().Post("/v1/jobs", other, job_body(), "application/json"), 403)["code"],
      "cross_site");
}

TEST_F(ProtocolHttpTest, APageOfAnotherSiteChangesNothing) {
  const std::string own = "127.0.0.1:" + std::to_string(port());
  for (const httplib::Headers& headers : {
           httplib::Headers{{"Origin", "http://evil.example"}},
           httplib::Headers{{"Origin", "null"}},
           httplib::Headers{{"Origin", "http://127.0.0.1:1"}},
           httplib::Headers{{"Sec-Fetch-Site", "cross-site"}},
           httplib::Headers{{"Sec-Fetch-Site", "same-site"}},
       }) {
    const auto answer = client().Post("/v1/jobs", headers, square_json(), "text/plain");
    EXPECT_EQ(problem_of(answer, 403)["code"], "cross_site");
    EXPECT_EQ(problem_of(client().Delete("/v1/jobs/x", headers), 403)["code"], "cross_site");
    // What only looks is the browser's to hide from the page.
    EXPECT_EQ(client().Get("/v1/jobs", headers)->status, 200);
  }
  for (const httplib::Headers& headers : {
           httplib::Headers{{"Origin", "http://" + own}, {"Sec-Fetch-Site", "same-origin"}},
           httplib::Headers{{"Sec-Fetch-Site", "none"}},
           httplib::Headers{},
       }) {
    const auto answer = client().Post("/v1/inspect", headers, square_json(), "text/plain");
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, 200) << answer->body;
  }
}

TEST_F(ProtocolHttpTest, NamesThatAreNotTheServersAreRefused) {
  const auto get = [&](const std::string& host, const std::string& path) {
    return exchange("GET " + path + " HTTP/1.1\r\nConnection: close\r\nHost: " + host + "\r\n\r\n");
  };
  for (const char* host : {"evil.example", "evil.example:80", "127.0.0.1.evil.example", "192.0.2.1",
                           "[2001:db8::1]", "localhost.evil.example", ""}) {
    const std::string answer = get(host, "/v1/jobs");
    const bool named = *host != '\0';
    EXPECT_EQ(answer.starts_with("HTTP/1.1 403 "), named) << host << "\n" << answer;
    EXPECT_EQ(answer.find("host_not_allowed") != std::string::npos, named) << host;
    EXPECT_TRUE(get(host, "/healthz").starts_with("HTTP/1.1 200 ")) << host;
  }
  for (const char* host :
       {"localhost", "LOCALHOST:1234", "127.0.0.1:9", "[::1]:80", "a.localhost", "x"}) {
    EXPECT_TRUE(get(host, "/v1/jobs").starts_with("HTTP/1.1 200 ")) << host;
  }
}

}  // namespace
}  // namespace symcell::server::test
