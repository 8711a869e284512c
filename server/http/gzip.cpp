#include "server/http/gzip.hpp"

#include <zlib.h>

#include <array>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "server/http/header_values.hpp"

namespace symcell::server {
namespace {

constexpr int kGzipWindow = 15 + 16;  // zlib: + 16 means gzip's header and trailer
constexpr int kFastLevel = 1;         // the mesh writer outruns anything slower
constexpr std::size_t kPieceBytes = 64UL * 1024;

using Buffer = std::array<char, kPieceBytes>;

void set_input(z_stream& stream, std::string_view bytes) {
  // zlib's input pointer lacks const in this build; it does not write there.
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
}

void set_output(z_stream& stream, Buffer& buffer) {
  stream.next_out = reinterpret_cast<Bytef*>(buffer.data());
  stream.avail_out = static_cast<uInt>(buffer.size());
}

// zlib counts in 32 bits.
template <class Step>
bool in_steps(std::string_view bytes, const Step& step) {
  constexpr std::size_t kMost = 1UL << 30U;
  while (!bytes.empty()) {
    if (!step(bytes.substr(0, kMost))) return false;
    bytes.remove_prefix(std::min(kMost, bytes.size()));
  }
  return true;
}

}  // namespace

struct GzipDeflater::Impl {
  z_stream stream{};
  Buffer buffer{};
  PieceSink sink;

  bool run(std::string_view bytes, int flush) {
    set_input(stream, bytes);
    do {
      set_output(stream, buffer);
      ::deflate(&stream, flush);
      const std::size_t n = buffer.size() - stream.avail_out;
      if (n > 0 && !sink({buffer.data(), n})) return false;
    } while (stream.avail_out == 0);
    return true;
  }
};

GzipDeflater::GzipDeflater(PieceSink sink) : impl_(std::make_unique<Impl>()) {
  impl_->sink = std::move(sink);
  if (::deflateInit2(&impl_->stream, kFastLevel, Z_DEFLATED, kGzipWindow, 8, Z_DEFAULT_STRATEGY) !=
      Z_OK) {
    throw std::runtime_error("zlib cannot start");
  }
}

GzipDeflater::~GzipDeflater() {
  ::deflateEnd(&impl_->stream);
}

bool GzipDeflater::write(std::string_view bytes) {
  return in_steps(bytes, [this](std::string_view step) { return impl_->run(step, Z_NO_FLUSH); });
}

bool GzipDeflater::finish() {
  return impl_->run({}, Z_FINISH);
}

struct GzipInflater::Impl {
  z_stream stream{};
  Buffer buffer{};
  PieceSink sink;
  bool complete = false;

  bool run(std::string_view bytes) {
    set_input(stream, bytes);
    do {
      if (complete) return stream.avail_in == 0;  // bytes after the end
      set_output(stream, buffer);
      const int status = ::inflate(&stream, Z_NO_FLUSH);
      if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR) return false;
      const std::size_t n = buffer.size() - stream.avail_out;
      if (n > 0 && !sink({buffer.data(), n})) return false;
      complete = status == Z_STREAM_END;
    } while (stream.avail_out == 0 || stream.avail_in > 0);
    return true;
  }
};

GzipInflater::GzipInflater(PieceSink sink) : impl_(std::make_unique<Impl>()) {
  impl_->sink = std::move(sink);
  if (::inflateInit2(&impl_->stream, kGzipWindow) != Z_OK) {
    throw std::runtime_error("zlib cannot start");
  }
}

GzipInflater::~GzipInflater() {
  ::inflateEnd(&impl_->stream);
}

bool GzipInflater::write(std::string_view bytes) {
  return in_steps(bytes, [this](std::string_view step) { return impl_->run(step); });
}

bool GzipInflater::complete() const {
  return impl_->complete;
}

bool accepts_gzip(std::string_view accept_encoding) {
  std::optional<double> gzip;
  std::optional<double> any;
  for (const WeightedValue& coding : parse_weighted_list(accept_encoding)) {
    if (coding.value == "gzip" || coding.value == "x-gzip") gzip = coding.weight;
    if (coding.value == "*") any = coding.weight;
  }
  return gzip.value_or(any.value_or(0)) > 0;
}

}  // namespace symcell::server
