#include "server/http/connection.hpp"

#include <arpa/inet.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace symcell::server {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

void describe(const sockaddr_storage& address, socklen_t length, std::string& ip, int& port) {
  std::array<char, NI_MAXHOST> host{};
  std::array<char, NI_MAXSERV> service{};
  if (::getnameinfo(reinterpret_cast<const sockaddr*>(&address), length, host.data(), host.size(),
                    service.data(), service.size(), NI_NUMERICHOST | NI_NUMERICSERV) != 0) {
    return;
  }
  ip = host.data();
  port = std::atoi(service.data());
}

// 1: an event; 0: time is up; -1: error.
int poll_one(int descriptor, short events, milliseconds timeout) {
  pollfd entry{descriptor, events, 0};
  while (true) {
    const int n = ::poll(&entry, 1, static_cast<int>(timeout.count()));
    if (n >= 0 || errno != EINTR) return n;
  }
}

}  // namespace

ConnectionStream::ConnectionStream(socket_t socket,
                                   const StopSignal& stop,
                                   const ConnectionLimits& limits)
    : socket_(socket), stop_(stop), limits_(limits) {
}

void ConnectionStream::begin_request() {
  buffer_.erase(0, begin_);
  begin_ = 0;
  head_left_ = 0;
  guard_.reset();
  read_ = 0;
  written_ = 0;
  read_wait_ = {};
  write_wait_ = {};
}

ConnectionStream::Wait ConnectionStream::wait_readable(milliseconds timeout) const {
  std::array<pollfd, 2> entries{pollfd{socket_, POLLIN, 0}, pollfd{stop_.descriptor(), POLLIN, 0}};
  const int n = ::poll(entries.data(), entries.size(), static_cast<int>(timeout.count()));
  if (n == 0 || (n < 0 && errno == EINTR)) return Wait::kTimeout;
  if (n < 0 || entries[1].revents != 0) return Wait::kFailed;
  return Wait::kReady;
}

bool ConnectionStream::wait_within_limits(short events,
                                          std::uint64_t bytes,
                                          std::chrono::nanoseconds& waited) const {
  const milliseconds granted =
      limits_.patience + milliseconds(bytes * 1000 / limits_.min_bytes_per_second);
  const auto start = Clock::now();
  const auto deadline =
      start +
      std::min(limits_.io_timeout, std::chrono::duration_cast<milliseconds>(granted - waited));
  bool ready = false;
  while (!ready) {
    const bool stopping = stop_.raised();
    const auto limit = stopping ? std::min(deadline, stop_.give_up_at()) : deadline;
    const auto left = std::chrono::ceil<milliseconds>(limit - Clock::now());
    if (left.count() <= 0) break;
    // The stop signal wakes us once; from then on only its deadline matters.
    std::array<pollfd, 2> entries{pollfd{socket_, events, 0},
                                  pollfd{stopping ? -1 : stop_.descriptor(), POLLIN, 0}};
    if (::poll(entries.data(), entries.size(), static_cast<int>(left.count())) < 0) {
      if (errno != EINTR) break;
      continue;
    }
    ready = entries[0].revents != 0;
  }
  waited += Clock::now() - start;
  return ready;
}

bool ConnectionStream::is_readable() const {
  return begin_ < buffer_.size() || poll_one(socket_, POLLIN, milliseconds(0)) > 0;
}

bool ConnectionStream::is_writable() const {
  pollfd entry{socket_, POLLOUT, 0};
  if (::poll(&entry, 1, 0) <= 0) return false;
  return (entry.revents & (POLLERR | POLLHUP)) == 0;
}

bool ConnectionStream::receive_more() {
  if (!wait_within_limits(POLLIN, read_, read_wait_)) return false;
  std::array<char, 16384> piece;
  const ssize_t n = ::recv(socket_, piece.data(), piece.size(), 0);
  if (n <= 0) return false;
  if (begin_ == buffer_.size()) {
    buffer_.clear();
    begin_ = 0;
  }
  buffer_.append(piece.data(), static_cast<std::size_t>(n));
  read_ += static_cast<std::uint64_t>(n);
  return true;
}

