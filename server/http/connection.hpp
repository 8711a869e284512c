// One accepted connection: a stream with limits against slow and endless senders, and what is known
// of the request it carries.
#pragma once

#include <httplib.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "server/http/lobby.hpp"
#include "server/http/request_head.hpp"
#include "server/http/stop_signal.hpp"
#include "server/http/suspended_calls.hpp"
#include "server/keys/api_key.hpp"

namespace symcell::server {

// A client that is waited for must take or send so much: at least this many bytes a second, on average
// over every window of waiting.
struct ConnectionLimits {
  std::chrono::milliseconds window{20'000};
  std::size_t min_bytes_per_second = 1024;
};

// A socket as httplib wants it. Reads are buffered, and what httplib reads has been looked at: the
// head as a whole before its first byte is handed over, a chunked body on its way. Only time spent waiting for the peer counts
// against it, so a slow producer on our side is not the client's fault.
class ConnectionStream final : public httplib::Stream {
 public:
  // For one request, whose head has come. Takes the bytes of the connection that belong to it. All
  // must outlive the stream.
  ConnectionStream(Connection& connection, const StopSignal& stop, const ConnectionLimits& limits);
  // Leaves the bytes that came after the request in the connection.
  ~ConnectionStream() override;
  ConnectionStream(const ConnectionStream&) = delete;
  ConnectionStream& operator=(const ConnectionStream&) = delete;

  // While `silent` is true what is written goes nowhere.
  void silence_by(const bool& silent) { silent_ = &silent; }
  // httplib::Stream
  [[nodiscard]] bool is_readable() const override;
  [[nodiscard]] bool is_writable() const override;
  ssize_t read(char* ptr, size_t size) override;
  ssize_t write(const char* ptr, size_t size) override;
  void get_remote_ip_and_port(std::string& ip, int& port) const override;
  void get_local_ip_and_port(std::string& ip, int& port) const override;
  [[nodiscard]] socket_t socket() const override { return socket_; }

 private:
  // How far the peer has come since the window began.
  struct Pace {
    std::chrono::nanoseconds waited{0};
    std::uint64_t mark = 0;  // bytes at the window's begin
  };
  // Waits within the limits; false: too slow, or the server stops and has no patience left.
  [[nodiscard]] bool wait_within_limits(short events, Pace& pace) const;
  // That the peer has sent, or has taken: what waits in the kernel to be sent is not taken.
  [[nodiscard]] std::uint64_t progress(short events) const;
  // False: the end, an error, or no patience left.
  [[nodiscard]] bool receive_more();
  [[nodiscard]] bool skip_trailer();

  Connection& connection_;
  socket_t socket_;
  const StopSignal& stop_;
  ConnectionLimits limits_;
  std::string& buffer_;  // the connection's bytes; those before begin_ were read
  std::size_t begin_ = 0;
  std::size_t head_left_ = 0;        // of the head, not yet read by httplib
  std::optional<ChunkGuard> guard_;  // of a chunked body
  std::string_view stand_in_;        // what httplib is shown in the place of a trailer
  std::uint64_t read_ = 0;
  std::uint64_t written_ = 0;
  const bool* silent_ = nullptr;
  Pace reading_;
  Pace writing_;
};

// Who calls.
struct Caller {
  std::string client;                 // for turns and shares: the key's id, or an address
  std::shared_ptr<const ApiKey> key;  // null: none was asked for
  bool sees_all = true;               // jobs of everybody

  [[nodiscard]] std::string owner() const { return key ? key->id : std::string(); }
};

// What the server notes about the request that the calling thread serves.
struct Exchange {
  std::string request_id;
  std::string client;  // its address
  Caller caller;
  std::string method;
  std::string path;
  std::string job;               // that the request is about, "" if none
  std::string traceparent;       // W3C Trace Context, "" if none came
  std::string route;             // template of the route, "" if none matched
  std::string range;             // of Range, which httplib is not shown
  std::string accept_encoding;   // moved here so that httplib compresses nothing by itself
  std::string content_encoding;  // likewise for inflating
  int status = 0;
  std::uint64_t declared_bytes = 0;  // of the body, by Content-Length
  std::uint64_t sent_before = 0;     // by the connection, to earlier requests
  bool body_expected = false;        // the request announces a body
  bool body_consumed = false;        // and it was read to its end
  bool close = false;                // the connection cannot serve another request
  // The call goes on without a thread. What the handler has answered until then is only kept headers of, unless
  // the call has begun to send by itself.
  std::shared_ptr<SuspendedCall> suspended;
  bool silent = false;   // nothing of the answer is sent yet
  bool resumed = false;  // it goes on: `suspended` makes the answer
  httplib::Headers kept_headers;
  std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
};

}  // namespace symcell::server
