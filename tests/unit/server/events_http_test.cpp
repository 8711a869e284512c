// Server-Sent Events.
#include <future>

#include "tests/unit/server/http_fixture.hpp"

namespace symcell::server::test {
namespace {

class EventsHttpTest : public HttpTest {
 protected:
  // The stream's text until it ends.
  [[nodiscard]] std::future<std::string> follow(const std::string& id) {
    return std::async(std::launch::async, [this, id] {
      const auto answer = client().Get("/v1/jobs/" + id + "/events");
      return answer ? answer->body : std::string("no answer");
    });
  }
  [[nodiscard]] bool streams_open(std::size_t count) const {
    return eventually([&] {
      const auto metrics = client().Get("/metrics");
      return metrics && metrics->body.find("symcell_streams_open " + std::to_string(count)) !=
                            std::string::npos;
    });
  }
};

TEST_F(EventsHttpTest, AStreamTellsStateProgressAndEnd) {
  engine_.close_gate();
  const std::string id = submit()["id"];
  auto events = follow(id);
  ASSERT_TRUE(streams_open(1));
  ASSERT_TRUE(reaches(id, "running"));
  engine_.open_gate();
  const std::string text = events.get();
  EXPECT_NE(text.find("event: state\ndata: {\"id\":\"" + id), std::string::npos) << text;
  EXPECT_NE(text.find("event: progress\ndata: {"), std::string::npos) << text;
  const std::size_t end = text.find("event: end\ndata: {");
  ASSERT_NE(end, std::string::npos) << text;
  EXPECT_NE(text.find("\"state\":\"succeeded\"", end), std::string::npos) << text;
  EXPECT_NE(text.find("\"statistics\"", end), std::string::npos) << text;
  EXPECT_TRUE(streams_open(0));
}

TEST_F(EventsHttpTest, AFinishedJobsStreamEndsAtOnce) {
  const std::string id = submit()["id"];
  ASSERT_TRUE(reaches(id, "succeeded"));
  EXPECT_NE(follow(id).get().find("event: end"), std::string::npos);
}

TEST_F(EventsHttpTest, ADeletedJobsStreamEndsWithoutEnd) {
  engine_.close_gate();
  const std::string id = submit()["id"];
  auto events = follow(id);
  ASSERT_TRUE(streams_open(1));
  client().Delete("/v1/jobs/" + id);
  EXPECT_EQ(events.get().find("event: end"), std::string::npos);
}

TEST_F(EventsHttpTest, StreamsAreLimitedAndLeaveThreadsForOthers) {
  engine_.close_gate();
  const std::string id = submit()["id"];
  std::vector<std::future<std::string>> streams;
  for (int i = 0; i < 4; ++i) streams.push_back(follow(id));
  ASSERT_TRUE(streams_open(4));
  EXPECT_EQ(problem_of(client().Get("/v1/jobs/" + id + "/events"), 429)["code"],
            "too_many_streams");
  EXPECT_EQ(client().Get("/healthz")->status, 200);
  engine_.open_gate();
  for (auto& stream : streams) EXPECT_NE(stream.get().find("event: end"), std::string::npos);
}

TEST_F(EventsHttpTest, AStoppingServerEndsStreams) {
  engine_.close_gate();
  const std::string id = submit()["id"];
  auto events = follow(id);
  ASSERT_TRUE(streams_open(1));
  stop();
  EXPECT_EQ(events.get().find("event: end"), std::string::npos);
}

}  // namespace
}  // namespace symcell::server::test
