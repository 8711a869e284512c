#include "tests/support/plc_builders.hpp"

#include <algorithm>
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

Plc ribbed_prism(const RibbedShape& shape) {
  Plc plc;
  const double turn = 2 * std::numbers::pi / shape.sides;
  const auto add = [&](std::int32_t side, Point3 p) {
    const double c = std::cos(turn * side), s = std::sin(turn * side);
    plc.vertices.push_back({c * p.x - s * p.y, s * p.x + c * p.y, p.z});
    return static_cast<std::int32_t>(plc.vertices.size()) - 1;
  };
  const auto add_facet = [&](std::vector<std::int32_t> polygon, std::int32_t marker) {
    PlcFacet facet;
    facet.polygons = {std::move(polygon)};
    facet.marker = marker;
    plc.facets.push_back(std::move(facet));
  };
  const double half_side = shape.apothem * std::tan(turn / 2);
  std::vector<std::int32_t> bottom, corners, top;
  for (std::int32_t k = 0; k < shape.sides; ++k) {
    bottom.push_back(add(k, {shape.apothem, -half_side, 0}));
    corners.push_back(add(k, {shape.apothem, -half_side, shape.height}));
  }
  for (std::int32_t k = 0; k < shape.sides; ++k) {
    const auto i = static_cast<std::size_t>(k), j = static_cast<std::size_t>((k + 1) % shape.sides);
    std::vector<std::int32_t> side{bottom[i], bottom[j], corners[j]};
    top.push_back(corners[i]);
    if (k % shape.every == 0) {
      std::vector<std::int32_t> v;  // outer and inner, low and high, to the right and the left
      for (const double x : {shape.apothem, shape.inner}) {
        for (const double z : {shape.height, shape.height + shape.rib_height}) {
          for (const double y : {-shape.half_width, shape.half_width})
            v.push_back(add(k, {x, y, z}));
        }
      }
      side.insert(side.end(), {v[1], v[3], v[2], v[0]});
      top.insert(top.end(), {v[0], v[4], v[5], v[1]});
      add_facet({v[2], v[3], v[7], v[6]}, 4);
      add_facet({v[4], v[6], v[7], v[5]}, 5);
      add_facet({v[0], v[2], v[6], v[4]}, 6);
      add_facet({v[1], v[5], v[7], v[3]}, 7);
    }
    side.push_back(corners[i]);
    add_facet(std::move(side), 3);
  }
  std::reverse(bottom.begin(), bottom.end());
  add_facet(std::move(bottom), 1);
  add_facet(std::move(top), 2);
  return plc;
}

double ribbed_volume(const RibbedShape& s) {
  const double area = s.sides * s.apothem * s.apothem * std::tan(std::numbers::pi / s.sides);
  const double rib = 2 * s.half_width * (s.apothem - s.inner) * s.rib_height;
  return area * s.height + rib * (s.sides / s.every);
}

Plc bar_through_plate(
    std::int32_t sides, double plate_radius, double bar_radius, double thickness, double length) {
  Plc plc;
  const auto ring = [&](double radius, double z) {
    std::vector<std::int32_t> polygon;
    for (std::int32_t i = 0; i < sides; ++i) {
      const double angle = 2 * std::numbers::pi * i / sides;
      polygon.push_back(static_cast<std::int32_t>(plc.vertices.size()));
      plc.vertices.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
    }
    return polygon;
  };
  const auto walls = [&](const std::vector<std::int32_t>& low,
                         const std::vector<std::int32_t>& high) {
    for (std::size_t i = 0; i < low.size(); ++i) {
      const std::size_t j = (i + 1) % low.size();
      plc.facets.push_back({{{low[i], low[j], high[j], high[i]}}, {}, 3});
    }
  };
  const double reach = (length - thickness) / 2;
  const auto foot = ring(bar_radius, -reach), low = ring(bar_radius, 0),
             high = ring(bar_radius, thickness), head = ring(bar_radius, thickness + reach),
             under = ring(plate_radius, 0), over = ring(plate_radius, thickness);
  plc.facets.push_back({{foot}, {}, 1});
  plc.facets.push_back({{head}, {}, 2});
  plc.facets.push_back({{under, low}, {{0, 0, 0}}, 4});
  plc.facets.push_back({{over, high}, {{0, 0, thickness}}, 5});
  walls(foot, low);
  walls(high, head);
  walls(under, over);
  return plc;
}

}  // namespace symcell::test
