// The header of a PLY file.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"

namespace symcell::internal {

enum class PlyEncoding : std::uint8_t { kAscii, kLittleEndian, kBigEndian };

enum class PlyScalar : std::uint8_t {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kFloat32,
  kFloat64
};

[[nodiscard]] std::size_t size_of(PlyScalar type);

struct PlyProperty {
  std::string name;
  PlyScalar type = PlyScalar::kFloat32;  // lists: of an item
  bool list = false;
  PlyScalar count_type = PlyScalar::kUint8;  // lists
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;  // as given, not to be trusted
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::kAscii;
  std::vector<PlyElement> elements;
  std::size_t lines = 0;  // of the header
  std::string_view body;  // what follows
};

// Errors: kSyntax, kTruncated, kUnsupportedModel, kTooLarge (of the header itself).
[[nodiscard]] Result<PlyHeader> read_ply_header(std::string_view bytes);

}  // namespace symcell::internal
