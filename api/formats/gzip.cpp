#include "api/formats/gzip.hpp"

#include <zlib.h>

#include <algorithm>
#include <limits>
#include <memory>

namespace symcell {
namespace {

struct EndInflate {
  void operator()(z_stream* stream) const { inflateEnd(stream); }
};

}  // namespace

bool is_gzip(std::string_view bytes) {
  return bytes.starts_with("\x1f\x8b");
}

Result<std::string> gunzip(std::string_view bytes, std::size_t max_bytes) {
  z_stream stream{};
  constexpr int kGzipOnly = 16 + MAX_WBITS;
  if (inflateInit2(&stream, kGzipOnly) != Z_OK) {
    return fail(ErrorCode::kMemoryLimit, "no memory to unpack the gzip file");
  }
  const std::unique_ptr<z_stream, EndInflate> end(&stream);
  std::string text;
  std::string piece(std::size_t{1} << 16, '\0');
  std::size_t taken = 0;  // of `bytes`
  while (true) {
    const std::size_t part =
        std::min<std::size_t>(bytes.size() - taken, std::numeric_limits<uInt>::max());
    // zlib's interface is not const; it does not write there.
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + taken));
    stream.avail_in = static_cast<uInt>(part);
    stream.next_out = reinterpret_cast<Bytef*>(piece.data());
    stream.avail_out = static_cast<uInt>(piece.size());
    const int status = inflate(&stream, Z_NO_FLUSH);
    taken += part - stream.avail_in;
    const std::size_t made = piece.size() - stream.avail_out;
    if (text.size() + made > max_bytes) {
      return fail(ErrorCode::kTooLarge,
                  "the gzip file unpacks to more than " + std::to_string(max_bytes) + " bytes");
    }
    text.append(piece, 0, made);
    if (status == Z_STREAM_END) {
      if (taken == bytes.size() || !is_gzip(bytes.substr(taken))) return text;
      inflateReset(&stream);
      continue;
    }
    if (status == Z_BUF_ERROR || (status == Z_OK && taken == bytes.size() && made == 0)) {
      return fail(ErrorCode::kTruncated, "the gzip file ends too early");
    }
    if (status != Z_OK) {
      return fail(ErrorCode::kSyntax,
                  "the gzip file is damaged near byte " + std::to_string(taken));
    }
  }
}

}  // namespace symcell
