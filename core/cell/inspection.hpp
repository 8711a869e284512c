// What `symcell inspect` reports of a model, without meshing it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/cell/face_group.hpp"
#include "core/cell/warning.hpp"
#include "core/geometry/point.hpp"

namespace symcell {

// Folds are listed up to so many symmetry tolerances, and up to so large a fold beyond the first of
// them.
inline constexpr double kNearTolerances = 10;
inline constexpr std::int32_t kMostNearFold = 64;

// One rung of the ladder of folds that fit the model, if only nearly.
struct FoldCandidate {
  std::int32_t fold = 1;
  double error_rel = 0;   // largest distance of a rotated vertex from the shape / diameter
  bool accepted = false;  // whether the fold, if given, would be accepted about this axis
  // The place of the error: a point of the model that misses the shape when it is turned.
  std::optional<Point3> worst = {};
  // Accepted if given, but never by detection: another fold fits so much better.
  bool ruled_out = false;
};

struct PslgInspection {
  std::int32_t fold = 1;
  std::int32_t geometry_fold = 1;  // with markers and region attributes set aside
  Point2 centre;
  double symmetry_error_rel = 0;
  double area = 0;  // of the meshed domain
  double diameter = 0;
  Point2 bbox_min;
  Point2 bbox_max;
  std::size_t vertices = 0;
  std::size_t segments = 0;
  std::size_t holes = 0;             // hole seeds
  std::size_t regions = 0;           // region seeds
  std::size_t components = 0;        // edge-connected pieces of the domain
  double min_input_angle_deg = 0;    // smallest angle between segments at a vertex, in the domain
  std::vector<FoldCandidate> folds;  // ascending
  std::vector<Warning> warnings;
};

struct SolidInspection {
  std::string kind;  // "plc" or "surface"
  std::int32_t fold = 1;
  Point3 axis_origin;
  Point3 axis_direction{0, 0, 1};
  double symmetry_error_rel = 0;
  double volume = 0;        // of the meshed domain (PLC: 0 if it is not known without meshing)
  double surface_area = 0;  // surfaces only
  double diameter = 0;
  Point3 bbox_min;
  Point3 bbox_max;
  bool watertight = true;
  std::size_t vertices = 0;
  std::size_t facets = 0;  // facets of a PLC, triangles of a surface, after cleaning
  std::size_t shells = 0;  // surfaces: closed components
  std::size_t holes = 0;
  std::size_t regions = 0;
  std::vector<std::string> repairs;
  std::vector<FaceGroup> groups;     // surfaces: of faces, by number
  std::vector<FoldCandidate> folds;  // the ladder, ascending
  std::vector<Warning> warnings;
  // Not empty: why a mesh of this model would be refused (open, self-intersecting, ambiguous).
  std::string problem;
  // Of surfaces that are refused: the faces that the problem names, in input numbering.
  std::vector<std::int64_t> at_fault;
};

using Inspection = std::variant<PslgInspection, SolidInspection>;

}  // namespace symcell
