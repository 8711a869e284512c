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
  in_header_ = true;
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
  return begin_ < end_ || poll_one(socket_, POLLIN, milliseconds(0)) > 0;
}

bool ConnectionStream::is_writable() const {
  pollfd entry{socket_, POLLOUT, 0};
  if (::poll(&entry, 1, 0) <= 0) return false;
  return (entry.revents & (POLLERR | POLLHUP)) == 0;
}

ssize_t ConnectionStream::read(char* ptr, size_t size) {
  if (in_header_ && read_ >= limits_.max_header_bytes) return -1;
  if (begin_ == end_) {
    if (!wait_within_limits(POLLIN, read_, read_wait_)) return -1;
    const ssize_t n = ::recv(socket_, buffer_.data(), buffer_.size(), 0);
    if (n <= 0) return n;
    begin_ = 0;
    end_ = static_cast<std::size_t>(n);
  }
  const std::size_t n = std::min(size, end_ - begin_);
  std::memcpy(ptr, buffer_.data() + begin_, n);
  begin_ += n;
  read_ += n;
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
  static_cast<void>(::recv(socket_, buffer_.data(), buffer_.size(), MSG_DONTWAIT));
}

void ConnectionStream::close_gently() {
  constexpr std::size_t kMostBytes = 64UL << 20U;
  const auto deadline = Clock::now() + std::chrono::seconds(2);
  ::shutdown(socket_, SHUT_WR);
  for (std::size_t total = 0; total < kMostBytes;) {
    const auto left = std::chrono::duration_cast<milliseconds>(deadline - Clock::now());
    if (left.count() <= 0 || wait_readable(left) != Wait::kReady) return;
    const ssize_t n = ::recv(socket_, buffer_.data(), buffer_.size(), 0);
    if (n <= 0) return;
    total += static_cast<std::size_t>(n);
  }
}

}  // namespace symcell::server
