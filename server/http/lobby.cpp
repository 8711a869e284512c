#include "server/http/lobby.hpp"

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <stdexcept>
#include <thread>
#include <utility>

namespace symcell::server {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kTick{250};  // how exact deadlines are
constexpr int kMostAccepted = 64;   // at a time, before others are looked after
constexpr std::size_t kPieceBytes = 16384;
// A client that keeps sending after its answer is heard out if it sends at this pace at least.
constexpr milliseconds kFarewellPatience{2000};
constexpr std::uint64_t kFarewellBytesPerMillisecond = 8192;
// What is read of one connection before the others have their turn.
constexpr std::size_t kFarewellTurnBytes = std::size_t{1} << 20U;

std::string address_of(const sockaddr_storage& address, socklen_t length) {
  std::array<char, NI_MAXHOST> host{};
  if (::getnameinfo(reinterpret_cast<const sockaddr*>(&address), length, host.data(), host.size(),
                    nullptr, 0, NI_NUMERICHOST) != 0) {
    return {};
  }
  return host.data();
}

}  // namespace

Connection::Connection(int socket,
                       std::string client,
                       Lobby& lobby,
                       std::unique_ptr<TlsSession> tls)
    : socket_(socket), client_(std::move(client)), lobby_(lobby), tls_(std::move(tls)) {
}

ssize_t Connection::receive(char* into, std::size_t size) {
  return tls_ ? tls_->receive(into, size) : ::recv(socket_, into, size, MSG_DONTWAIT);
}

ssize_t Connection::send(const char* from, std::size_t size) {
  const ssize_t sent =
      tls_ ? tls_->send(from, size) : ::send(socket_, from, size, MSG_NOSIGNAL | MSG_DONTWAIT);
  if (sent > 0) sent_ += static_cast<std::uint64_t>(sent);
  return sent;
}

Connection::~Connection() {
  ::close(socket_);
  --lobby_.open_;
  const std::lock_guard lock(lobby_.mutex_);
  const auto count = lobby_.clients_.find(client_);
  if (count != lobby_.clients_.end() && --count->second == 0) lobby_.clients_.erase(count);
}

Lobby::Lobby(const LobbyLimits& limits, Taker take, Refusal refusal, const TlsContext* tls)
    : limits_(limits),
      take_(std::move(take)),
      refusal_(std::move(refusal)),
      tls_(tls),
      epoll_(::epoll_create1(EPOLL_CLOEXEC)),
      wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (epoll_ < 0 || wake_ < 0) throw std::runtime_error("cannot wait for connections");
  epoll_event event{EPOLLIN, {.fd = wake_}};
  ::epoll_ctl(epoll_, EPOLL_CTL_ADD, wake_, &event);
}

Lobby::~Lobby() {
  here_.clear();
  returned_.clear();
  leaving_.clear();
  ::close(wake_);
  ::close(epoll_);
}

void Lobby::wake() const {
  const std::uint64_t one = 1;
  // Can only fail when the counter is full, and then it is readable anyhow.
  static_cast<void>(::write(wake_, &one, sizeof one) == sizeof one);
}

void Lobby::stop() {
  stopping_ = true;
  wake();
}

void Lobby::give_back(Held connection) {
  {
    const std::lock_guard lock(mutex_);
    returned_.push_back(std::move(connection));
  }
  wake();
}

void Lobby::let_go(Held connection) {
  {
    const std::lock_guard lock(mutex_);
    leaving_.push_back(std::move(connection));
  }
  wake();
}

void Lobby::run(int listening) {
  listening_ = listening;
  epoll_event event{EPOLLIN, {.fd = listening}};
  ::epoll_ctl(epoll_, EPOLL_CTL_ADD, listening, &event);
  while (!stopping_) step(kTick);
  std::erase_if(here_, [](const auto& entry) { return entry.second->phase_ != Phase::kFarewell; });
}

void Lobby::finish(milliseconds patience) {
  const auto deadline = Clock::now() + patience;
  take_returned();
  while (!here_.empty() && Clock::now() < deadline) step(kTick);
  here_.clear();
}

