#include "tests/support/sector_checks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "core/geometry/rotation.hpp"
#include "core/geometry/triangle_tree.hpp"

namespace symcell {
namespace {

using Edge = std::pair<std::int32_t, std::int32_t>;
constexpr double kFar = std::numeric_limits<double>::infinity();

Edge undirected(std::int32_t a, std::int32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

std::vector<Point3> copy_of(const solid::Sector& sector, std::int32_t exponent) {
  const RotationTable rotations(sector.fold);
  std::vector<Point3> points;
  for (const OrbitVertex& v : sector.vertices) {
    points.push_back(
        rotations.rotate(sector.orbit_points[v.orbit], rotations.reduce(v.exponent + exponent)));
  }
  return points;
}

}  // namespace

std::vector<std::string> sector_faults(const solid::Sector& sector) {
  std::vector<std::string> faults;
  std::vector<std::int32_t> higher(sector.orbit_points.size(), -1);
  for (std::size_t i = 0; i < sector.vertices.size(); ++i) {
    const OrbitVertex v = sector.vertices[i];
    if (v.exponent == 1) higher[v.orbit] = static_cast<std::int32_t>(i);
    if (sector.on_axis[v.orbit] == 0) continue;
    const Point3 p = sector.orbit_points[v.orbit];
    if (v.exponent != 0) faults.push_back("a vertex on the axis has exponent 1");
    if (p.x != 0 || p.y != 0) faults.push_back("a vertex on the axis is beside it");
  }
  const auto image = [&](std::int32_t v) {
    const OrbitVertex o = sector.vertices[v];
    return sector.on_axis[o.orbit] != 0 ? v : higher[o.orbit];
  };
  std::set<Edge> cut;
  for (const auto& [a, b] : sector.lower_cut) {
    if (sector.vertices[a].exponent != 0 || sector.vertices[b].exponent != 0) {
      faults.push_back("an edge of the lower cut has a vertex of the higher one");
    }
    cut.insert(undirected(a, b));
    if (image(a) < 0 || image(b) < 0) {
      faults.push_back("an edge of the lower cut has no image");
    } else {
      cut.insert(undirected(image(a), image(b)));
    }
  }
  if (cut.size() != 2 * sector.lower_cut.size()) faults.push_back("edges of the cut coincide");
  std::map<Edge, std::array<int, 2>> uses;
  std::map<Edge, std::vector<std::int32_t>> facets;
  for (const solid::SectorFace& f : sector.faces) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t a = f.v[i], b = f.v[(i + 1) % 3];
      ++uses[undirected(a, b)][a < b ? 0 : 1];
      facets[undirected(a, b)].push_back(f.facet);
    }
  }
  std::set<Edge> edges;
  for (const solid::SectorEdge& e : sector.edges) edges.insert(undirected(e.a, e.b));
  for (const auto& [edge, count] : uses) {
    const bool at_cut = cut.count(edge) > 0;
    if (count[0] + count[1] != (at_cut ? 1 : 2) || (!at_cut && count[0] != count[1])) {
      faults.push_back("an edge has wrong faces");
    }
    const auto& f = facets[edge];
    if (f.size() == 2 && f[0] != f[1] && edges.count(edge) == 0) {
      faults.push_back("an edge between two facets is missing");
    }
  }
  for (const Edge& e : cut) {
    if (uses.count(e) == 0) faults.push_back("an edge of the cut is no face's edge");
  }
  for (const Edge& e : edges) {
    if (uses.count(e) == 0) faults.push_back("an edge is no face's edge");
  }
  // Facets are flat.
  const std::vector<Point3> points = copy_of(sector, 0);
  double extent = 0;
  for (const Point3& p : points) extent = std::max(extent, length(p));
  std::map<std::int32_t, std::vector<std::int32_t>> members;
  for (std::size_t i = 0; i < sector.faces.size(); ++i) {
    members[sector.faces[i].facet].push_back(static_cast<std::int32_t>(i));
  }
  for (const solid::SectorFace& f : sector.faces) {
    if (!(length(area_normal(points[f.v[0]], points[f.v[1]], points[f.v[2]])) > 0)) {
      faults.push_back("a face has no area");
    }
  }
  for (const auto& [edge, sides] : facets) {
    if (sides.size() != 2 || sides[0] != sides[1] || edges.count(edge) > 0) continue;
    // Inside a facet: the opposite corners lie in one plane with the edge.
    std::vector<Point3> apexes;
    for (const std::int32_t m : members[sides[0]]) {
      const auto& v = sector.faces[m].v;
      for (std::size_t i = 0; i < 3; ++i) {
        if (undirected(v[i], v[(i + 1) % 3]) == edge) apexes.push_back(points[v[(i + 2) % 3]]);
      }
    }
    const Point3 a = points[edge.first], b = points[edge.second];
    const Point3 n = cross(b - a, apexes[0] - a);
    if (std::abs(dot(n, apexes[1] - a)) > 1e-9 * extent * length(n)) {
      faults.push_back("a facet is not flat");
    }
  }
  return faults;
}

SectorFigures measure_sector(const solid::Sector& sector,
                             const solid::Symmetry& symmetry,
                             const TriangleSurface& input) {
  SectorFigures figures;
  std::vector<Point3> given;
  for (const Point3& p : input.vertices) given.push_back(symmetry.frame.to_local(p));
  const TriangleTree tree(given, input.triangles);
  std::vector<Point3> all;
  std::vector<Triangle> faces;
  for (std::int32_t k = 0; k < sector.fold; ++k) {
    const std::vector<Point3> points = copy_of(sector, k);
    const auto first = static_cast<std::int32_t>(all.size());
    all.insert(all.end(), points.begin(), points.end());
    for (const solid::SectorFace& f : sector.faces) {
      const Point3 a = points[f.v[0]], b = points[f.v[1]], c = points[f.v[2]];
      figures.volume += dot(a, cross(b, c)) / 6;
      for (const Point3& p : {a, b, c, (1.0 / 3) * (a + b + c)}) {
        figures.off_surface = std::max(figures.off_surface, tree.nearest(p, kFar).squared);
      }
      faces.push_back({f.v[0] + first, f.v[1] + first, f.v[2] + first});
    }
  }
  const TriangleTree restored(all, faces);
  for (const auto& t : input.triangles) {
    const Point3 a = given[t[0]], b = given[t[1]], c = given[t[2]];
    for (const Point3& p : {a, b, c, (1.0 / 3) * (a + b + c)}) {
      figures.uncovered = std::max(figures.uncovered, restored.nearest(p, kFar).squared);
    }
  }
  figures.off_surface = std::sqrt(figures.off_surface);
  figures.uncovered = std::sqrt(figures.uncovered);
  return figures;
}

}  // namespace symcell
