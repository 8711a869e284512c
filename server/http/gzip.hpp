// Streaming gzip in both directions, in pieces of bounded size.
#pragma once

#include <functional>
#include <memory>
#include <string_view>

namespace symcell::server {

// Takes the next piece; false: stop.
using PieceSink = std::function<bool(std::string_view)>;

class GzipDeflater {
 public:
  explicit GzipDeflater(PieceSink sink);
  ~GzipDeflater();
  GzipDeflater(const GzipDeflater&) = delete;
  GzipDeflater& operator=(const GzipDeflater&) = delete;

  // False: the sink stopped.
  [[nodiscard]] bool write(std::string_view bytes);
  [[nodiscard]] bool finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

class GzipInflater {
 public:
  // `sink` bounds the total: a bomb is stopped at its first piece too many.
  explicit GzipInflater(PieceSink sink);
  ~GzipInflater();
  GzipInflater(const GzipInflater&) = delete;
  GzipInflater& operator=(const GzipInflater&) = delete;

  // False: not gzip, or the sink stopped.
  [[nodiscard]] bool write(std::string_view bytes);
  // True if the stream has come to its proper end (checksum included).
  [[nodiscard]] bool complete() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// True if an Accept-Encoding header takes gzip (or *) with a weight above zero.
[[nodiscard]] bool accepts_gzip(std::string_view accept_encoding);

}  // namespace symcell::server