void Lobby::step(milliseconds patience) {
  std::array<epoll_event, 128> events{};
  const int count = ::epoll_wait(epoll_, events.data(), static_cast<int>(events.size()),
                                 static_cast<int>(patience.count()));
  for (int i = 0; i < count; ++i) {
    const int descriptor = events[static_cast<std::size_t>(i)].data.fd;
    if (descriptor == wake_) {
      std::uint64_t ignored = 0;
      static_cast<void>(::read(wake_, &ignored, sizeof ignored) == sizeof ignored);
      take_returned();
    } else if (descriptor == listening_) {
      if (!stopping_) accept_some();
    } else if (const auto found = here_.find(descriptor); found != here_.end()) {
      hear(Held(found->second));
    }
  }
  if (Clock::now() - looked_ >= kTick) end_overdue();
}

void Lobby::accept_some() {
  for (int i = 0; i < kMostAccepted; ++i) {
    sockaddr_storage address{};
    socklen_t length = sizeof address;
    const int socket = ::accept4(listening_, reinterpret_cast<sockaddr*>(&address), &length,
                                 SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (socket >= 0) {
      admit(socket, address_of(address, length));
      continue;
    }
    if (errno == EMFILE || errno == ENFILE || errno == ENOBUFS || errno == ENOMEM) {
      // It stays in the kernel's queue until somebody leaves; asking at once again would spin.
      if (!make_room()) std::this_thread::sleep_for(milliseconds(20));
    }
    return;
  }
}

void Lobby::admit(int socket, const std::string& client) {
  const int yes = 1;
  ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  std::size_t of_client = 0;
  {
    const std::lock_guard lock(mutex_);
    const auto found = clients_.find(client);
    of_client = found == clients_.end() ? 0 : found->second;
  }
  const bool room = open_ < limits_.connections || make_room();
  if (!room || of_client >= limits_.connections_per_client) {
    turn_away(socket);
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    ++clients_[client];
  }
  ++open_;
  auto connection =
      std::make_shared<Connection>(socket, client, *this, tls_ ? tls_->accept(socket) : nullptr);
  enter(connection, Phase::kIdle);
  watch(connection);
}

// One short write into the socket's empty buffer: never waits.
void Lobby::turn_away(int socket) {
  ++refused_;
  // Within TLS there is no time for an answer.
  const std::string answer = tls_ ? std::string() : refusal_();
  static_cast<void>(::send(socket, answer.data(), answer.size(), MSG_NOSIGNAL | MSG_DONTWAIT));
  ::shutdown(socket, SHUT_WR);
  std::array<char, kPieceBytes> piece;
  static_cast<void>(::recv(socket, piece.data(), piece.size(), MSG_DONTWAIT));
  ::close(socket);
}

bool Lobby::make_room() {
  const Held* oldest = nullptr;
  for (const auto& [socket, connection] : here_) {
    if (connection->phase_ != Phase::kIdle || connection->served == 0) continue;
    if (oldest == nullptr || connection->since_ < (*oldest)->since_) oldest = &connection;
  }
  if (oldest == nullptr) return false;
  unwatch(Held(*oldest));
  return true;
}

void Lobby::watch(const Held& connection) {
  here_[connection->socket()] = connection;
  epoll_event event{EPOLLIN, {.fd = connection->socket()}};
  ::epoll_ctl(epoll_, EPOLL_CTL_ADD, connection->socket(), &event);
}

void Lobby::unwatch(const Held& connection) {
  ::epoll_ctl(epoll_, EPOLL_CTL_DEL, connection->socket(), nullptr);
  here_.erase(connection->socket());
}

void Lobby::enter(const Held& connection, Phase phase) {
  connection->phase_ = phase;
  connection->since_ = Clock::now();
  milliseconds patience = limits_.idle;
  if (phase == Phase::kHead) patience = limits_.head;
  if (phase == Phase::kFarewell) patience = kFarewellPatience;
  if (phase == Phase::kBody) {
    patience = limits_.head + milliseconds(connection->head.head().content_length * 1000 /
                                           limits_.body_bytes_per_second);
  }
  connection->deadline_ = connection->since_ + patience;
}

void Lobby::take_returned() {
  std::vector<Held> returned;
  std::vector<Held> leaving;
  {
    const std::lock_guard lock(mutex_);
    returned.swap(returned_);
    leaving.swap(leaving_);
  }
  for (const Held& connection : leaving) {
    if (connection->tls_) connection->tls_->close();
    ::shutdown(connection->socket(), SHUT_WR);
    connection->bytes = {};
    enter(connection, Phase::kFarewell);
    watch(connection);
  }
  for (const Held& connection : returned) {
    if (stopping_) continue;
    connection->head = {};
    enter(connection, Phase::kIdle);
    watch(connection);
    // The next request may have come with the last one.
    if (!connection->bytes.empty()) advance(connection);
  }
}

void Lobby::hear(const Held& connection) {
  std::array<char, kPieceBytes> piece;
  std::size_t heard = 0;
  bool ended = false;
  while (true) {
    const ssize_t got = connection->phase_ == Phase::kFarewell
                            ? ::recv(connection->socket(), piece.data(), piece.size(), MSG_DONTWAIT)
                            : connection->receive(piece.data(), piece.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) break;
    ended = got <= 0;
    if (ended) break;
    heard += static_cast<std::size_t>(got);
    if (connection->phase_ == Phase::kFarewell) {
      if (heard >= kFarewellTurnBytes) break;
      continue;
    }
    connection->bytes.append(piece.data(), static_cast<std::size_t>(got));
    // What TLS holds back would wake nobody.
    if (heard >= limits_.head_bytes && !connection->pending()) break;
  }
  if (connection->phase_ != Phase::kFarewell) {
    if (heard > 0) advance(connection);
    // A client may close its side once it has asked; what it asked is answered first.
    const auto found = here_.find(connection->socket());
    if (ended && found != here_.end() && found->second == connection) unwatch(connection);
    return;
  }
  if (ended) {
    unwatch(connection);
    return;
  }
  connection->heard_ += heard;
  const milliseconds granted =
      kFarewellPatience + milliseconds(connection->heard_ / kFarewellBytesPerMillisecond);
  connection->deadline_ = connection->since_ + std::min(granted, limits_.farewell);
}

void Lobby::advance(const Held& connection) {
  if (connection->phase_ == Phase::kIdle) enter(connection, Phase::kHead);
  if (connection->phase_ == Phase::kHead) {
    const bool whole = connection->head.add(connection->bytes);
    connection->too_long = !whole && connection->bytes.size() >= limits_.head_bytes;
    if (whole && connection->head.fault().status == 0) {
      connection->too_long = connection->head.length() > limits_.head_bytes;
    }
    if (!whole && !connection->too_long) return;
    if (connection->too_long || connection->head.fault().status != 0) {
      hand_over(connection);
      return;
    }
    enter(connection, Phase::kBody);
  }
  const RequestHead& head = connection->head.head();
  const bool waits = !head.expects_continue && head.content_length <= limits_.body_bytes &&
                     connection->bytes.size() < connection->head.length() + head.content_length;
  if (!waits) hand_over(connection);
}

void Lobby::hand_over(const Held& connection) {
  unwatch(connection);
  if (take_(connection)) return;
  ++refused_;
  const std::string answer = refusal_();
  static_cast<void>(
      ::send(connection->socket(), answer.data(), answer.size(), MSG_NOSIGNAL | MSG_DONTWAIT));
  ::shutdown(connection->socket(), SHUT_WR);
  enter(connection, Phase::kFarewell);
  watch(connection);
}

void Lobby::end_overdue() {
  looked_ = Clock::now();
  std::vector<Held> overdue;
  for (const auto& [socket, connection] : here_) {
    if (connection->deadline_ < looked_) overdue.push_back(connection);
  }
  for (const Held& connection : overdue) unwatch(connection);
}

}  // namespace symcell::server
