// The options of one meshing call, already checked for type and range by the API layer.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/point.hpp"

namespace symcell {
// "No bound"; the largest angle bound, which few models can reach (docs/reference.md).
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kMaxMinAngleDeg = 42.0;
// Exponents fit 16 bits in the triangulation; no real part comes near it.
inline constexpr std::int32_t kMaxFold = 30'000;

// Chords of 52 degrees: coarser ones are no longer a picture of an arc.
inline constexpr double kMaxChordErrorRel = 0.1;

// Of tessellated surfaces: an edge at which they turn by more lies between two faces. Below 90, or the
// sides of a box are one.
inline constexpr double kDefaultFeatureAngleDeg = 30;
inline constexpr double kMostFeatureAngleDeg = 89;

// Edges that grow by less than this factor leave hardly any freedom to a mesh of triangles.
inline constexpr double kLeastGradation = 1.05;
// More parts of one segment than that are a mistake.
inline constexpr std::int32_t kMostDivisions = 1'000'000;

inline constexpr double kExactSymmetryToleranceRel = 1e-6;    // PSLG and PLC
inline constexpr double kSurfaceSymmetryToleranceRel = 1e-3;  // tessellated surfaces

// What may be done to a surface that is not closed, oriented and free of self-intersections.
enum class Repair : std::uint8_t {
  kNone,  // equal vertices are joined
  kSafe,  // and what leaves the shape as it is, within the symmetry tolerance
  kAll,   // and holes are closed, parts below the tolerance dropped
  kWrap   // and where all that does not help the triangles are wrapped as they are
};

// A largest edge length where it is wanted.
struct SizeRequest {
  enum class Kind : std::uint8_t { kMarker, kVertex, kGroup, kRegion, kPoint };
  Kind kind = Kind::kMarker;
  // A marker: of edges on its segments or facets; a vertex: of edges at it, from 0; a region's attribute.
  std::int64_t id = 0;
  double size = 0;         // input units
  std::string group = {};  // a marker by its name
  Point3 point = {};       // solids: of edges there, and at its copies
  friend bool operator==(const SizeRequest&, const SizeRequest&) = default;
};

// Elements across the smallest feature of a solid, a name for a number (core/solid/sizes).
enum class Preset : std::uint8_t { kNone, kCoarse, kNormal, kFine };

// Equal parts of the segments of a marker, on which refinement puts no more points.
struct DivisionRequest {
  std::int64_t marker = 0;
  std::int32_t parts = 1;
  friend bool operator==(const DivisionRequest&, const DivisionRequest&) = default;
};

// Values are what a user writes in `options`; infinities mean "no bound".
struct MeshOptions {
  std::optional<std::int32_t> fold;  // nullopt: detect; 1: no symmetry
  bool largest_fold =
      false;  // of solids whose fold is detected: not the one with the smallest cell
  bool ignore_markers = false;        // markers and region attributes take no part in the symmetry
  bool keep_vertices = false;         // planar: every vertex is a node, and so are its images
  std::optional<Point2> center;       // planar; nullopt: detect
  std::optional<Point3> axis_origin;  // solids; nullopt: detect
  std::optional<Point3> axis_direction;  // solids; nullopt: detect; not the zero vector
  // Of the model's diameter (bounding-box diagonal); nullopt: the default of the kind of model.
  std::optional<double> symmetry_tolerance_rel;
  double min_angle_deg = 30;      // planar
  double max_area = kInfinity;    // planar; input units squared
  double radius_edge = 1.414;     // solids: circumradius / shortest edge
  double max_volume = kInfinity;  // solids; input units cubed
  double min_dihedral_deg = 0;    // solids: a goal of the improvement, not a promise
  Repair repair = Repair::kSafe;  // surfaces
  // Surfaces: groups of faces; 0: none; nullopt: the default, or the groups that the file names.
  std::optional<double> feature_angle_deg;
  bool delaunay = false;        // solids: end with a Delaunay mesh
  double max_edge = kInfinity;  // input units
  double min_edge = 0;          // input units; of edges that refinement makes
  std::vector<SizeRequest> sizes;
  double gradation = kInfinity;            // how much longer an edge may be than the next one
  Preset preset = Preset::kNone;           // solids
  std::uint64_t target_elements = 0;       // solids: of the cell, by one size for all; 0: none
  std::vector<DivisionRequest> divisions;  // planar
  bool keep_boundary = false;              // planar: no new points on what bounds the domain
  // Planar: the model is one of that many equal sectors about the centre; nullopt: it is whole.
  std::optional<std::int32_t> sector;
  double chord_error_rel = 1e-3;   // of chords from their arcs, of the radius
  bool chord_error_given = false;  // solids: edges on curved groups are bounded by it
  std::int32_t order = 1;          // 1: linear, 2: quadratic with mid-side nodes
  // Surfaces: nodes of the boundary lie on the faces, where these are planes, cylinders, cones, spheres or
  // tori: of CAD files vertices, of order 2 vertices and mid-side nodes. nullopt: of CAD files, whose faces
  // are known; of tessellations they are a guess, and the file itself is chords.
  std::optional<bool> curved;
  std::uint64_t max_elements = 50'000'000;  // of the cell
  double time_limit_s = kInfinity;
  std::uint64_t memory_limit_bytes = 0;  // of the process that meshes; 0: none
  std::uint64_t seed = 0;
  // Plain Delaunay refinement only: no relocation, no coarsening. For comparison and benchmarks.
  bool plain = false;
  bool strict = false;  // warnings are errors
  // Comparisons with figures of the statistics, "cell.min_dihedral_deg<20": a mesh that one is true of is
  // an error. What they mean is the API's affair.
  std::vector<std::string> fail_on;
};

}  // namespace symcell
