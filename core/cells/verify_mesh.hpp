// Checks a planar cell, its full mesh and the model they mesh against each other, trusting nothing
// of how they were made.
//
// What is checked, by name of the check (full.* on the given full mesh, or on one restored from the
// cell by its own pairs):
//   cell.fields, full.fields     finite points in the plane z = 0, axis normal to it, fold
//   *.corners, *.orientation     distinct corners, every node used, exactly positive triangles
//   *.conforming                 an edge has at most two triangles, from opposite sides
//   *.duplicates                 no two nodes at one place
//   *.mid_nodes                  order 2: one node an edge, at its midpoint
//   cell.pairs                   a node rotated by +360/n is its pair; one to one; centre to itself
//   cell.bounds                  lower edges go to higher ones, seen from the other side
//   full.copies                  n rotated cells, element by element, each once (regions that
//                                differ are told only: with ignore_markers they may)
//   full.area                    n times the cell's area; the model's area, where it is given
//   model.vertices, .segments    vertices are nodes, segments chains of mesh edges, but for those
//                                that dangle outside the meshed domain
//   model.boundary               the mesh's boundary lies on segments
//   model.holes, .regions        no triangle at a hole's seed; the seed's attribute at a region's
//   model.region_borders         regions change at segments only
//   full.delaunay                share of unconstrained edges that are locally Delaunay (told only)
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/cells/mesh_data.hpp"
#include "core/model/pslg.hpp"

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

struct VerifyOptions {
  double tolerance_rel = 1e-9;        // of pairs and copies, relative to the model's diameter
  double model_tolerance_rel = 1e-6;  // of nodes against the model: symmetrising moves vertices
  std::optional<double> model_area;   // input units squared, if it is known
  std::size_t most_restored_nodes = 200'000'000;  // beyond: full.* without a file are skipped
};

// `full` and `model` may be null.  Cost: O(N log N) for N elements of the full mesh.
[[nodiscard]] VerifyReport verify_mesh(const MeshData& cell,
                                       const MeshData* full,
                                       const Pslg* model,
                                       const VerifyOptions& options);

}  // namespace symcell
