// What the tests of quotient surfaces share: surfaces to begin with, cut or whole, and checks that
// they are still what quotient_surface.hpp says.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "core/geometry/indexed_surface.hpp"
#include "core/geometry/triangle_tree.hpp"
#include "core/solid/sector/glue_cuts.hpp"
#include "core/solid/sector/wedge_cut.hpp"
#include "core/solid/surface/quotient_surface.hpp"
#include "core/solid/surface/weld.hpp"
#include "tests/support/surface_builders.hpp"

namespace symcell::solid::test {

inline void give_no_patches(QuotientSurface& s) {
  s.planes.clear();
  s.patch.assign(s.triangles.size(), -1);
  s.frame.assign(s.triangles.size(), 0);
}

// The whole surface, uncut and without planar patches.
inline QuotientSurface uncut(const TriangleSurface& surface) {
  const IndexedSurface welded = weld_exactly(surface);
  QuotientSurface s;
  s.points = welded.points;
  s.on_axis.assign(s.points.size(), 0);
  s.on_cut.assign(s.points.size(), 0);
  for (const Triangle& t : welded.triangles) {
    s.triangles.push_back({OrbitVertex{t[0], 0}, {t[1], 0}, {t[2], 0}});
    const Point3 n = area_normal(welded, t);
    s.normals.push_back((1 / length(n)) * n);
  }
  give_no_patches(s);
  return s;
}

// One sector of a surface that is symmetric to within `reach`, without planar patches.
inline QuotientSurface one_sector(const TriangleSurface& surface,
                                  std::int32_t fold,
                                  double angle,
                                  double reach = 1e-9) {
  ExecutionContext context;
  const auto patch = cut_wedge(weld_exactly(surface), fold, angle, 0.1 * reach);
  EXPECT_TRUE(patch);
  if (!patch) return {};
  auto glued = glue_cuts(*patch, reach, 0.3 * reach, context);
  EXPECT_TRUE(glued) << glued.error().message;
  if (!glued) return {};
  give_no_patches(glued->surface);
  return std::move(glued->surface);
}

// Every triangle in four, by the middles of its sides.
inline TriangleSurface divided(const TriangleSurface& surface) {
  TriangleSurface fine;
  const auto add = [&](Point3 a, Point3 b, Point3 c) {
    const auto first = static_cast<std::int32_t>(fine.vertices.size());
    fine.vertices.insert(fine.vertices.end(), {a, b, c});
    fine.triangles.push_back({first, first + 1, first + 2});
  };
  for (const auto& t : surface.triangles) {
    const Point3 a = surface.vertices[t[0]], b = surface.vertices[t[1]], c = surface.vertices[t[2]];
    const Point3 ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
    add(a, ab, ca);
    add(ab, b, bc);
    add(ca, bc, c);
    add(ab, bc, ca);
  }
  return fine;
}

// A sphere of radius 1 from an octahedron, divided so many times: every quarter turn about z maps
// it onto itself.
inline TriangleSurface sphere(int divisions) {
  TriangleSurface s;
  s.vertices = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (std::int32_t i = 0; i < 4; ++i) {
    s.triangles.push_back({i, (i + 1) % 4, 4});
    s.triangles.push_back({(i + 1) % 4, i, 5});
  }
  for (int k = 0; k < divisions; ++k) {
    s = divided(s);
    for (Point3& p : s.vertices) p = (1 / length(p)) * p;
  }
  return s;
}

// All copies; points of one orbit and exponent are one.
inline IndexedSurface restored(const QuotientSurface& s) {
  const RotationTable rotations(s.fold);
  IndexedSurface all;
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> ids;
  for (std::int32_t k = 0; k < s.fold; ++k) {
    for (const QuotientTriangle& t : s.triangles) {
      Triangle corners{};
      for (std::size_t i = 0; i < 3; ++i) {
        const std::int32_t orbit = t[i].orbit;
        const std::int32_t e = s.on_axis[orbit] != 0 ? 0 : rotations.reduce(t[i].exponent + k);
        const auto next = static_cast<std::int32_t>(all.points.size());
        const auto [at, is_new] = ids.insert({{orbit, e}, next});
        if (is_new) all.points.push_back(rotations.rotate(s.points[orbit], e));
        corners[i] = at->second;
      }
      all.triangles.push_back(corners);
    }
  }
  return all;
}

inline double volume_of(const IndexedSurface& surface) {
  return enclosed_volume(surface, surface.points.front());
}

// Every edge has two triangles that run against each other.
[[nodiscard]] inline bool is_closed(const IndexedSurface& surface) {
  const std::vector<EdgeUse> uses = symcell::sorted_edge_uses(surface.triangles);
  bool closed = true;
  for_each_edge(uses, [&](std::size_t begin, std::size_t end) {
    closed = closed && end - begin == 2 && uses[begin].forward != uses[begin + 1].forward;
  });
  return closed;
}

inline std::int64_t euler_characteristic(const IndexedSurface& surface) {
  std::int64_t edges = 0;
  const std::vector<EdgeUse> uses = symcell::sorted_edge_uses(surface.triangles);
  for_each_edge(uses, [&](std::size_t, std::size_t) { ++edges; });
  return static_cast<std::int64_t>(surface.points.size()) - edges +
         static_cast<std::int64_t>(surface.triangles.size());
}

// The invariants that quotient_surface.hpp lists; dead vertices (of no triangle) count for nothing.
inline void expect_sound(const QuotientSurface& s) {
  EXPECT_TRUE(find_neighbours(s));
  EXPECT_TRUE(is_closed(restored(s)));
  const double c = std::cos(s.start_angle), d = std::sin(s.start_angle);
  const double sector = 2 * std::numbers::pi / s.fold;
  double extent = 0;
  for (const Point3& p : s.points) extent = std::max(extent, length(p));
  for (const QuotientTriangle& t : s.triangles) {
    for (const OrbitVertex& v : t) {
      ASSERT_GE(v.orbit, 0);
      const Point3 p = s.points[v.orbit];
      EXPECT_TRUE(v.exponent == 0 ||
                  (v.exponent == 1 && s.on_cut[v.orbit] != 0 && s.on_axis[v.orbit] == 0));
      if (s.on_axis[v.orbit] != 0) {
        EXPECT_EQ(s.on_cut[v.orbit], 1);
        EXPECT_TRUE(p.x == 0 && p.y == 0);
        continue;
      }
      if (s.fold == 1) continue;
      const double along = c * p.x + d * p.y, above = c * p.y - d * p.x;
      if (s.on_cut[v.orbit] != 0) {
        EXPECT_NEAR(above, 0, 1e-14 * extent);
        EXPECT_GT(along, 0);
        continue;
      }
      const double turn = std::atan2(above, along);
      const double angle = turn < 0 ? turn + 2 * std::numbers::pi : turn;
      EXPECT_GT(angle, 0);
      EXPECT_LT(angle, sector);
    }
  }
}

// The largest distance of vertices, middles of sides and of triangles of one surface from the
// other.
inline double distance_from(const IndexedSurface& a, const IndexedSurface& b) {
  const TriangleTree tree(b.points, b.triangles);
  double squared = 0;
  for (const Triangle& t : a.triangles) {
    const Point3 p = a.points[t[0]], q = a.points[t[1]], r = a.points[t[2]];
    for (const Point3& x :
         {p, q, r, 0.5 * (p + q), 0.5 * (q + r), 0.5 * (r + p), (1.0 / 3) * (p + q + r)}) {
      const auto hit = tree.nearest(x, std::numeric_limits<double>::infinity());
      squared = std::max(squared, hit.squared);
    }
  }
  return std::sqrt(squared);
}
// Both ways.
inline double distance_between(const IndexedSurface& a, const IndexedSurface& b) {
  return std::max(distance_from(a, b), distance_from(b, a));
}

// Of a star prism as asymmetric_prism makes it, without twist.
inline double star_volume(const PrismShape& shape) {
  const double area =
      shape.fold * shape.outer * shape.inner_tip * std::sin(std::numbers::pi / shape.fold);
  const double share = shape.bore / shape.outer;
  return shape.height * area * (1 - share * share);
}

}  // namespace symcell::solid::test
