// Checks a cell, its full mesh and the model they mesh against each other, trusting nothing of how
// they were made. Triangles and tetrahedra alike.
//
// What is checked, by name of the check (full.* on the given full mesh, or on one restored from the
// cell by its own pairs):
//   cell.fields, full.fields     finite points, in the plane z = 0 if planar; unit axis; fold
//   *.corners, *.orientation     distinct corners, every node used, exactly positive elements
//   *.conforming                 a facet has at most two elements, from opposite sides
//   *.duplicates                 no two nodes at one place
//   *.mid_nodes                  order 2: one node an edge, at its midpoint
//   cell.quality                 angles and radius-edge ratio (told only)
//   cell.pairs                   a node rotated by +360/n is its pair; one to one; axis to itself
//   cell.bounds                  lower facets go to higher ones, seen from the other side
//   full.copies                  n rotated cells, element by element, each once (regions that
//                                differ are told only: with ignore_markers they may)
//   full.area, full.volume       n times the cell's; the model's (model.*), where it is given
//   full.links, cell.links       solids: elements round a node or edge hang together by faces, in
//                                the cell wherever they do in the full mesh (there told only)
//   full.delaunay                share of unconstrained facets that are locally Delaunay (told
//   only)
// against a PSLG or PLC:
//   model.vertices, .segments    vertices are nodes, segments chains of mesh edges, but for those
//                                that dangle outside the meshed domain
//   model.facets                 PLC: likewise unions of mesh faces
//   model.boundary               the mesh's boundary lies on segments (PLC: facets)
//   model.holes, .regions        no element at a hole's seed; the seed's attribute at a region's
//   model.region_borders         regions change at segments (PLC: facets) only
// against a surface:
//   model.on_surface             the mesh's boundary is near the surface: nodes and middles of
//   faces model.covered                the surface is near the mesh's boundary: vertices and
//   samples
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/cells/mesh_data.hpp"
#include "core/model/model.hpp"

namespace symcell {

struct Check {
  enum class Status : std::uint8_t { kPass, kFail, kSkip };
  std::string name;
  Status status = Status::kPass;
  std::string detail;  // the worst figure and where, or why it was left out
};

struct VerifyReport {
  std::vector<Check> checks;
  // No check failed, and the cell's own were made.
  [[nodiscard]] bool ok() const;
};

inline constexpr double kExactToleranceRel = 1e-6;    // PSLG and PLC
inline constexpr double kSurfaceToleranceRel = 1e-3;  // a tessellation of a symmetric shape

struct VerifyOptions {
  double tolerance_rel = 1e-9;  // of pairs and copies, relative to the model's diameter
  // Of nodes against the model, which symmetrising moves; nullopt: as below.
  std::optional<double> model_tolerance_rel;
  std::optional<double> model_measure;            // its area or volume, if it is known
  std::size_t most_restored_nodes = 200'000'000;  // beyond: full.* without a file are skipped
};

// `full` and `model` may be null.  Cost: O(N log N) for N elements of the full mesh.
[[nodiscard]] VerifyReport verify_mesh(const MeshData& cell,
                                       const MeshData* full,
                                       const Model* model,
                                       const VerifyOptions& options);

}  // namespace symcell
