// Checks a cell, its full mesh and the model they mesh against each other, trusting nothing of how
// they were made. Triangles and tetrahedra alike; shares no code with the mesher.
//
// What is checked, by name of the check (full.*: on the given full mesh, or on one restored from
// the cell by its own pairs).
//
// A mesh by itself:
//
//   *.fields                finite points of 64 bits, in the plane z = 0 if planar; unit axis; fold
//   *.corners               corners of an element are distinct, every node is used
//   *.orientation           elements are positive, exactly
//   *.duplicates            no two nodes at one place
//   *.conforming            a facet has at most two elements, from opposite sides
//   *.mid_nodes             order 2: one node an edge and one edge a node, at the midpoint; planar:
//                           or so near it on the bisector that the triangles are not folded; solids:
//                           on edges of the boundary so near it that no Jacobian is negative
//   *.vertex_links          elements at a node hang together by facets
//   *.edge_links            solids: likewise round an edge; both exempt where the model itself
//                           pinches, which the program computes from the model alone
//   cell.quality            angles and radius-edge ratio (reported only)
//   full.delaunay           share of free facets that are locally Delaunay (reported only)
//   full.min_angle          planar, if the bound is given: angles below it are forced by the model,
//                           at the centre that of 360/n only
//   full.hanging_nodes      no node lies in a boundary facet that it is no corner of
//
// The symmetry:
//
//   cell.pairs              a node rotated by +360/n is its pair
//   cell.pairs_injective    no node is the pair of two
//   cell.pairs_complete     a node whose image is a node says so
//   cell.axis_self          nodes on the axis, and no others, are their own pairs
//   cell.bounds             lower facets go one to one to higher ones, seen from the other side
//   cell.bounds_nodes       nodes with pairs are those of the bounds
//   cell.bounds_in_full     the cell's facets inside the full mesh are those of the bounds
//   cell.connected          the cell falls apart only as far as it does modulo symmetry
//   full.copies             n rotated cells, element by element, each once
//   full.regions            their regions too (of a model with regions: in the first sector)
//   full.pairs              pairs of the full mesh, where it has any
//   full.area, full.volume  n times the cell's
//
// Against any model:
//
//   model.valid             it can be meshed at all
//   model.area, .volume     as much as the model has
//   full.pieces             as many connected pieces as the model has
//
// Against a PSLG or PLC:
//
//   model.arcs              PSLG: arcs have nodes on them, no more than 60 degrees apart, and
//                           mid-side nodes beside their edges are on arcs
//   model.vertices          vertices of the domain are nodes
//   model.segments          its segments are chains of mesh edges
//   model.facets            PLC: its facets are unions of mesh faces, by area
//   model.boundary          the mesh's boundary lies on what bounds the domain
//   model.boundary_complete no elements on both sides of what bounds the domain
//                           Of a PSLG whose outline was made exact from one sector, as the cell's
//                           file says: only loose vertices are nodes; segments are near mesh edges,
//                           and the mesh's boundary near the domain's, by all their points
//   model.holes, .regions   no element at a hole's seed; the seed's attribute at a region's
//   model.region_borders    regions change at segments (PLC: facets) only
//   model.region_measure    no element above its region's own bound
//
// Against a surface:
//
//   model.on_surface        the mesh's boundary is near the surface: nodes and middles of faces
//   model.covered           the surface is near the mesh's boundary: vertices and samples
//   model.topology          both have as many shells and one Euler characteristic
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/model/mesh_options.hpp"
#include "core/model/model.hpp"
#include "core/verify/mesh_data.hpp"

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
  double tolerance_rel = 1e-9;  // of pairs and copies, relative to the model's diameter
  // Of nodes against the model, which symmetrising moves; nullopt: what a planar cell says that its
  // outline was made exact within, of a surface
  // kSurfaceSymmetryToleranceRel, of a PSLG or PLC four times the model's own asymmetry, which is
  // nothing where the fold is 1. Never less than rounding, nor in space than the resolution.
  std::optional<double> model_tolerance_rel;
  std::optional<double> min_angle_deg;  // planar: the bound that the mesh was made with
  std::optional<double> model_measure;  // area or volume; nullopt: computed from the model
  // Elements of the cell that may be beyond the bounds of angles and regions: as the statistics count
  // those that min_edge, keep_boundary or divisions left so.
  std::size_t exempt_elements = 0;
  // Of sectors, as they were meshed with; nullopt: the mesher's own.
  std::optional<double> symmetry_tolerance_rel;
  // Of planar models, as they were meshed with (MeshOptions).
  std::optional<std::int32_t> sector;
  std::optional<Point2> center;
  Repair repair = Repair::kSafe;
  std::size_t most_restored_nodes = 200'000'000;  // beyond: full.* without a file are skipped
};

// `full` and `model` may be null.  Cost: O(N log N) for N elements of the full mesh.
[[nodiscard]] VerifyReport verify_mesh(const MeshData& cell,
                                       const MeshData* full,
                                       const Model* model,
                                       const VerifyOptions& options);

}  // namespace symcell
