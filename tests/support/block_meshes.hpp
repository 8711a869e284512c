// Meshes of unit squares and cubes by hand, fold 1, with the models they mesh: what checks of
// damaged meshes begin with.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/model/plc.hpp"
#include "core/model/pslg.hpp"
#include "core/model/triangle_surface.hpp"
#include "core/verify/mesh_data.hpp"

namespace symcell::test {

using Block = std::array<std::int32_t, 3>;  // low corner of a square (third 0) or cube
using Blocks = std::vector<Block>;

// All blocks of a box of these sizes, but for some.
[[nodiscard]] Blocks all_blocks(const Block& sizes, const Blocks& without = {});

// Two triangles a square, six tetrahedra a cube, in the order of the blocks; they conform. A cell
// and its full mesh at once.
[[nodiscard]] MeshData square_mesh(const Blocks& squares);
[[nodiscard]] MeshData cube_mesh(const Blocks& cubes);
[[nodiscard]] MeshData quadratic(const MeshData& mesh);

// The sides that one block has; for each a segment, a facet or two triangles.
[[nodiscard]] Pslg square_model(const Blocks& squares);
[[nodiscard]] Plc cube_plc(const Blocks& cubes);
[[nodiscard]] TriangleSurface cube_surface(const Blocks& cubes);

}  // namespace symcell::test
