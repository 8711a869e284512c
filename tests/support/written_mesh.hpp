// Meshes as the writers put them, in memory.  Needs symcell_api.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "api/formats/mesh_writer.hpp"

namespace symcell::test {

[[nodiscard]] inline std::string written(const SymmetryCellMesh& cell,
                                         MeshPart part,
                                         MeshFormat format,
                                         WriteOptions options = {}) {
  std::string bytes;
  const auto done = write_mesh(cell, part, format, options, [&](std::string_view piece) {
    EXPECT_LE(piece.size(), std::size_t{1} << 20);
    bytes += piece;
    return true;
  });
  EXPECT_TRUE(done);
  return bytes;
}

}  // namespace symcell::test
