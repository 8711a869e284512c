#include "core/solid/plc/plc_complex.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "core/base/index.hpp"
#include "core/geometry/indexed_surface.hpp"
#include "core/geometry/predicates.hpp"
#include "core/model/describe.hpp"

namespace symcell::solid {
namespace {

// The segments of a facet: the sides of its polygons, each once.
std::vector<IndexPair> sides_of(const PlcFacet& facet) {
  std::vector<IndexPair> sides;
  for (const std::vector<std::int32_t>& polygon : facet.polygons) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const std::int32_t u = polygon[i];
      const std::int32_t v = polygon[(i + 1) % polygon.size()];
      if (u != v) sides.push_back({std::min(u, v), std::max(u, v)});
    }
  }
  std::sort(sides.begin(), sides.end());
  sides.erase(std::unique(sides.begin(), sides.end()), sides.end());
  return sides;
}

// Vertices of polygons of one vertex, which stand for a point in the facet.
std::vector<std::int32_t> lone_points(const PlcFacet& facet) {
  std::vector<std::int32_t> points;
  for (const std::vector<std::int32_t>& polygon : facet.polygons) {
    if (polygon.size() == 1) points.push_back(polygon.front());
  }
  return points;
}

void measure_box(PlcComplex& complex) {
  if (complex.points.empty()) return;
  const Box3 box = bounding_box(complex.points);
  complex.box_low = box.low;
  complex.box_high = box.high;
  complex.diameter = box.diagonal();
  complex.magnitude = box.magnitude();
}

}  // namespace

void collect_facet_edges(PlcComplex& complex) {
  for (const ComplexFacet& facet : complex.facets) {
    for (const IndexPair& s : facet.graph.segments) complex.edges.push_back({s[0], s[1], 0});
  }
  std::sort(complex.edges.begin(), complex.edges.end(),
            [](const ComplexEdge& e, const ComplexEdge& f) {
              return std::tuple(e.a, e.b, e.marker == 0, -std::int64_t{e.marker}) <
                     std::tuple(f.a, f.b, f.marker == 0, -std::int64_t{f.marker});
            });
  complex.edges.erase(std::unique(complex.edges.begin(), complex.edges.end(),
                                  [](const ComplexEdge& e, const ComplexEdge& f) {
                                    return e.a == f.a && e.b == f.b;
                                  }),
                      complex.edges.end());
  for (ComplexFacet& facet : complex.facets) {
    facet.edges.clear();
    for (const IndexPair& s : facet.graph.segments) {
      const auto it = std::lower_bound(complex.edges.begin(), complex.edges.end(), s,
                                       [](const ComplexEdge& e, const IndexPair& pair) {
                                         return IndexPair{e.a, e.b} < pair;
                                       });
      facet.edges.push_back(static_cast<std::int32_t>(it - complex.edges.begin()));
    }
  }
}

bool covers(std::span<const Point3> points, const ComplexFacet& facet, Point3 p) {
  const auto flat = [&](Point3 q) { return project_along(facet.graph.normal, q); };
  const Point2 q = flat(p);
  return std::any_of(
      facet.triangles.triangles.begin(), facet.triangles.triangles.end(), [&](const auto& t) {
        const Point2 a = flat(points[at(t[0])]);
        const Point2 b = flat(points[at(t[1])]);
        const Point2 c = flat(points[at(t[2])]);
        return orientation(a, b, q) != Sign::kNegative && orientation(b, c, q) != Sign::kNegative &&
               orientation(c, a, q) != Sign::kNegative;
      });
}

Point3 facet_normal(const Plc& plc, const PlcFacet& facet) {
  // The sum over the polygon with the largest one is the most precise; a polygon that crosses
  // itself may have none, then three points far apart determine the plane.
  Point3 best;
  std::vector<Point3> points;
  for (const std::vector<std::int32_t>& polygon : facet.polygons) {
    for (const std::int32_t v : polygon) points.push_back(plc.vertices[at(v)]);
    if (polygon.size() < 3) continue;
    const Point3 base = plc.vertices[at(polygon.front())];
    Point3 sum;
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
      sum =
          sum + cross(plc.vertices[at(polygon[i])] - base, plc.vertices[at(polygon[i + 1])] - base);
    }
    if (squared_length(sum) > squared_length(best)) best = sum;
  }
  if (points.empty()) return {0, 0, 0};
  const Point3 base = points.front();
  Point3 far, wide;
  for (const Point3 p : points) {
    if (squared_length(p - base) > squared_length(far)) far = p - base;
  }
  for (const Point3 p : points) {
    const Point3 n = cross(far, p - base);
    if (squared_length(n) > squared_length(wide)) wide = n;
  }
  constexpr double kFlat = 1e-12;  // width over length below which there is no plane but noise
  if (length(wide) <= kFlat * squared_length(far)) return {0, 0, 0};
  constexpr double kCancelled = 1e-9;  // of the widest triangle: less is a sum that cancelled
  if (length(best) <= kCancelled * length(wide)) best = wide;
  return (1 / length(best)) * best;
}

Result<PlcComplex> make_plc_complex(const Plc& plc, ExecutionContext& context) {
  PlcComplex complex;
  complex.points = plc.vertices;
  complex.holes = plc.holes;
  complex.regions = plc.regions;
  measure_box(complex);
  for (std::size_t f = 0; f < plc.facets.size(); ++f) {
    if (f % 64 == 0) {
      SYMCELL_TRY(context.check());
    }
    ComplexFacet facet;
    facet.graph.normal = facet_normal(plc, plc.facets[f]);
    facet.graph.segments = sides_of(plc.facets[f]);
    facet.graph.points = lone_points(plc.facets[f]);
    facet.graph.holes = plc.facets[f].holes;
    facet.marker = plc.facets[f].marker;
    facet.source = static_cast<std::int32_t>(f);
    auto triangles = triangulate_facet(complex.points, facet.graph);
    if (!triangles) {
      Error error = triangles.error();
      error.message = "facet " + std::to_string(f) + ": " + error.message + "; mend its polygons";
      error.elements.insert(error.elements.begin(), static_cast<std::int64_t>(f));
      error.pointer = "/facets/" + std::to_string(f);
      return fail(error);
    }
    facet.triangles = std::move(*triangles);
    complex.facets.push_back(std::move(facet));
  }
  for (const PlcSegment& s : plc.segments) {
    complex.edges.push_back({std::min(s.a, s.b), std::max(s.a, s.b), s.marker});
  }
  collect_facet_edges(complex);
  return complex;
}

}  // namespace symcell::solid
