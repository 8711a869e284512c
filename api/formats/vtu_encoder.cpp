#include "api/formats/vtu_encoder.hpp"

#include <zlib.h>

#include <bit>

#include "core/base/assert.hpp"

namespace symcell::internal {
namespace {

static_assert(std::endian::native == std::endian::little,
              "binary files are written as the machine keeps its numbers");

constexpr int kCompressionLevel = 1;
// Of all compressed arrays together: most cells are made once only.
constexpr std::uint64_t kCacheLimit = std::uint64_t{64} << 20;

}  // namespace

VtuValues::VtuValues(Mode mode, ByteWriter* out) : mode_(mode), out_(out) {
  if (mode == Mode::kMeasure || mode == Mode::kCompress) {
    block_.resize(kVtuBlock);
    compressed_.resize(compressBound(kVtuBlock));
  }
}

void VtuValues::compress_block() {
  uLongf size = compressed_.size();
  const int status =
      compress2(reinterpret_cast<Bytef*>(compressed_.data()), &size,
                reinterpret_cast<const Bytef*>(block_.data()), used_, kCompressionLevel);
  SYMCELL_ASSERT(status == Z_OK);  // the room is compressBound's
  used_ = 0;
  if (mode_ == Mode::kCompress) {
    out_->raw(compressed_.data(), size);
    return;
  }
  block_sizes.push_back(size);
  if (cache_complete && cached.size() + size <= cache_limit) {
    cached.append(compressed_.data(), size);
  } else {
    cache_complete = false;
    std::string().swap(cached);
  }
}

void VtuValues::finish() {
  if (used_ > 0) compress_block();
}

VtuEncoder::VtuEncoder(VtuEncoding encoding, std::vector<VtuArray> arrays)
    : encoding_(encoding), arrays_(std::move(arrays)) {
  if (encoding == VtuEncoding::kAscii) return;
  std::uint64_t offset = 0;
  std::uint64_t cache_left = kCacheLimit;
  for (const VtuArray& array : arrays_) {
    offsets_.push_back(offset);
    if (encoding == VtuEncoding::kAppendedRaw) {
      offset += sizeof(std::uint64_t) + array.bytes();
      continue;
    }
    VtuValues values(VtuValues::Mode::kMeasure, nullptr);
    values.cache_limit = cache_left;
    array.generate(values);
    values.finish();
    cache_left -= values.cached.size();
    offset += sizeof(std::uint64_t) * (3 + values.block_sizes.size());
    for (const std::uint64_t size : values.block_sizes) offset += size;
    compressed_.push_back(
        {std::move(values.block_sizes), std::move(values.cached), values.cache_complete});
  }
}

void VtuEncoder::write_element(ByteWriter& out, std::size_t i, bool tuples_attribute) const {
  const VtuArray& array = arrays_[i];
  out.text("<DataArray type=\"");
  out.text(array.type);
  out.text("\" Name=\"");
  out.text(array.name);
  if (array.components != 1) {
    out.text("\" NumberOfComponents=\"");
    out.integer(static_cast<std::int64_t>(array.components));
  }
  if (tuples_attribute) {
    out.text("\" NumberOfTuples=\"");
    out.integer(static_cast<std::int64_t>(array.tuples));
  }
  if (encoding_ == VtuEncoding::kAscii) {
    out.text("\" format=\"ascii\">\n");
    VtuValues values(VtuValues::Mode::kAscii, &out);
    array.generate(values);
    out.text("\n</DataArray>\n");
    return;
  }
  out.text("\" format=\"appended\" offset=\"");
  out.integer(static_cast<std::int64_t>(offsets_[i]));
  out.text("\"/>\n");
}

void VtuEncoder::write_appended(ByteWriter& out) const {
  for (std::size_t i = 0; i < offsets_.size() && out.ok(); ++i) {
    if (encoding_ == VtuEncoding::kAppendedZlib) {
      write_compressed(out, i);
      continue;
    }
    out.value(arrays_[i].bytes());
    VtuValues values(VtuValues::Mode::kRaw, &out);
    arrays_[i].generate(values);
  }
}

void VtuEncoder::write_compressed(ByteWriter& out, std::size_t i) const {
  const Compressed& made = compressed_[i];
  // Number of blocks, size of a block, size of the last if it is smaller; then the compressed ones.
  out.value(static_cast<std::uint64_t>(made.block_sizes.size()));
  out.value(static_cast<std::uint64_t>(kVtuBlock));
  out.value(static_cast<std::uint64_t>(arrays_[i].bytes() % kVtuBlock));
  for (const std::uint64_t size : made.block_sizes) out.value(size);
  if (made.cache_complete) {
    out.text(made.cached);
    return;
  }
  VtuValues values(VtuValues::Mode::kCompress, &out);
  arrays_[i].generate(values);
  values.finish();
}

}  // namespace symcell::internal
