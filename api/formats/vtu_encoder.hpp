// Arrays of a VTU file in one of its encodings: ASCII, or the appended section raw or compressed.
//
// The file's head gives each array's offset before any of the data, and the compressed sizes stand
// before the blocks. So compressed arrays are made twice: once to learn the sizes and once to write
// them, unless all blocks fit the cache. Memory is bounded either way.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "api/formats/byte_writer.hpp"
#include "api/formats/mesh_writer.hpp"

namespace symcell::internal {

class VtuValues;

struct VtuArray {
  std::string_view name;
  std::string_view type;     // VTK's name: "Int32"
  std::uint64_t value_size;  // bytes
  std::uint64_t components;
  std::uint64_t tuples;
  std::function<void(VtuValues&)> generate;  // puts all values, the same ones at every call

  [[nodiscard]] std::uint64_t bytes() const { return value_size * components * tuples; }
};

// What a generator writes to: values of one array in order.
class VtuValues {
 public:
  enum class Mode : std::uint8_t { kAscii, kRaw, kMeasure, kCompress };

  VtuValues(Mode mode, ByteWriter* out);

  template <class T>
  void put(T value);
  void finish();

  [[nodiscard]] bool ok() const { return out_ == nullptr || out_->ok(); }
  // Of kMeasure: sizes of the compressed blocks, the blocks themselves while they fit the cache.
  std::vector<std::uint64_t> block_sizes;
  std::string cached;
  bool cache_complete = true;
  std::uint64_t cache_limit = 0;

 private:
  void compress_block();

  Mode mode_;
  ByteWriter* out_;
  std::vector<char> block_;
  std::size_t used_ = 0;
  std::string compressed_;
  std::size_t on_line_ = 0;
};

// Lays out the arrays in order, then writes the appended section.
class VtuEncoder {
 public:
  VtuEncoder(VtuEncoding encoding, std::vector<VtuArray> arrays);

  [[nodiscard]] VtuEncoding encoding() const { return encoding_; }
  [[nodiscard]] const VtuArray& array(std::size_t i) const { return arrays_[i]; }
  // Writes the <DataArray> element; with its values if the encoding is ASCII.
  void write_element(ByteWriter& out, std::size_t i, bool tuples_attribute) const;
  // The data behind the '_' of <AppendedData>; nothing for ASCII.
  void write_appended(ByteWriter& out) const;

 private:
  struct Compressed {
    std::vector<std::uint64_t> block_sizes;
    std::string cached;
    bool cache_complete = true;
  };
  void write_compressed(ByteWriter& out, std::size_t i) const;

  VtuEncoding encoding_;
  std::vector<VtuArray> arrays_;
  std::vector<std::uint64_t> offsets_;
  std::vector<Compressed> compressed_;
};

// Bytes of a block before compression.
inline constexpr std::size_t kVtuBlock = std::size_t{1} << 17;

template <class T>
void VtuValues::put(T value) {
  switch (mode_) {
    case Mode::kRaw: out_->value(value); return;
    case Mode::kAscii:
      if constexpr (std::is_floating_point_v<T>) {
        out_->real(value);
      } else {
        out_->integer(value);
      }
      out_->character(++on_line_ % 12 == 0 ? '\n' : ' ');
      return;
    case Mode::kMeasure:
    case Mode::kCompress:
      // Blocks are a multiple of every value's size.
      std::memcpy(block_.data() + used_, &value, sizeof value);
      used_ += sizeof value;
      if (used_ == kVtuBlock) compress_block();
      return;
  }
}

}  // namespace symcell::internal
