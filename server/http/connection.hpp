// One accepted connection: a stream with limits against slow and endless senders, and what is known
// of the request it carries.
#pragma once

#include <httplib.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "server/http/request_head.hpp"
#include "server/http/stop_signal.hpp"

namespace symcell::server {

struct ConnectionLimits {
  std::chrono::milliseconds io_timeout{15'000};  // without any byte
  std::chrono::milliseconds patience{20'000};    // waiting allowed on top of what the rate grants
  std::size_t min_bytes_per_second = 1024;       // in either direction, averaged over a request
  std::size_t max_header_bytes = 64UL * 1024;    // request line and headers together
};

// A socket as httplib wants it. Reads are buffered, and what httplib reads has been looked at: the
// head as a whole before its first byte is handed over, a chunked body on its way. Only time spent waiting for the peer counts
// against it, so a slow producer on our side is not the client's fault.
class ConnectionStream final : public httplib::Stream {
 public:
  // `stop` must outlive the stream.
  ConnectionStream(socket_t socket, const StopSignal& stop, const ConnectionLimits& limits);

  // True when a request begins to arrive; false: closed, idle for too long, or stop.
  // `give_up` is asked every 100 ms, after the first second, whether the thread is needed
  // elsewhere.
  template <class GiveUp>
  [[nodiscard]] bool wait_for_request(std::chrono::milliseconds idle, const GiveUp& give_up) {
    if (begin_ < buffer_.size()) return true;
    constexpr std::chrono::milliseconds kTick{100};
    constexpr std::chrono::milliseconds kLeast{900};
    for (std::chrono::milliseconds waited{0}; waited < idle; waited += kTick) {
      const Wait outcome = wait_readable(kTick);
      if (outcome != Wait::kTimeout) return outcome == Wait::kReady;
      if (waited >= kLeast && give_up()) return false;
    }
    return false;
  }
  void begin_request();
  enum class Head : std::uint8_t { kWhole, kFaulty, kTooLong, kGone };
  // Waits for the head of a request. kGone: the client is, or was too slow, or the server stops.
  [[nodiscard]] Head read_head(HeadReader& reader);
  [[nodiscard]] std::uint64_t bytes_written() const { return written_; }
  // Tells the peer that no more will come and reads away what it still sends, for a while: closing
  // with unread data would destroy the answer on its way.
  void close_gently();
  // Reads away what has come already; does not wait.
  void discard_arrived();

  // httplib::Stream
  [[nodiscard]] bool is_readable() const override;
  [[nodiscard]] bool is_writable() const override;
  ssize_t read(char* ptr, size_t size) override;
  ssize_t write(const char* ptr, size_t size) override;
  void get_remote_ip_and_port(std::string& ip, int& port) const override;
  void get_local_ip_and_port(std::string& ip, int& port) const override;
  [[nodiscard]] socket_t socket() const override { return socket_; }

 private:
  enum class Wait : std::uint8_t { kReady, kTimeout, kFailed };
  // Also ends, with kFailed, when the server stops.
  [[nodiscard]] Wait wait_readable(std::chrono::milliseconds timeout) const;
  // Waits within the limits; false: timed out, too slow on average, or the server stops and has no
  // patience left.
  [[nodiscard]] bool wait_within_limits(short events,
                                        std::uint64_t bytes,
                                        std::chrono::nanoseconds& waited) const;

  socket_t socket_;
  const StopSignal& stop_;
  ConnectionLimits limits_;
  // False: the end, an error, or no patience left.
  [[nodiscard]] bool receive_more();

  std::string buffer_;
  std::size_t begin_ = 0;                 // unread bytes of buffer_ begin here
  std::size_t head_left_ = 0;             // of the head, not yet read by httplib
  std::optional<ChunkGuard> guard_ = {};  // of a chunked body
  std::uint64_t read_ = 0;                // of this request
  std::uint64_t written_ = 0;             // of this response
  std::chrono::nanoseconds read_wait_{0};
  std::chrono::nanoseconds write_wait_{0};
};

// What the server notes about the request that the calling thread serves.
struct Exchange {
  std::string request_id;
  std::string method;
  std::string path;
  std::string route;             // template of the route, "" if none matched
  std::string accept_encoding;   // moved here so that httplib compresses nothing by itself
  std::string content_encoding;  // likewise for inflating
  int status = 0;
  std::uint64_t declared_bytes = 0;  // of the body, by Content-Length
  bool body_expected = false;        // the request announces a body
  bool body_consumed = false;        // and it was read to its end
  bool close = false;                // the connection cannot serve another request
  std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
};

}  // namespace symcell::server
