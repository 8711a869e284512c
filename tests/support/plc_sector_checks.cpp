#include "tests/support/plc_sector_checks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "core/base/index.hpp"
#include "core/geometry/rotation.hpp"

namespace symcell::test {
namespace {

using Pair = std::array<std::int32_t, 2>;

Pair sorted_pair(std::int32_t a, std::int32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

// Volume of a surface whose edges all have two faces, oriented by walking across them; components
// inside others do not occur in these tests, so the parts add up.
double volume_of(const RestoredSurface& surface,
                 const std::map<Pair, std::vector<Pair>>& faces_of) {
  std::vector<int> sign(surface.faces.size(), 0);
  double total = 0;
  for (std::size_t seed = 0; seed < sign.size(); ++seed) {
    if (sign[seed] != 0) continue;
    double part = 0;
    std::vector<std::size_t> stack{seed};
    sign[seed] = 1;
    while (!stack.empty()) {
      const std::size_t f = stack.back();
      stack.pop_back();
      const auto& v = surface.faces[f];
      part +=
          sign[f] *
          dot(surface.points[at(v[0])], cross(surface.points[at(v[1])], surface.points[at(v[2])])) /
          6;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::int32_t a = v[i], b = v[(i + 1) % 3];
        for (const Pair& other : faces_of.at(sorted_pair(a, b))) {
          const std::size_t g = at(other[0]);
          if (g == f || sign[g] != 0) continue;
          const bool same_way = (a < b) == (other[1] == 1);
          sign[g] = same_way ? -sign[f] : sign[f];
          stack.push_back(g);
        }
      }
    }
    total += std::abs(part);
  }
  return total;
}

}  // namespace

RestoredSurface restore_surface(const solid::Sector& sector) {
  const RotationTable rotations(sector.fold);
  RestoredSurface surface;
  surface.facet_area.assign(sector.facet_markers.size(), 0);
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> index;
  const auto vertex = [&](std::int32_t v, std::int32_t k) {
    const OrbitVertex o = sector.vertices[at(v)];
    const std::int32_t e =
        sector.on_axis[at(o.orbit)] != 0 ? 0 : rotations.reduce(std::int64_t{o.exponent} + k);
    const auto [it, fresh] =
        index.try_emplace({o.orbit, e}, static_cast<std::int32_t>(surface.points.size()));
    if (fresh) surface.points.push_back(rotations.rotate(sector.orbit_points[at(o.orbit)], e));
    return it->second;
  };
  std::map<Pair, std::vector<Pair>> faces_of;  // edge -> (face, direction)
  std::set<std::array<std::int32_t, 3>> known;
  for (std::int32_t k = 0; k < sector.fold; ++k) {
    for (const solid::SectorFace& face : sector.faces) {
      const std::array<std::int32_t, 3> v{vertex(face.v[0], k), vertex(face.v[1], k),
                                          vertex(face.v[2], k)};
      std::array<std::int32_t, 3> sorted = v;
      std::sort(sorted.begin(), sorted.end());
      EXPECT_TRUE(known.insert(sorted).second) << "a face occurs twice";
      const auto f = static_cast<std::int32_t>(surface.faces.size());
      for (std::size_t i = 0; i < 3; ++i) {
        const std::int32_t a = v[i], b = v[(i + 1) % 3];
        faces_of[sorted_pair(a, b)].push_back({f, a < b ? 1 : 0});
      }
      surface.faces.push_back(v);
      surface.facet.push_back(face.facet);
      const Point3 p = surface.points[at(v[0])];
      const double area =
          0.5 * length(cross(surface.points[at(v[1])] - p, surface.points[at(v[2])] - p));
      EXPECT_GT(area, 0) << "a face without area";
      surface.facet_area[at(face.facet)] += area;
    }
    for (const solid::SectorEdge& edge : sector.edges) {
      if (k > 0 && sector.on_axis[at(sector.vertices[at(edge.a)].orbit)] != 0 &&
          sector.on_axis[at(sector.vertices[at(edge.b)].orbit)] != 0) {
        continue;
      }
      surface.segment_length +=
          distance(surface.points[at(vertex(edge.a, k))], surface.points[at(vertex(edge.b, k))]);
    }
  }
  bool manifold = true;
  for (const auto& [edge, faces] : faces_of) {
    if (faces.size() % 2 != 0) surface.closed = false;
    if (faces.size() != 2) manifold = false;
  }
  if (surface.closed && manifold) surface.volume = volume_of(surface, faces_of);
  return surface;
}

void expect_sound_sector(const solid::Sector& sector) {
  ASSERT_EQ(sector.kinds.size(), sector.orbit_points.size());
  ASSERT_EQ(sector.on_axis.size(), sector.orbit_points.size());
  const RotationTable rotations(sector.fold);
  const double wedge = 2 * std::numbers::pi / sector.fold;
  double size = 0;
  for (const Point3 p : sector.orbit_points) size = std::max(size, length(p));

  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> index;
  for (std::size_t v = 0; v < sector.vertices.size(); ++v) {
    const OrbitVertex o = sector.vertices[v];
    ASSERT_TRUE(o.exponent == 0 || o.exponent == 1);
    EXPECT_TRUE((index.try_emplace({o.orbit, o.exponent}, static_cast<std::int32_t>(v)).second));
    const Point3 p = sector.orbit_points[at(o.orbit)];
    if (sector.on_axis[at(o.orbit)] != 0) {
      EXPECT_EQ(o.exponent, 0);
      EXPECT_EQ(p.x, 0);
      EXPECT_EQ(p.y, 0);
      continue;
    }
    double turn = std::fmod(std::atan2(p.y, p.x) - sector.start_angle + 4 * std::numbers::pi,
                            2 * std::numbers::pi);
    if (turn > 2 * std::numbers::pi - 1e-9) turn = 0;
    EXPECT_LE(turn, wedge + 1e-9) << "orbit " << o.orbit << " lies outside the wedge";
  }
  for (const auto& [key, v] : index) {
    EXPECT_TRUE(key.second == 0 || index.contains({key.first, 0}));
  }

  std::map<Pair, std::vector<std::int32_t>> faces_of;
  for (const solid::SectorFace& face : sector.faces) {
    for (std::size_t i = 0; i < 3; ++i) {
      faces_of[sorted_pair(face.v[i], face.v[(i + 1) % 3])].push_back(face.facet);
    }
  }
  std::set<Pair> segments;
  for (const solid::SectorEdge& e : sector.edges) {
    EXPECT_TRUE(segments.insert(sorted_pair(e.a, e.b)).second) << "an edge occurs twice";
    ASSERT_LT(at(e.segment), sector.segment_markers.size());
  }
  std::set<Pair> cut;
  const auto higher = [&](std::int32_t v) {
    const OrbitVertex o = sector.vertices[at(v)];
    if (sector.on_axis[at(o.orbit)] != 0) return v;
    const auto it = index.find({o.orbit, 1});
    return it == index.end() ? -1 : it->second;
  };
  for (const Pair& e : sector.lower_cut) {
    for (const std::int32_t v : e) {
      EXPECT_EQ(sector.vertices[at(v)].exponent, 0);
      ASSERT_GE(higher(v), 0);
    }
    const Pair low = sorted_pair(e[0], e[1]);
    const Pair high = sorted_pair(higher(e[0]), higher(e[1]));
    EXPECT_TRUE(cut.insert(low).second) << "a cut edge occurs twice";
    EXPECT_TRUE(cut.insert(high).second || sector.fold == 2) << "a cut edge occurs twice";
    ASSERT_TRUE(faces_of.contains(low));
    ASSERT_TRUE(faces_of.contains(high));
    EXPECT_EQ(faces_of[low], faces_of[high]);
  }
  for (const auto& [edge, facets] : faces_of) {
    // Not an edge between two faces of one facet: a segment, or on the cut.
    const bool smooth = facets.size() == 2 && facets[0] == facets[1];
    if (!smooth && !cut.contains(edge)) {
      EXPECT_TRUE(segments.contains(edge)) << edge[0] << "-" << edge[1];
    }
  }
}

}  // namespace symcell::test
