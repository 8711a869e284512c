// The writers behind write_mesh, one a format. All stream: memory is O(cell).
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "api/formats/byte_writer.hpp"
#include "api/formats/mesh_stream.hpp"

namespace symcell::internal {

// JSON as the interface has it.
void write_json_mesh(MeshStream& mesh, ByteWriter& out);

// The same with arrays in base64.  Requires: `reals` is not kNone.
void write_packed_json(MeshStream& mesh, PackedReals reals, ByteWriter& out);

// Values at the nodes of the full mesh: one number (x) or a vector.
struct NodeVectors {
  std::string name;
  std::uint64_t components = 3;  // 1 or 3
  std::function<Point3(OrbitVertex)> value;
};

// VTK XML UnstructuredGrid; types 5 and 22 (10 and 24 for solids).  `fields`: further point data.
void write_vtu(MeshStream& mesh,
               VtuEncoding encoding,
               ByteWriter& out,
               std::span<const NodeVectors> fields = {});

// Gmsh 4.1 ASCII: physical names, a discrete entity a region, a boundary marker and (in the cell) a
// bound, and $Periodic from the lower to the higher bound.
void write_msh(MeshStream& mesh, ByteWriter& out);

// Gmsh 2.2 ASCII: the same groups as elements with tags; no $Periodic.
void write_msh2(MeshStream& mesh, ByteWriter& out);

// VTK XML PolyData: the facets of the model and, of a cell, of both bounds, with `marker` and `side`
// (0 outside, 1 lower bound, 2 higher bound, 3 within the material).  Errors: kInternal.
[[nodiscard]] Result<void> write_vtp(MeshStream& mesh, VtuEncoding encoding, ByteWriter& out);

// Binary glTF: surface or triangles by group, bounds red and blue, edges as lines; the full mesh as a
// node a sector.  Errors: kTooLarge (4 GiB).
[[nodiscard]] Result<void> write_glb(const MeshStream& mesh, ByteWriter& out);

// A picture of a planar mesh: edges thin, model segments dark, lower bound red, higher bound blue;
// the full mesh as rotated copies of the cell, which is picked out in colour.
void write_svg(const MeshStream& mesh, ByteWriter& out);

// STL of a solid's boundary, oriented outwards: of the cell with both bounds, of the full mesh
// without them. Corners only: quadratic elements have straight sides.
// Errors: kTooLarge (a full mesh with more triangles than the format can count).
[[nodiscard]] Result<void> write_stl(const MeshStream& mesh, bool ascii, ByteWriter& out);

}  // namespace symcell::internal
