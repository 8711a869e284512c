#include "core/model/polygon_triangles.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "core/base/index.hpp"
#include "core/geometry/facet_triangulation.hpp"
#include "core/geometry/predicates.hpp"

namespace symcell {
namespace {

// Newell's: the sum over the polygon's edges; its length is twice the area.
Point3 normal_of(std::span<const Point3> corners) {
  Point3 normal;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    // Relative to one corner, so that a far origin costs no digits.
    const Point3 p = corners[i] - corners[0];
    const Point3 q = corners[(i + 1) % corners.size()] - corners[0];
    normal.x += (p.y - q.y) * (p.z + q.z);
    normal.y += (p.z - q.z) * (p.x + q.x);
    normal.z += (p.x - q.x) * (p.y + q.y);
  }
  return normal;
}

bool fan_is_good(std::span<const Point3> corners, Point3 normal) {
  const Point2 apex = project_along(normal, corners[0]);
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    if (orientation(apex, project_along(normal, corners[i]),
                    project_along(normal, corners[i + 1])) != Sign::kPositive) {
      return false;
    }
  }
  return true;
}

// Empty if there is none.
std::vector<std::array<std::int32_t, 3>> delaunay_triangles(std::span<const Point3> corners,
                                                            Point3 normal) {
  FacetGraph graph;
  graph.normal = normal;
  const auto count = static_cast<std::int32_t>(corners.size());
  for (std::int32_t i = 0; i < count; ++i) graph.segments.push_back({i, (i + 1) % count});
  auto found = triangulate_facet(corners, graph);
  if (!found) return {};
  return std::move(found->triangles);
}

}  // namespace

Result<void> append_polygon(std::span<const std::int32_t> polygon,
                            std::int32_t face,
                            TriangleSurface& surface) {
  const auto append = [&](std::size_t a, std::size_t b, std::size_t c) {
    surface.triangles.push_back({polygon[a], polygon[b], polygon[c]});
    surface.source_face.push_back(face);
  };
  if (polygon.size() == 3) {
    append(0, 1, 2);
    return {};
  }
  std::vector<std::int32_t> sorted(polygon.begin(), polygon.end());
  std::ranges::sort(sorted);
  if (const auto twice = std::ranges::adjacent_find(sorted); twice != sorted.end()) {
    return fail(ErrorCode::kDegenerateFacet,
                "face " + std::to_string(face) + " of " + std::to_string(polygon.size()) +
                    " corners visits vertex " + std::to_string(*twice) +
                    " twice; cut it into simple polygons",
                {face}, "/faces/" + std::to_string(face));
  }
  std::vector<Point3> corners;
  corners.reserve(polygon.size());
  for (const std::int32_t v : polygon) corners.push_back(surface.vertices[at(v)]);
  const Point3 normal = normal_of(corners);
  const bool flat = normal.x == 0 && normal.y == 0 && normal.z == 0;
  std::vector<std::array<std::int32_t, 3>> triangles;
  if (!flat && !fan_is_good(corners, normal)) triangles = delaunay_triangles(corners, normal);
  for (const auto& t : triangles) append(at(t[0]), at(t[1]), at(t[2]));
  for (std::size_t i = 1; triangles.empty() && i + 1 < polygon.size(); ++i) append(0, i, i + 1);
  return {};
}

}  // namespace symcell
