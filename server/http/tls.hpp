// TLS for accepted connections, by OpenSSL: a certificate and a key from files, which may be read
// again while connections stand.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <mutex>

struct ssl_st;
struct ssl_ctx_st;

namespace symcell::server {

struct TlsFiles {
  std::filesystem::path certificate;  // PEM, with the chain; empty: no TLS
  std::filesystem::path key;
};

// One connection's. Reads and writes like a socket that does not wait: -1 with errno EAGAIN where it
// would have to. One thread at a time.
class TlsSession {
 public:
  TlsSession(std::shared_ptr<ssl_ctx_st> context, int socket);
  ~TlsSession();
  TlsSession(const TlsSession&) = delete;
  TlsSession& operator=(const TlsSession&) = delete;

  // 0: the peer has ended the session, or broken its rules.
  [[nodiscard]] ssize_t receive(char* bytes, std::size_t size);
  [[nodiscard]] ssize_t send(const char* bytes, std::size_t size);
  // Bytes that have come and were decrypted, which no look at the socket shows.
  [[nodiscard]] bool pending() const;
  // Says goodbye.
  void close();

 private:
  std::shared_ptr<ssl_ctx_st> context_;
  ssl_st* ssl_;
  bool broken_ = false;
};

class TlsContext {
 public:
  // Throws std::runtime_error where the files are no certificate and its key.
  explicit TlsContext(TlsFiles files);

  // Reads the files again; throws and keeps what it has where they are no good.
  void reload();
  [[nodiscard]] std::unique_ptr<TlsSession> accept(int socket) const;

 private:
  const TlsFiles files_;
  mutable std::mutex mutex_;  // guards context_
  std::shared_ptr<ssl_ctx_st> context_;
};

}  // namespace symcell::server
