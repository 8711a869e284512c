// A planar straight line graph as the user gave it: vertices, segments, hole and region seeds. Its
// segments may be circular arcs, which `plane::discretise_arcs` makes chords of.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/geometry/point.hpp"

namespace symcell {

struct PslgSegment {
  std::int32_t a = 0;  // vertex indices, from 0
  std::int32_t b = 0;
  std::int32_t marker = 0;  // 0: none given
  friend bool operator==(const PslgSegment&, const PslgSegment&) = default;
};

struct PslgRegion {
  Point2 point;  // any point inside the subdomain
  std::int32_t attribute = 0;
  double max_area = std::numeric_limits<double>::infinity();  // input units squared; inf: none
  friend bool operator==(const PslgRegion&, const PslgRegion&) = default;
};

// What reading, joining and repairing made of a drawing, for the warnings.
struct PslgNotes {
  std::size_t joined = 0;             // ends that stood beside another
  double widest = 0;                  // the largest distance of those, input units
  std::vector<std::string> left_out;  // what was not read, in words: "3 HATCH"
  std::vector<std::string> repairs;   // what was mended on request, in words
};

// A layer's name and the marker that stands for it.
struct MarkerName {
  std::int32_t marker = 0;
  std::string name;
  friend bool operator==(const MarkerName&, const MarkerName&) = default;
};

struct Pslg {
  std::vector<Point2> vertices;
  std::vector<PslgSegment> segments;
  std::vector<Point2> holes;
  std::vector<PslgRegion> regions;
  // Per segment the tangent of a quarter of the angle that it turns by, from a to b, positive if
  // counter-clockwise; 0: it is straight. Empty: all are. core/geometry/arc.hpp computes with it.
  std::vector<double> bulges = {};
  // Per segment the largest angle of a chord, in radians, where the model gives it; 0, or beyond the
  // end: the option chord_error alone decides.
  std::vector<double> chord_angles = {};
  std::vector<MarkerName> marker_names =
      {};  // by marker; those of the model's source, if it has any
  PslgNotes notes = {};

  [[nodiscard]] double bulge(std::size_t segment) const {
    return segment < bulges.size() ? bulges[segment] : 0;
  }
  [[nodiscard]] double chord_angle(std::size_t segment) const {
    return segment < chord_angles.size() ? chord_angles[segment] : 0;
  }
  [[nodiscard]] bool has_arcs() const {
    return std::any_of(bulges.begin(), bulges.end(), [](double b) { return b != 0; });
  }
};

// More vertices than this are refused (kTooLarge): indices and sizes stay in 32 bits throughout.
inline constexpr std::size_t kMaxPslgVertices = 10'000'000;

}  // namespace symcell