ConnectionStream::Head ConnectionStream::read_head(HeadReader& reader) {
  while (!reader.add(std::string_view(buffer_).substr(begin_))) {
    if (buffer_.size() - begin_ >= limits_.max_header_bytes) return Head::kTooLong;
    if (!receive_more()) return Head::kGone;
  }
  if (reader.fault().status != 0) return Head::kFaulty;
  if (reader.length() > limits_.max_header_bytes) return Head::kTooLong;
  head_left_ = reader.length();
  // Empty lines before a request: httplib takes them for one.
  while (buffer_.compare(begin_, 2, "\r\n") == 0) {
    begin_ += 2;
    head_left_ -= 2;
  }
  if (reader.head().chunked) guard_.emplace();
  return Head::kWhole;
}

ssize_t ConnectionStream::read(char* ptr, size_t size) {
  if (begin_ == buffer_.size() && !receive_more()) return -1;
  const std::size_t most = head_left_ > 0 ? std::min(size, head_left_) : size;
  const std::size_t n = std::min(most, buffer_.size() - begin_);
  std::memcpy(ptr, buffer_.data() + begin_, n);
  if (head_left_ > 0) {
    head_left_ -= n;
  } else if (guard_ && !guard_->pass({ptr, n})) {
    return -1;
  }
  begin_ += n;
  return static_cast<ssize_t>(n);
}

ssize_t ConnectionStream::write(const char* ptr, size_t size) {
  // A client that always keeps pace never waits: look here too.
  if (stop_.raised() && Clock::now() > stop_.give_up_at()) return -1;
  while (true) {
    const ssize_t n = ::send(socket_, ptr, size, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (n >= 0) {
      written_ += static_cast<std::uint64_t>(n);
      return n;
    }
    if (errno == EINTR) continue;
    if (errno != EAGAIN && errno != EWOULDBLOCK) return -1;
    if (!wait_within_limits(POLLOUT, written_, write_wait_)) return -1;
  }
}

void ConnectionStream::get_remote_ip_and_port(std::string& ip, int& port) const {
  sockaddr_storage address{};
  socklen_t length = sizeof(address);
  if (::getpeername(socket_, reinterpret_cast<sockaddr*>(&address), &length) == 0) {
    describe(address, length, ip, port);
  }
}

void ConnectionStream::get_local_ip_and_port(std::string& ip, int& port) const {
  sockaddr_storage address{};
  socklen_t length = sizeof(address);
  if (::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &length) == 0) {
    describe(address, length, ip, port);
  }
}

void ConnectionStream::discard_arrived() {
  ::shutdown(socket_, SHUT_WR);
  std::array<char, 16384> piece;
  static_cast<void>(::recv(socket_, piece.data(), piece.size(), MSG_DONTWAIT));
}

void ConnectionStream::close_gently() {
  // Many clients send all of a body before they look for an answer. One that keeps sending at a good
  // pace is heard out, for some time; who trickles is not.
  constexpr std::size_t kMostBytes = std::size_t{4} << 30U;
  constexpr milliseconds kPatience{2000};
  constexpr milliseconds kMostTime{30'000};
  constexpr std::size_t kBytesPerMillisecond = 8192;
  const auto start = Clock::now();
  ::shutdown(socket_, SHUT_WR);
  std::array<char, 65536> piece;
  for (std::size_t total = 0; total < kMostBytes;) {
    const milliseconds granted = kPatience + milliseconds(total / kBytesPerMillisecond);
    const auto deadline = start + std::min(granted, kMostTime);
    const auto left = std::chrono::duration_cast<milliseconds>(deadline - Clock::now());
    if (left.count() <= 0 || wait_readable(left) != Wait::kReady) return;
    const ssize_t n = ::recv(socket_, piece.data(), piece.size(), 0);
    if (n <= 0) return;
    total += static_cast<std::size_t>(n);
  }
}

}  // namespace symcell::server
