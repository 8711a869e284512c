// A piecewise linear complex as the user gave it: vertices, facets, free segments, hole and region
// seeds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/geometry/point.hpp"

namespace symcell {

// Planar; several polygons (the outer boundary and those of holes, in any order), any of which may
// have two vertices only (a segment within the facet) when another has three or more.
struct PlcFacet {
  std::vector<std::vector<std::int32_t>> polygons;  // vertex indices, from 0
  std::vector<Point3> holes;                        // points inside the facet's holes
  std::int32_t marker = 0;                          // 0: none given
  friend bool operator==(const PlcFacet&, const PlcFacet&) = default;
};

// A segment that need not be part of a facet.
struct PlcSegment {
  std::int32_t a = 0;
  std::int32_t b = 0;
  std::int32_t marker = 0;
  friend bool operator==(const PlcSegment&, const PlcSegment&) = default;
};

struct PlcRegion {
  Point3 point;  // any point inside the subdomain
  std::int32_t attribute = 0;
  double max_volume = std::numeric_limits<double>::infinity();  // input units cubed; inf: none
  friend bool operator==(const PlcRegion&, const PlcRegion&) = default;
};

struct Plc {
  std::vector<Point3> vertices;
  std::vector<PlcFacet> facets;
  std::vector<PlcSegment> segments;
  std::vector<Point3> holes;  // points inside volume holes
  std::vector<PlcRegion> regions;
};

// More than these are refused (kTooLarge): indices and sizes stay in 32 bits throughout.
inline constexpr std::size_t kMaxPlcVertices = 10'000'000;
inline constexpr std::size_t kMaxPlcCorners = 40'000'000;  // of all polygons together

}  // namespace symcell
