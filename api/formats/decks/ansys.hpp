// ANSYS archive (cdb): the mesh in blocks, groups as components and, of a cell, the pairs of its
// bounds as an array for CYCLIC.
#pragma once

#include "api/formats/byte_writer.hpp"
#include "api/formats/decks/deck_plan.hpp"

namespace symcell::internal {

// Errors: kUnsupportedModel (a cell whose bounds are not pairs), kTooLarge (more nodes or elements
// than the blocks have room for).
[[nodiscard]] Result<void> check_ansys(const MeshStream& mesh, const DeckPlan& plan);

// SOLID187 and SOLID185 (collapsed to a tetrahedron) of solids, PLANE183 and PLANE182 (collapsed to
// a triangle) in the plane. Materials have the regions' attributes as numbers.
// Requires: check_ansys.
void write_ansys(MeshStream& mesh, DeckPlan& plan, bool plane_strain, ByteWriter& out);

}  // namespace symcell::internal
