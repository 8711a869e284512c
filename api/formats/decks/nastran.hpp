// Nastran bulk data: the mesh, its groups and, of a cell, the pairs of its bounds.
#pragma once

#include "api/formats/byte_writer.hpp"
#include "api/formats/decks/deck_plan.hpp"

namespace symcell::internal {

// Errors: kUnsupportedModel (a cell whose bounds are not pairs), kTooLarge (more nodes or elements
// than Nastran has numbers for).
[[nodiscard]] Result<void> check_nastran(const MeshStream& mesh, const DeckPlan& plan);

// Properties have the regions' attributes as numbers, sets the markers. Displacements of a cell are
// in cylindrical coordinates about the axis, which CYJOIN relies on; those of nodes on the axis in
// right-angled ones, as CYAX wants them.  Requires: check_nastran.
void write_nastran(MeshStream& mesh, DeckPlan& plan, ByteWriter& out);

}  // namespace symcell::internal
