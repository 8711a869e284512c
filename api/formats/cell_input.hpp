// Cells from files, to be written in other formats: the inverse of writing a cell.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/cell/symmetry_cell_mesh.hpp"
#include "core/verify/mesh_data.hpp"

namespace symcell {

// What a file holds of a cell, in model coordinates.
struct LooseCell {
  MeshData mesh;  // with its nodes an element
  std::vector<MarkerName> marker_names;
  // Facets as nodes, corners first; without them (VTU) they are found: those of one element that are on
  // no bound, with the marker of their nodes where these have one alone.
  bool has_boundary = false;
  std::vector<std::int32_t> boundary;
  std::vector<std::int32_t> boundary_markers;
};

// Orbits and exponents from the pairs of the bounds, and the bounds' facets.
// Errors: kSyntax, naming what does not fit; kUnsupportedModel (a full mesh).  Cost: O(E log E).
[[nodiscard]] Result<SymmetryCellMesh> cell_of(const LooseCell& loose);

// A cell archive (a job's `cell` in the data directory), JSON or VTU of a cell, also gzip'd.
// Errors: as cell_of; those of reading.
[[nodiscard]] Result<SymmetryCellMesh> read_cell(std::string_view bytes);

}  // namespace symcell
