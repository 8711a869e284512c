// Collects output in one buffer and hands it to a sink in pieces of bounded size.
//
// Numbers are written by to_chars: shortest form that reads back as the same bits, deaf to the
// locale. After the sink has refused a piece all further output is dropped; long loops look at
// ok() now and then, and finish() reports.
#pragma once

#include <charconv>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string_view>

#include "api/sink.hpp"
#include "core/base/error.hpp"

namespace symcell {

class ByteWriter {
 public:
  static constexpr std::size_t kCapacity = std::size_t{1} << 18;

  // Keeps a reference: `sink` must outlive the writer.
  explicit ByteWriter(const Sink& sink) : sink_(&sink), buffer_(new char[kCapacity]) {}

  void text(std::string_view piece) { raw(piece.data(), piece.size()); }
  void character(char c) {
    make_room(1);
    buffer_[used_++] = c;
  }
  void integer(std::int64_t value) {
    make_room(kLongestNumber);
    char* at = buffer_.get() + used_;
    used_ += static_cast<std::size_t>(std::to_chars(at, at + kLongestNumber, value).ptr - at);
  }
  void real(double value) {
    make_room(kLongestNumber);
    char* at = buffer_.get() + used_;
    used_ += static_cast<std::size_t>(std::to_chars(at, at + kLongestNumber, value).ptr - at);
  }
  // At most `digits` significant digits, for pictures.
  void short_real(double value, int digits) {
    make_room(kLongestNumber);
    char* at = buffer_.get() + used_;
    const auto end =
        std::to_chars(at, at + kLongestNumber, value, std::chars_format::general, digits).ptr;
    used_ += static_cast<std::size_t>(end - at);
  }
  void raw(const void* bytes, std::size_t size) {
    if (size > kCapacity - used_) return raw_large(static_cast<const char*>(bytes), size);
    std::memcpy(buffer_.get() + used_, bytes, size);
    used_ += size;
  }
  template <class T>
  void value(const T& v) {
    raw(&v, sizeof v);
  }

  [[nodiscard]] bool ok() const { return ok_; }
  void flush();
  // Flushes.  Errors: kWriteFailed.
  [[nodiscard]] Result<void> finish();

 private:
  static constexpr std::size_t kLongestNumber = 32;

  void make_room(std::size_t size) {
    if (size > kCapacity - used_) flush();
  }
  void raw_large(const char* bytes, std::size_t size);

  const Sink* sink_;
  std::unique_ptr<char[]> buffer_;
  std::size_t used_ = 0;
  bool ok_ = true;
};

}  // namespace symcell
