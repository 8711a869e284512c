// Where connections wait without a thread: for a request, for the rest of its head and, if that is
// small, for the rest of its body. One thread looks after all of them, so that thousands of idle or
// slow clients cost some memory and nobody's time.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

#include "server/http/request_head.hpp"
#include "server/http/tls.hpp"

namespace symcell::server {

struct LobbyLimits {
  std::size_t connections = 4096;             // in all, those being served included
  std::size_t connections_per_client = 1024;  // by address; a proxy is one client
  std::size_t head_bytes = 64UL * 1024;
  std::size_t body_bytes = 64UL * 1024;        // a body up to this is waited for here
  std::chrono::milliseconds idle{15'000};      // between two requests
  std::chrono::milliseconds head{20'000};      // from its first byte to its last
  std::size_t body_bytes_per_second = 1024;    // at least, after as long as for a head
  std::chrono::milliseconds farewell{30'000};  // most that a client is heard out, see let_go
};

class Lobby;

// An accepted connection, while it waits and while it is served. Closes its socket.
class Connection {
 public:
  Connection(int socket,
             std::string client,
             Lobby& lobby,
             std::unique_ptr<TlsSession> tls = nullptr);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  [[nodiscard]] int socket() const { return socket_; }
  [[nodiscard]] const std::string& client() const { return client_; }
  // As recv() and send() with MSG_DONTWAIT and MSG_NOSIGNAL, through TLS where there is some.
  [[nodiscard]] ssize_t receive(char* bytes, std::size_t size);
  [[nodiscard]] ssize_t send(const char* bytes, std::size_t size);
  [[nodiscard]] std::uint64_t sent() const { return sent_; }  // bytes so far, without those of TLS
  [[nodiscard]] bool pending() const { return tls_ && tls_->pending(); }

  std::string bytes;       // that came and were not taken yet
  HeadReader head;         // of the request that begins with them
  bool too_long = false;   // the head is longer than any may be
  std::size_t served = 0;  // requests so far

 private:
  friend class Lobby;
  using Clock = std::chrono::steady_clock;
  enum class Phase : std::uint8_t { kIdle, kHead, kBody, kFarewell };

  int socket_;
  std::string client_;
  Lobby& lobby_;
  std::unique_ptr<TlsSession> tls_;
  std::uint64_t sent_ = 0;
  Phase phase_ = Phase::kIdle;
  Clock::time_point since_ = Clock::now();  // of the phase
  Clock::time_point deadline_{};
  std::uint64_t heard_ = 0;  // bytes of the farewell
};

class Lobby {
 public:
  using Taker = std::function<bool(const std::shared_ptr<Connection>&)>;
  using Refusal = std::function<std::string()>;

  // `take`: is given every connection whose request has come so far that a thread can go on with it,
  // or has a faulty head; false: nobody is free for it. `refusal`: the answer that whoever is turned
  // away gets.
  // `tls`: for all connections; null: none.
  Lobby(const LobbyLimits& limits, Taker take, Refusal refusal, const TlsContext* tls);
  ~Lobby();
  Lobby(const Lobby&) = delete;
  Lobby& operator=(const Lobby&) = delete;

  // Accepts and looks after connections until stop().
  void run(int listening);
  // After run() has returned and nothing is served any more: hears those out that were answered
  // last.
  void finish(std::chrono::milliseconds patience);
  void stop();

  // A connection that was served: waits for the next request.
  void give_back(std::shared_ptr<Connection> connection);
  // One that was served and shall end. What it still sends is read away for a while: closing with
  // unread data would destroy the answer on its way.
  void let_go(std::shared_ptr<Connection> connection);

  [[nodiscard]] std::size_t open() const { return open_; }
  [[nodiscard]] std::uint64_t refused() const { return refused_; }

 private:
  friend class Connection;
  using Clock = std::chrono::steady_clock;
  using Phase = Connection::Phase;
  using Held = std::shared_ptr<Connection>;

  void step(std::chrono::milliseconds patience);
  void accept_some();
  void admit(int socket, const std::string& client);
  void take_returned();
  void hear(const Held& connection);
  // Goes on with what has come; may hand the connection over.
  void advance(const Held& connection);
  void hand_over(const Held& connection);
  void enter(const Held& connection, Phase phase);
  void turn_away(int socket);
  void watch(const Held& connection);
  void unwatch(const Held& connection);
  void end_overdue();
  void wake() const;
  // Closes the connection that waits longest for a request; false: none does.
  bool make_room();

  const LobbyLimits limits_;
  const Taker take_;
  const Refusal refusal_;
  const TlsContext* const tls_;
  int epoll_;
  int wake_;
  int listening_ = -1;
  std::atomic<bool> stopping_{false};
  std::atomic<std::size_t> open_{0};
  std::atomic<std::uint64_t> refused_{0};

  std::mutex mutex_;                            // guards clients_, returned_ and leaving_
  std::map<std::string, std::size_t> clients_;  // connections of each
  std::vector<Held> returned_;
  std::vector<Held> leaving_;

  std::unordered_map<int, Held> here_;  // by socket; the run() thread's
  Clock::time_point looked_ = Clock::now();
};

}  // namespace symcell::server
