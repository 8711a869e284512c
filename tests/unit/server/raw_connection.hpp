// A socket for requests that no well-behaved client sends.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace symcell::server::test {

class RawConnection {
 public:
  // `patience`: how long receiving waits for more.
  explicit RawConnection(int port, std::chrono::milliseconds patience = std::chrono::seconds(10));
  ~RawConnection();
  RawConnection(const RawConnection&) = delete;
  RawConnection& operator=(const RawConnection&) = delete;

  // False: the server has closed.
  bool send(std::string_view bytes);
  // As a client does that has nothing more to say.
  void close_sending();
  // What comes until `end` has come, the server closes, or nothing comes for the patience.
  [[nodiscard]] std::string receive_until(std::string_view end);
  [[nodiscard]] std::string receive_all() { return receive_until(""); }

 private:
  int socket_;
};

}  // namespace symcell::server::test
