// A planar straight line graph as the user gave it: vertices, segments, hole and region seeds.
#pragma once

#include <cstdint>
#include <limits>
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

struct Pslg {
  std::vector<Point2> vertices;
  std::vector<PslgSegment> segments;
  std::vector<Point2> holes;
  std::vector<PslgRegion> regions;
};

// More vertices than this are refused (kTooLarge): indices and sizes stay in 32 bits throughout.
inline constexpr std::size_t kMaxPslgVertices = 10'000'000;

}  // namespace symcell
