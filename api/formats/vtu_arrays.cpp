#include "api/formats/vtu_arrays.hpp"

#include <zlib.h>

#include <array>
#include <charconv>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>

#include "api/formats/text_numbers.hpp"
#include "api/printable.hpp"

namespace symcell::internal {
namespace {

// zlib cannot pack better than this.
constexpr std::uint64_t kMostRatio = 1032;
constexpr std::uint64_t kMostBlock = std::uint64_t{1} << 30;

enum class Scalar : std::uint8_t {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat32,
  kFloat64
};

struct ScalarRow {
  std::string_view name;
  Scalar type;
  std::size_t size;
};

constexpr std::array<ScalarRow, 10> kScalars{{{"Int8", Scalar::kInt8, 1},
                                              {"UInt8", Scalar::kUint8, 1},
                                              {"Int16", Scalar::kInt16, 2},
                                              {"UInt16", Scalar::kUint16, 2},
                                              {"Int32", Scalar::kInt32, 4},
                                              {"UInt32", Scalar::kUint32, 4},
                                              {"Int64", Scalar::kInt64, 8},
                                              {"UInt64", Scalar::kUint64, 8},
                                              {"Float32", Scalar::kFloat32, 4},
                                              {"Float64", Scalar::kFloat64, 8}}};

const ScalarRow* find_scalar(std::string_view name) {
  for (const ScalarRow& row : kScalars) {
    if (row.name == name) return &row;
  }
  return nullptr;
}

std::string name_of(const pugi::xml_node& array) {
  return "array " + printable(array.attribute("Name").as_string("(unnamed)"));
}

template <class From, class T>
void convert(std::string_view bytes, std::vector<T>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    From value{};
    std::memcpy(&value, bytes.data() + i * sizeof value, sizeof value);
    values[i] = static_cast<T>(value);
  }
}

template <class T>
void convert(Scalar type, std::string_view bytes, std::vector<T>& values) {
  switch (type) {
    case Scalar::kInt8: return convert<std::int8_t>(bytes, values);
    case Scalar::kUint8: return convert<std::uint8_t>(bytes, values);
    case Scalar::kInt16: return convert<std::int16_t>(bytes, values);
    case Scalar::kUint16: return convert<std::uint16_t>(bytes, values);
    case Scalar::kInt32: return convert<std::int32_t>(bytes, values);
    case Scalar::kUint32: return convert<std::uint32_t>(bytes, values);
    case Scalar::kInt64: return convert<std::int64_t>(bytes, values);
    case Scalar::kUint64: return convert<std::uint64_t>(bytes, values);
    // Integers are never asked of these: see `read`.
    case Scalar::kFloat32:
      if constexpr (std::is_floating_point_v<T>) convert<float>(bytes, values);
      return;
    case Scalar::kFloat64:
      if constexpr (std::is_floating_point_v<T>) convert<double>(bytes, values);
      return;
  }
}

}  // namespace

Result<VtuArrays> VtuArrays::open(const pugi::xml_node& root, std::string_view appended) {
  VtuArrays arrays;
  arrays.appended_ = appended;
  const std::string_view order = root.attribute("byte_order").as_string("LittleEndian");
  const std::string_view header = root.attribute("header_type").as_string("UInt32");
  const std::string_view compressor = root.attribute("compressor").as_string();
  if (order != "LittleEndian" || (header != "UInt32" && header != "UInt64")) {
    return fail(ErrorCode::kUnknownFormat,
                "only little-endian VTU files with UInt32 or UInt64 headers are read");
  }
  if (!compressor.empty() && compressor != "vtkZLibDataCompressor") {
    return fail(ErrorCode::kUnknownFormat,
                "the compressor " + printable(compressor) + " is not read; save with zlib or none");
  }
  arrays.word_size_ = header == "UInt64" ? 8 : 4;
  arrays.compressed_ = !compressor.empty();
  return arrays;
}

std::uint64_t VtuArrays::word(std::string_view data, std::size_t index) const {
  if (word_size_ == 8) {
    std::uint64_t value = 0;
    std::memcpy(&value, data.data() + index * 8, 8);
    return value;
  }
  std::uint32_t value = 0;
  std::memcpy(&value, data.data() + index * 4, 4);
  return value;
}

Result<std::string> VtuArrays::payload(const pugi::xml_node& array, std::uint64_t bytes) const {
  const std::optional<std::int64_t> offset =
      parse_integer(array.attribute("offset").as_string("0"));
  if (!offset || *offset < 0 || static_cast<std::uint64_t>(*offset) >= appended_.size()) {
    return fail(ErrorCode::kTruncated, name_of(array) + " begins behind the end of the file");
  }
  const std::string_view data = appended_.substr(static_cast<std::size_t>(*offset));
  if (data.size() < word_size_) {
    return fail(ErrorCode::kTruncated, name_of(array) + " is cut off");
  }
  auto result = [&]() -> Result<std::string> {
    if (compressed_) return unpack(data, bytes);
    if (word(data, 0) != bytes) {
      return fail(ErrorCode::kCountMismatch, "has " + std::to_string(word(data, 0)) +
                                                 " bytes, expected " + std::to_string(bytes));
    }
    if (data.size() - word_size_ < bytes) return fail(ErrorCode::kTruncated, "is cut off");
    return std::string(data.substr(word_size_, static_cast<std::size_t>(bytes)));
  }();
  if (!result) result.error().message = name_of(array) + " " + result.error().message;
  return result;
}

