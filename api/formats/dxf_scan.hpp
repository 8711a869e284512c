// A first look at a DXF file: that it is one, whole, and holds no count or number that is wrong, and
// which entities of it are read. What is left is all that dxflib is given, which trusts its input.
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"

namespace symcell {

struct DxfEntity {
  std::string type;      // "LINE"
  std::size_t line = 0;  // of its first group, from 1
};

struct DxfScan {
  std::string text;                 // of dxflib: the colour of an entity is its index in `entities`
  std::vector<DxfEntity> entities;  // of what is read, in order
  std::vector<std::string> left_out;    // "3 HATCH", by name
  std::set<std::string> hidden_layers;  // frozen or off
};

// Whether the bytes begin as a DXF file does, binary ones too.
[[nodiscard]] bool looks_like_dxf(std::string_view bytes);

// Errors: kUnsupportedModel (binary DXF), kSyntax, kTruncated, kCountMismatch, kNonFinite, kTooLarge;
// all name the line, and the entity where there is one.  Cost: O(bytes).
[[nodiscard]] Result<DxfScan> scan_dxf(std::string_view bytes);

}  // namespace symcell
