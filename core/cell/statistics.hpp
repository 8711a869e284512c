// Figures of one meshing call, as the interface's statistics document names them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/cell/warning.hpp"
#include "core/geometry/point.hpp"

namespace symcell {

// Longest edge / smallest height; bins <1.5, 1.5-2, 2-2.5, 2.5-3, 3-4, 4-6, 6-10, 10-15, >15.
inline constexpr std::size_t kAspectBins = 9;

struct ExemptCount {
  std::string reason;          // "small_input_angle", "fold_angle_at_centre", ...
  std::uint64_t elements = 0;  // of the cell
};

// Tetrahedra of a cell at one of the folds that a model allows.
struct FoldEstimate {
  std::int32_t fold = 1;
  double elements = 0;  // without improvement and bounds on sizes
  bool meshed = false;  // counted, not estimated from another fold's mesh
};

// The option `curved`: orbits of nodes and edges of a solid's boundary on its curved faces.
struct Curving {
  std::uint64_t faces = 0;         // groups of a known kind
  std::uint64_t other_faces = 0;   // groups without one, which stay as they are tessellated
  std::uint64_t vertices = 0;      // moved onto their faces
  std::uint64_t left = 0;          // vertices that would have folded an element there
  std::uint64_t sides = 0;         // edges with their middle on their faces
  std::uint64_t straightened = 0;  // edges that stay straight, or an element would fold
  double farthest = 0;             // that a vertex was moved, input units
};

struct Statistics {
  struct Cell {
    std::uint64_t elements = 0;
    std::uint64_t nodes = 0;
    std::uint64_t symmetry_nodes = 0;   // nodes with lower_to_higher >= 0
    std::uint64_t symmetry_facets = 0;  // facets of the lower bound
    double measure = 0;                 // area (2D) or volume (3D)
    double min_angle_deg = 0;
    double max_angle_deg = 0;
    double max_radius_edge = 0;   // circumradius / shortest edge
    double min_dihedral_deg = 0;  // 3D only
    double max_dihedral_deg = 0;  // 3D only
    std::array<std::uint64_t, kAspectBins> aspect_ratio_histogram{};
  } cell;

  struct Full {
    std::uint64_t elements = 0;
    std::uint64_t nodes = 0;
  } full;

  struct Symmetry {
    std::int32_t fold = 1;
    Point3 axis_origin;
    Point3 axis_direction{0, 0, 1};
    double error_rel = 0;  // of the model's diameter
    bool detected = false;
    // Planar: the fold ignores markers and attributes, and from sector to sector some of these
    // change to others and back: fields change their sign from cell to cell.
    bool antiperiodic = false;
    // Solids whose fold was chosen: from which, descending; empty: nothing to choose from.
    std::vector<FoldEstimate> candidates;
  } symmetry;

  struct Refinement {
    std::uint64_t steiner_points = 0;  // orbits of vertices in the cell that the input lacks
    std::uint64_t splits = 0;          // subsegments split
    std::uint64_t flips = 0;
    std::uint64_t crossings = 0;  // operations across relative exponent != 0
    std::uint64_t relocations = 0;
    std::uint64_t removed = 0;  // vertices removed by coarsening
  } refinement;

  std::vector<ExemptCount> exempt;

  // The option `elements`: the longest edge that gave the mesh (0: no bound), and meshes made for it.
  struct Target {
    std::uint64_t elements = 0;  // 0: not asked for
    double max_edge = 0;
    int meshes = 0;
  } target;

  std::optional<Curving> curving;

  // What was changed, chosen or nearly fitted.
  std::vector<Warning> warnings;

  // What was mended in a surface, in words that name how many and where; empty: nothing.
  std::vector<std::string> repairs;
  // Solids: whether every unconstrained face is locally Delaunay.
  bool delaunay = true;

  struct TimingsMs {
    double parse = 0;  // filled in by the caller that parsed
    double symmetry = 0;
    double initial = 0;
    double refine = 0;
    double cell = 0;
    double check = 0;    // of the finished mesh against what it was made from
    double restore = 0;  // filled in by the caller that wrote the full mesh
    double write = 0;    // likewise
    double total = 0;
  } timings_ms;

  std::uint64_t peak_memory_bytes = 0;  // of the process
};

}  // namespace symcell
