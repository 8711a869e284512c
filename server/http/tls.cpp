#include "server/http/tls.hpp"

#include <openssl/err.h>
#include <openssl/ssl.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>
#include <stdexcept>
#include <string>
#include <utility>

namespace symcell::server {
namespace {

std::string last_error() {
  std::array<char, 256> text{};
  ::ERR_error_string_n(::ERR_get_error(), text.data(), text.size());
  return text.data();
}

std::shared_ptr<SSL_CTX> read_context(const TlsFiles& files) {
  ::ERR_clear_error();
  std::shared_ptr<SSL_CTX> context(::SSL_CTX_new(::TLS_server_method()), ::SSL_CTX_free);
  if (!context) throw std::runtime_error("OpenSSL cannot start: " + last_error());
  ::SSL_CTX_set_min_proto_version(context.get(), TLS1_2_VERSION);
  ::SSL_CTX_set_options(context.get(), SSL_OP_NO_RENEGOTIATION | SSL_OP_CIPHER_SERVER_PREFERENCE |
                                           SSL_OP_NO_COMPRESSION);
  ::SSL_CTX_set_mode(context.get(), SSL_MODE_ENABLE_PARTIAL_WRITE |
                                        SSL_MODE_ACCEPT_MOVING_WRITE_BUFFER |
                                        SSL_MODE_RELEASE_BUFFERS);
  // Resumption is by tickets: nothing is kept of a connection that has ended.
  ::SSL_CTX_set_session_cache_mode(context.get(), SSL_SESS_CACHE_OFF);
  if (::SSL_CTX_use_certificate_chain_file(context.get(), files.certificate.c_str()) != 1) {
    throw std::runtime_error("no certificate in " + files.certificate.string() + ": " +
                             last_error());
  }
  if (::SSL_CTX_use_PrivateKey_file(context.get(), files.key.c_str(), SSL_FILETYPE_PEM) != 1) {
    throw std::runtime_error("no private key in " + files.key.string() + ": " + last_error());
  }
  if (::SSL_CTX_check_private_key(context.get()) != 1) {
    throw std::runtime_error(files.key.string() + " is not the key of " +
                             files.certificate.string());
  }
  return context;
}

int clamped(std::size_t size) {
  return static_cast<int>(std::min<std::size_t>(size, INT_MAX));
}

}  // namespace

TlsSession::TlsSession(std::shared_ptr<SSL_CTX> context, int socket)
    : context_(std::move(context)), ssl_(::SSL_new(context_.get())) {
  if (ssl_ == nullptr || ::SSL_set_fd(ssl_, socket) != 1) {
    ::SSL_free(ssl_);
    throw std::runtime_error("OpenSSL takes no connection: " + last_error());
  }
  ::SSL_set_accept_state(ssl_);
}

TlsSession::~TlsSession() {
  ::SSL_free(ssl_);
}

ssize_t TlsSession::receive(char* bytes, std::size_t size) {
  if (broken_) return 0;
  ::ERR_clear_error();
  const int n = ::SSL_read(ssl_, bytes, clamped(size));
  if (n > 0) return n;
  switch (::SSL_get_error(ssl_, n)) {
    case SSL_ERROR_WANT_READ:
    case SSL_ERROR_WANT_WRITE: errno = EAGAIN; return -1;
    case SSL_ERROR_ZERO_RETURN: return 0;
    default: broken_ = true; return 0;
  }
}

ssize_t TlsSession::send(const char* bytes, std::size_t size) {
  if (broken_) {
    errno = EPIPE;
    return -1;
  }
  ::ERR_clear_error();
  const int n = ::SSL_write(ssl_, bytes, clamped(size));
  if (n > 0) return n;
  switch (::SSL_get_error(ssl_, n)) {
    case SSL_ERROR_WANT_READ:
    case SSL_ERROR_WANT_WRITE: errno = EAGAIN; return -1;
    default:
      broken_ = true;
      errno = EPIPE;
      return -1;
  }
}

bool TlsSession::pending() const {
  return ::SSL_pending(ssl_) > 0;
}

void TlsSession::close() {
  if (broken_ || ::SSL_is_init_finished(ssl_) == 0) return;
  ::ERR_clear_error();
  ::SSL_shutdown(ssl_);
}

TlsContext::TlsContext(TlsFiles files) : files_(std::move(files)), context_(read_context(files_)) {
}

void TlsContext::reload() {
  auto context = read_context(files_);
  const std::lock_guard lock(mutex_);
  context_ = std::move(context);
}

std::unique_ptr<TlsSession> TlsContext::accept(int socket) const {
  std::shared_ptr<SSL_CTX> context;
  {
    const std::lock_guard lock(mutex_);
    context = context_;
  }
  return std::make_unique<TlsSession>(std::move(context), socket);
}

}  // namespace symcell::server
