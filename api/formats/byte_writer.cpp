#include "api/formats/byte_writer.hpp"

#include <algorithm>

namespace symcell {

void ByteWriter::flush() {
  if (ok_ && used_ > 0) ok_ = (*sink_)(std::string_view(buffer_.get(), used_));
  used_ = 0;
}

void ByteWriter::raw_large(const char* bytes, std::size_t size) {
  while (size > 0) {
    if (used_ == kCapacity) flush();
    const std::size_t part = std::min(size, kCapacity - used_);
    std::memcpy(buffer_.get() + used_, bytes, part);
    used_ += part;
    bytes += part;
    size -= part;
  }
}

Result<void> ByteWriter::finish() {
  flush();
  if (!ok_) {
    return fail(ErrorCode::kWriteFailed,
                "the output could not be written: its receiver is gone or has no more room");
  }
  return {};
}

}  // namespace symcell
