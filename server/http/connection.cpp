#include "server/http/connection.hpp"

#include <arpa/inet.h>
#include <linux/sockios.h>
#include <netdb.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <string_view>

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
  const std::string_view number = service.data();
  std::from_chars(number.data(), number.data() + number.size(), port);
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

ConnectionStream::ConnectionStream(Connection& connection,
                                   const StopSignal& stop,
                                   const ConnectionLimits& limits)
    : connection_(connection),
      socket_(connection.socket()),
      stop_(stop),
      limits_(limits),
      buffer_(connection.bytes),
      head_left_(connection.head.length()) {
  // Empty lines before a request: httplib takes them for one.
  while (buffer_.compare(begin_, 2, "\r\n") == 0 && head_left_ > 2) {
    begin_ += 2;
    head_left_ -= 2;
  }
  const RequestHead& head = connection.head.head();
  std::size_t erased = 0;
  for (const auto& [at, length] : head.range_lines) {
    buffer_.erase(at - erased, length);
    erased += length;
  }
  head_left_ -= erased;
  if (head.chunked) guard_.emplace();
}

ConnectionStream::~ConnectionStream() {
  buffer_.erase(0, begin_);
}

std::uint64_t ConnectionStream::progress(short events) const {
  if (events == POLLIN) return read_;
  int unsent = 0;
  if (::ioctl(socket_, SIOCOUTQ, &unsent) != 0 || unsent < 0) return written_;
  return written_ - std::min(written_, static_cast<std::uint64_t>(unsent));
}

bool ConnectionStream::wait_within_limits(short events, Pace& pace) const {
  constexpr milliseconds kSlice{1000};
  const std::uint64_t wanted =
      static_cast<std::uint64_t>(limits_.window.count()) * limits_.min_bytes_per_second / 1000;
  while (true) {
    const bool stopping = stop_.raised();
    const auto start = Clock::now();
    auto patience = std::min(kSlice, limits_.window);
    if (stopping) {
      const auto left = std::chrono::ceil<milliseconds>(stop_.give_up_at() - start);
      patience = std::min(patience, left);
    }
    if (patience.count() <= 0) return false;
    // The stop signal wakes us once; from then on only its deadline matters.
    std::array<pollfd, 2> entries{pollfd{socket_, events, 0},
                                  pollfd{stopping ? -1 : stop_.descriptor(), POLLIN, 0}};
    const int n = ::poll(entries.data(), entries.size(), static_cast<int>(patience.count()));
    if (n < 0 && errno != EINTR) return false;
    pace.waited += Clock::now() - start;
    if (n > 0 && entries[0].revents != 0) return true;
    if (pace.waited < limits_.window) continue;
    const std::uint64_t bytes = progress(events);
    if (bytes - pace.mark < wanted) return false;
    pace = {std::chrono::nanoseconds(0), bytes};
  }
}

bool ConnectionStream::is_readable() const {
  return begin_ < buffer_.size() || connection_.pending() ||
         poll_one(socket_, POLLIN, milliseconds(0)) > 0;
}

bool ConnectionStream::is_writable() const {
  pollfd entry{socket_, POLLOUT, 0};
  if (::poll(&entry, 1, 0) <= 0) return false;
  return (entry.revents & (POLLERR | POLLHUP)) == 0;
}

bool ConnectionStream::receive_more() {
  std::array<char, 16384> piece;
  while (true) {
    const ssize_t n = connection_.receive(piece.data(), piece.size());
    if (n > 0) {
      buffer_.assign(piece.data(), static_cast<std::size_t>(n));
      begin_ = 0;
      read_ += static_cast<std::uint64_t>(n);
      return true;
    }
    if (n == 0) return false;
    if (errno == EINTR) continue;
    if (errno != EAGAIN && errno != EWOULDBLOCK) return false;
    if (!wait_within_limits(POLLIN, reading_)) return false;
  }
}

bool ConnectionStream::skip_trailer() {
  while (guard_->in_trailer()) {
    if (begin_ == buffer_.size() && !receive_more()) return false;
    if (!guard_->pass({buffer_.data() + begin_, 1})) return false;
    ++begin_;
  }
  return true;
}

ssize_t ConnectionStream::read(char* ptr, size_t size) {
  if (head_left_ == 0 && guard_ && guard_->in_trailer()) {
    if (!skip_trailer()) return -1;
    stand_in_ = "\r\n";
  }
  if (!stand_in_.empty()) {
    const std::size_t n = stand_in_.copy(ptr, size);
    stand_in_.remove_prefix(n);
    return static_cast<ssize_t>(n);
  }
  if (begin_ == buffer_.size() && !receive_more()) return -1;
  std::size_t most = size;
  if (head_left_ > 0) {
    most = std::min(most, head_left_);
  } else if (guard_) {
    most = std::min(most, guard_->most());
  }
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
  if (silent_ != nullptr && *silent_) return static_cast<ssize_t>(size);
  // A client that always keeps pace never waits: look here too.
  if (stop_.raised() && Clock::now() > stop_.give_up_at()) return -1;
  while (true) {
    const ssize_t n = connection_.send(ptr, size);
    if (n >= 0) {
      written_ += static_cast<std::uint64_t>(n);
      return n;
    }
    if (errno == EINTR) continue;
    if (errno != EAGAIN && errno != EWOULDBLOCK) return -1;
    if (!wait_within_limits(POLLOUT, writing_)) return -1;
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

}  // namespace symcell::server
