// A PSLG as symmetry sees it: cut at the vertices on its segments, cleared of what the mesh never
// meets, each piece with the class of the faces on its two sides.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/geometry/resolution.hpp"
#include "core/plane/input/subdomains.hpp"

namespace symcell::plane {

inline constexpr std::int32_t kNotMeshed = -2;  // labels of faces
inline constexpr std::int32_t kNoRegion = -1;   // meshed, without a seed

struct PreparedEdge {
  std::int32_t a = 0;
  std::int32_t b = 0;
  std::int32_t marker = 0;
  std::int32_t left = 0;  // class of the face left of a -> b; 0: not meshed
  std::int32_t right = 0;
  std::int32_t left_label = 0;  // kNotMeshed, kNoRegion or the index of the face's region seed
  std::int32_t right_label = 0;
  std::int32_t segment = 0;  // in the input
};

// Invariants: no edge crosses or touches another but at common ends; every edge has a meshed face
// on a side; every vertex has an edge or lies inside the domain. Equal classes mean equal region
// attribute and area bound; with ignore_markers the only classes are 0 and 1, and markers are kept.
struct PreparedPslg {
  std::vector<Point2> points;
  std::vector<std::int32_t> input_vertex;  // per point
  std::vector<PreparedEdge> edges;
  bool ignore_markers = false;
  double diameter = 0;   // of the bounding box of all input vertices
  double magnitude = 0;  // largest absolute coordinate
  double area = 0;       // of the domain
  Point2 centroid;       // of the domain
  Point2 box_low;
  Point2 box_high;

  [[nodiscard]] double resolution() const { return resolution_of(diameter, magnitude); }
};

[[nodiscard]] PreparedPslg prepare_pslg(const Pslg& pslg,
                                        const Subdomains& subdomains,
                                        bool ignore_markers);

}  // namespace symcell::plane
