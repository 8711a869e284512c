#include "tests/support/plc_builders.hpp"

#include <cmath>
#include <numbers>
#include <utility>

namespace symcell::test {

std::int32_t add_box(Plc& plc, Point3 low, Point3 high, std::int32_t marker) {
  const auto first = static_cast<std::int32_t>(plc.vertices.size());
  for (int v = 0; v < 8; ++v) {
    plc.vertices.push_back({(v & 1) != 0 ? high.x : low.x, (v & 2) != 0 ? high.y : low.y,
                            (v & 4) != 0 ? high.z : low.z});
  }
  const std::vector<std::vector<std::int32_t>> sides{{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                                     {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (std::vector<std::int32_t> side : sides) {
    for (std::int32_t& v : side) v += first;
    PlcFacet facet;
    facet.polygons = {std::move(side)};
    facet.marker = marker;
    plc.facets.push_back(std::move(facet));
  }
  return first;
}

Plc box(Point3 low, Point3 high) {
  Plc plc;
  add_box(plc, low, high);
  return plc;
}

Plc prism(std::int32_t corners, double radius, double height) {
  Plc plc;
  PlcFacet bottom, top;
  bottom.polygons.emplace_back();
  top.polygons.emplace_back();
  for (const double z : {0.0, height}) {
    for (std::int32_t i = 0; i < corners; ++i) {
      const double angle = 2 * std::numbers::pi * i / corners;
      plc.vertices.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
      (z == 0 ? bottom : top).polygons.front().push_back(z == 0 ? i : corners + i);
    }
  }
  bottom.marker = 1;
  top.marker = 2;
  plc.facets = {bottom, top};
  for (std::int32_t i = 0; i < corners; ++i) {
    const std::int32_t j = (i + 1) % corners;
    PlcFacet side;
    side.polygons = {{i, j, corners + j, corners + i}};
    side.marker = 3;
    plc.facets.push_back(side);
  }
  return plc;
}

}  // namespace symcell::test
