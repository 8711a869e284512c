// The compact binary form in which finished cells are kept: versioned, little-endian, checksummed.
// Not an interchange format; any version may change it, readers refuse versions they don't know.
#pragma once

#include <cstdint>
#include <string_view>

#include "api/sink.hpp"
#include "core/base/error.hpp"
#include "core/cell/symmetry_cell_mesh.hpp"

namespace symcell {

[[nodiscard]] Result<void> write_cell_archive(const SymmetryCellMesh& cell, const Sink& sink);
// 2 or 3, from the header alone.  Errors: kTruncated, kUnknownFormat.
[[nodiscard]] Result<std::int32_t> cell_archive_dimension(std::string_view bytes);
// Errors: kTruncated, kUnknownFormat, kSyntax (checksum or index out of range).
[[nodiscard]] Result<SymmetryCellMesh> read_cell_archive(std::string_view bytes);

}  // namespace symcell
