// Messages between server and worker: what goes in comes out, whatever comes in does no harm.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <limits>
#include <string>
#include <variant>

#include "server/worker/protocol.hpp"

namespace symcell::server::test {
namespace {

template <class Message>
Message through(const Message& message) {
  const auto decoded = decode_message(encode_message(message));
  EXPECT_TRUE(decoded) << decoded.error().message;
  const Message* same = decoded ? std::get_if<Message>(&*decoded) : nullptr;
  EXPECT_NE(same, nullptr);
  return same != nullptr ? *same : Message{};
}

TEST(WorkerProtocol, KeepsARequest) {
  RequestMessage request;
  request.task = WorkerTask::kInspect;
  request.job.model = "/data/100%/m\xfc \"model\"\n";
  request.job.model_format = ModelFormat::kPoly;
  request.job.cell = "c";
  request.job.statistics = "s";
  request.job.options.fold = 7;
  request.job.options.max_area = 0.1;
  request.job.options.seed = std::numeric_limits<std::uint64_t>::max();
  request.limits = {std::numeric_limits<std::uint64_t>::max(), 3};
  const RequestMessage same = through(request);
  EXPECT_EQ(same.task, WorkerTask::kInspect);
  EXPECT_EQ(same.job.model, request.job.model);
  EXPECT_EQ(same.job.model_format, ModelFormat::kPoly);
  EXPECT_EQ(same.job.cell, "c");
  EXPECT_EQ(same.job.statistics, "s");
  EXPECT_EQ(same.job.options.fold, 7);
  EXPECT_EQ(same.job.options.max_area, 0.1);
  EXPECT_EQ(same.job.options.max_edge, kInfinity);
  EXPECT_EQ(same.job.options.seed, request.job.options.seed);
  EXPECT_EQ(same.limits, request.limits);
}

TEST(WorkerProtocol, KeepsProgressAndResults) {
  const Progress progress =
      through(ProgressMessage{{Phase::kImprove, 0.25, 1UL << 40U, 0.5}}).progress;
  EXPECT_EQ(progress.phase, Phase::kImprove);
  EXPECT_EQ(progress.fraction, 0.25);
  EXPECT_EQ(progress.elements, 1UL << 40U);
  EXPECT_EQ(progress.quality_reached, 0.5);
  EXPECT_EQ(through(DoneMessage{"{\"a\": \"\xc3\xa4\"}\n"}).document, "{\"a\": \"\xc3\xa4\"}\n");
  const Error error =
      through(FailedMessage{{ErrorCode::kNotSymmetric, "no", {3, -1}, "/vertices/3"}}).error;
  EXPECT_EQ(error.code, ErrorCode::kNotSymmetric);
  EXPECT_EQ(error.message, "no");
  EXPECT_EQ(error.elements, (std::vector<std::int64_t>{3, -1}));
  EXPECT_EQ(error.pointer, "/vertices/3");
  through(HelloMessage{});
  through(CancelMessage{});
}

TEST(WorkerProtocol, RepairsTextThatIsNotUtf8) {
  const FailedMessage message{{ErrorCode::kSyntax, "unknown word \"\xff\"", {}, {}}};
  EXPECT_EQ(through(message).error.message, "unknown word \"\xef\xbf\xbd\"");
}

TEST(WorkerProtocol, RefusesWhatIsNoMessage) {
  for (const char* text :
       {"", "{", "[]", "{}", "7", R"({"v":1})", R"({"v":2,"type":"hello"})",
        R"({"v":1,"type":"?"})", R"({"v":1,"type":"request"})",
        R"({"v":1,"type":"progress","phase":"x"})", R"({"v":1,"type":"done","document":3})"}) {
    EXPECT_FALSE(decode_message(text)) << text;
  }
}

TEST(WorkerProtocol, PutsFramesTogetherFromAnyPieces) {
  const std::string stream = frame_of("one") + frame_of("") + frame_of(std::string(70'000, 'x'));
  for (const std::size_t piece : {1UL, 3UL, 1000UL, stream.size()}) {
    FrameReader reader;
    std::vector<std::string> frames;
    for (std::size_t at = 0; at < stream.size(); at += piece) {
      reader.append(std::string_view(stream).substr(at, piece));
      while (true) {
        const auto frame = reader.next();
        ASSERT_TRUE(frame);
        if (!*frame) break;
        frames.push_back(**frame);
      }
    }
    ASSERT_EQ(frames.size(), 3U);
    EXPECT_EQ(frames[0], "one");
    EXPECT_EQ(frames[1], "");
    EXPECT_EQ(frames[2].size(), 70'000U);
  }
}

TEST(WorkerProtocol, RefusesAnImpossibleLength) {
  FrameReader reader;
  reader.append("HTTP/1.1 400");
  EXPECT_FALSE(reader.next());
}

class ChannelTest : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends_.data()), 0); }
  std::array<int, 2> ends_{};
};

TEST_F(ChannelTest, CarriesMessagesAndTellsTheEnd) {
  MessageChannel left(ends_[0]);
  {
    MessageChannel right(ends_[1]);
    EXPECT_EQ(left.receive().status, MessageChannel::Status::kNothing);
    ASSERT_TRUE(right.send(HelloMessage{}));
    ASSERT_TRUE(right.send(DoneMessage{std::string(100'000, 'y')}));
    EXPECT_TRUE(std::holds_alternative<HelloMessage>(left.receive().message));
    EXPECT_EQ(std::get<DoneMessage>(left.receive().message).document.size(), 100'000U);
  }
  EXPECT_EQ(left.receive().status, MessageChannel::Status::kClosed);
  EXPECT_FALSE(left.send(CancelMessage{}));  // and no SIGPIPE
}

TEST_F(ChannelTest, HangsUpOnNonsense) {
  MessageChannel left(ends_[0]);
  const std::string frame = frame_of("nonsense");
  ASSERT_EQ(::write(ends_[1], frame.data(), frame.size()), static_cast<ssize_t>(frame.size()));
  EXPECT_EQ(left.receive().status, MessageChannel::Status::kClosed);
  ::close(ends_[1]);
}

}  // namespace
}  // namespace symcell::server::test