// Number of blocks, their size, the size of the last one (0: full), their packed sizes; the blocks.
Result<std::string> VtuArrays::unpack(std::string_view data, std::uint64_t bytes) const {
  const std::uint64_t blocks = word(data, 0);
  if (blocks == 0) {
    if (bytes == 0) return std::string();
    return fail(ErrorCode::kCountMismatch, "is empty");
  }
  if (data.size() / word_size_ < 3 || blocks > data.size() / word_size_ - 3) {
    return fail(ErrorCode::kTruncated, "is cut off");
  }
  const std::uint64_t size = word(data, 1);
  const std::uint64_t last = word(data, 2) == 0 ? size : word(data, 2);
  const bool sane = size > 0 && size <= kMostBlock && last <= size && blocks - 1 <= bytes / size &&
                    (blocks - 1) * size + last == bytes && bytes / kMostRatio <= data.size();
  if (!sane) return fail(ErrorCode::kCountMismatch, "has blocks that do not make up its size");
  std::string text;
  std::string_view packed = data.substr((3 + static_cast<std::size_t>(blocks)) * word_size_);
  std::string block;
  for (std::uint64_t b = 0; b < blocks; ++b) {
    const std::uint64_t packed_size = word(data, static_cast<std::size_t>(3 + b));
    if (packed_size > packed.size()) return fail(ErrorCode::kTruncated, "is cut off");
    const std::uint64_t wanted = b + 1 == blocks ? last : size;
    if (wanted / kMostRatio > packed_size) {
      return fail(ErrorCode::kSyntax, "has a block that cannot unpack to its size");
    }
    block.resize(static_cast<std::size_t>(wanted));
    uLongf made = static_cast<uLongf>(wanted);
    const int status =
        uncompress(reinterpret_cast<Bytef*>(block.data()), &made,
                   reinterpret_cast<const Bytef*>(packed.data()), static_cast<uLong>(packed_size));
    if (status != Z_OK || made != wanted) {
      return fail(ErrorCode::kSyntax, "has a damaged block " + std::to_string(b));
    }
    text += block;
    packed.remove_prefix(static_cast<std::size_t>(packed_size));
  }
  return text;
}

template <class T>
Result<std::vector<T>> VtuArrays::read_ascii(const pugi::xml_node& array,
                                             std::uint64_t count) const {
  std::string_view text = array.child_value();
  std::vector<T> values;
  // A number takes two bytes at least, the last one perhaps one.
  if (count > text.size() / 2 + 1) {
    return fail(ErrorCode::kCountMismatch,
                name_of(array) + " has fewer than " + std::to_string(count) + " values");
  }
  values.reserve(static_cast<std::size_t>(count));
  constexpr std::string_view kBlank = " \t\r\n";
  while (true) {
    const std::size_t begin = text.find_first_not_of(kBlank);
    if (begin == std::string_view::npos) break;
    const std::size_t end = std::min(text.find_first_of(kBlank, begin), text.size());
    const std::string_view token = text.substr(begin, end - begin);
    text.remove_prefix(end);
    bool ok = values.size() < count;
    if constexpr (std::is_floating_point_v<T>) {
      const ParsedNumber number = parse_number(token);
      ok = ok && number.kind != NumberKind::kNoNumber;
      values.push_back(number.value);
    } else {
      const std::optional<std::int64_t> number = parse_integer(token);
      ok = ok && number.has_value();
      values.push_back(number.value_or(0));
    }
    if (!ok) {
      return fail(ErrorCode::kSyntax,
                  name_of(array) + ": \"" + printable(token) + "\" is no value or one too many");
    }
  }
  if (values.size() != count) {
    return fail(ErrorCode::kCountMismatch, name_of(array) + " has " +
                                               std::to_string(values.size()) +
                                               " values, expected " + std::to_string(count));
  }
  return values;
}

template <class T>
Result<std::vector<T>> VtuArrays::read(const pugi::xml_node& array, std::uint64_t count) const {
  if (!array) return fail(ErrorCode::kMissingField, "an array is missing");
  const ScalarRow* scalar = find_scalar(array.attribute("type").as_string());
  const bool real = scalar != nullptr && scalar->type >= Scalar::kFloat32;
  if (scalar == nullptr || (real && !std::is_floating_point_v<T>)) {
    return fail(ErrorCode::kWrongType,
                name_of(array) + " has the type " + printable(array.attribute("type").as_string()));
  }
  const std::string_view format = array.attribute("format").as_string("ascii");
  if (format == "ascii") return read_ascii<T>(array, count);
  if (format != "appended") {
    return fail(ErrorCode::kUnknownFormat, name_of(array) + " is stored as " + printable(format) +
                                               "; appended raw and ascii are read");
  }
  const Result<std::string> bytes = payload(array, count * scalar->size);
  if (!bytes) return error_of(bytes);
  std::vector<T> values(static_cast<std::size_t>(count));
  convert(scalar->type, *bytes, values);
  return values;
}

Result<std::vector<double>> VtuArrays::reals(const pugi::xml_node& array,
                                             std::uint64_t count) const {
  return read<double>(array, count);
}

Result<std::vector<std::int64_t>> VtuArrays::integers(const pugi::xml_node& array,
                                                      std::uint64_t count) const {
  return read<std::int64_t>(array, count);
}

}  // namespace symcell::internal
