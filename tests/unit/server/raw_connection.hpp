// A socket for requests that no well-behaved client sends.
#pragma once

#include <string>
#include <string_view>

namespace symcell::server::test {

class RawConnection {
 public:
  explicit RawConnection(int port);
  ~RawConnection();
  RawConnection(const RawConnection&) = delete;
  RawConnection& operator=(const RawConnection&) = delete;

  // False: the server has closed.
  bool send(std::string_view bytes);
  // What comes until `end` has come, the server closes, or ten seconds have passed.
  [[nodiscard]] std::string receive_until(std::string_view end);
  [[nodiscard]] std::string receive_all() { return receive_until(""); }

 private:
  int socket_;
};

}  // namespace symcell::server::test
