#include "core/solid/plc/validate_plc.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>

#include "core/base/index.hpp"
#include "core/geometry/limits.hpp"
#include "core/geometry/point_tree.hpp"
#include "core/geometry/resolution.hpp"
#include "core/geometry/tolerances.hpp"
#include "core/model/describe.hpp"
#include "core/solid/plc/conform_plc.hpp"
#include "core/solid/plc/plc_intersections.hpp"

namespace symcell::solid {
namespace {

std::string pointer_to(const char* array, std::size_t index) {
  return "/" + std::string(array) + "/" + std::to_string(index);
}

std::string describe_vertex(const Plc& plc, std::int32_t v) {
  return "vertex " + std::to_string(v) + " at " + describe_point(plc.vertices[at(v)]);
}

Result<void> check_size(const Plc& plc) {
  std::size_t corners = 0;
  for (const PlcFacet& facet : plc.facets) {
    for (const auto& polygon : facet.polygons) corners += polygon.size();
    corners += facet.holes.size();
  }
  const auto check = [](const char* what, std::size_t count, std::size_t limit) -> Result<void> {
    if (count <= limit) return {};
    return fail(ErrorCode::kTooLarge, std::to_string(count) + " " + what +
                                          " are more than the limit of " + std::to_string(limit) +
                                          "; simplify the model");
  };
  SYMCELL_TRY(check("vertices", plc.vertices.size(), kMaxPlcVertices));
  SYMCELL_TRY(check("corners of facets", corners, kMaxPlcCorners));
  SYMCELL_TRY(check("segments", plc.segments.size(), kMaxPlcCorners));
  SYMCELL_TRY(check("holes", plc.holes.size(), kMaxPlcVertices));
  return check("regions", plc.regions.size(), kMaxPlcVertices);
}

Result<void> check_point(Point3 p,
                         const std::string& name,
                         std::int64_t index,
                         std::string pointer) {
  if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
    return fail(ErrorCode::kNonFinite,
                name + " has a coordinate that is not a finite number; give finite coordinates",
                {index}, std::move(pointer));
  }
  if (std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) > kMaxCoordinate) {
    return fail(ErrorCode::kCoordinateRange,
                name + " at " + describe_point(p) + " exceeds the largest coordinate of " +
                    describe_number(kMaxCoordinate) + "; use another length unit",
                {index}, std::move(pointer));
  }
  return {};
}

Result<void> check_points(const Plc& plc) {
  for (std::size_t i = 0; i < plc.vertices.size(); ++i) {
    SYMCELL_TRY(check_point(plc.vertices[i], "vertex " + std::to_string(i),
                            static_cast<std::int64_t>(i), pointer_to("vertices", i)));
  }
  for (std::size_t i = 0; i < plc.holes.size(); ++i) {
    SYMCELL_TRY(check_point(plc.holes[i], "hole seed " + std::to_string(i),
                            static_cast<std::int64_t>(i), pointer_to("holes", i)));
  }
  for (std::size_t i = 0; i < plc.regions.size(); ++i) {
    SYMCELL_TRY(check_point(plc.regions[i].point, "region seed " + std::to_string(i),
                            static_cast<std::int64_t>(i), pointer_to("regions", i)));
  }
  for (std::size_t f = 0; f < plc.facets.size(); ++f) {
    for (std::size_t i = 0; i < plc.facets[f].holes.size(); ++i) {
      SYMCELL_TRY(check_point(plc.facets[f].holes[i],
                              "hole point " + std::to_string(i) + " of facet " + std::to_string(f),
                              static_cast<std::int64_t>(f),
                              pointer_to("facets", f) + pointer_to("holes", i)));
    }
  }
  return {};
}

Result<void> check_index(const Plc& plc,
                         std::int32_t v,
                         const std::string& owner,
                         std::size_t index,
                         std::string pointer) {
  const auto count = static_cast<std::int64_t>(plc.vertices.size());
  if (v >= 0 && v < count) return {};
  return fail(ErrorCode::kIndexOutOfRange,
              owner + " refers to vertex " + std::to_string(v) +
                  ", but vertices are numbered 0 to " + std::to_string(count - 1),
              {static_cast<std::int64_t>(index)}, std::move(pointer));
}

Result<void> check_indices(const Plc& plc) {
  for (std::size_t f = 0; f < plc.facets.size(); ++f) {
    for (std::size_t p = 0; p < plc.facets[f].polygons.size(); ++p) {
      for (const std::int32_t v : plc.facets[f].polygons[p]) {
        SYMCELL_TRY(check_index(plc, v, "facet " + std::to_string(f), f,
                                pointer_to("facets", f) + pointer_to("polygons", p)));
      }
    }
  }
  for (std::size_t s = 0; s < plc.segments.size(); ++s) {
    for (const std::int32_t v : {plc.segments[s].a, plc.segments[s].b}) {
      SYMCELL_TRY(
          check_index(plc, v, "segment " + std::to_string(s), s, pointer_to("segments", s)));
    }
    if (plc.segments[s].a == plc.segments[s].b) {
      return fail(ErrorCode::kZeroLengthSegment,
                  "segment " + std::to_string(s) + " joins " +
                      describe_vertex(plc, plc.segments[s].a) + " to itself; remove it",
                  {static_cast<std::int64_t>(s)}, pointer_to("segments", s));
    }
  }
  return {};
}

Result<void> check_duplicates(const Plc& plc) {
  std::vector<std::int32_t> order(plc.vertices.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::int32_t>(i);
  std::sort(order.begin(), order.end(), [&](std::int32_t i, std::int32_t j) {
    const Point3 p = plc.vertices[at(i)];
    const Point3 q = plc.vertices[at(j)];
    return std::tie(p.x, p.y, p.z, i) < std::tie(q.x, q.y, q.z, j);
  });
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (plc.vertices[at(order[i - 1])] != plc.vertices[at(order[i])]) continue;
    return fail(ErrorCode::kDuplicateVertices,
                describe_duplicates(order[i - 1], order[i],
                                    describe_point(plc.vertices[at(order[i])]), "facets"),
                {order[i - 1], order[i]}, pointer_to("vertices", at(order[i])));
  }
  return {};
}

// Vertices nearer to each other than coordinates of this size resolve are one: as two they would be
// features that no check of a mesh can distinguish from faults.
Result<void> check_near_duplicates(const Plc& plc, double diameter) {
  double magnitude = 0;
  for (const Point3 p : plc.vertices) {
    magnitude = std::max({magnitude, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  }
  const double resolution = resolution_of(diameter, magnitude);
  const Point3 reach{resolution, resolution, resolution};
  const PointTree tree(plc.vertices);
  for (std::size_t i = 0; i < plc.vertices.size(); ++i) {
    const Point3 p = plc.vertices[i];
    const auto id = static_cast<std::int32_t>(i);
    std::int32_t near = -1;
    tree.within_box(p - reach, p + reach, [&](std::int32_t j) {
      if (j < id && distance(p, plc.vertices[at(j)]) <= resolution) near = std::max(near, j);
    });
    if (near < 0) continue;
    return fail(ErrorCode::kDuplicateVertices,
                describe_near_duplicates(near, id, describe_point(p),
                                         distance(p, plc.vertices[at(near)]), "facets"),
                {near, id}, pointer_to("vertices", i));
  }
  return {};
}

Result<double> check_extent(const Plc& plc) {
  if (plc.vertices.size() < 4 || plc.facets.empty()) {
    return fail(ErrorCode::kDegenerateGeometry,
                "the model has " + std::to_string(plc.vertices.size()) + " vertices and " +
                    std::to_string(plc.facets.size()) +
                    " facets, which enclose no volume; give a closed surface");
  }
  Point3 low = plc.vertices.front();
  Point3 high = low;
  for (const Point3 p : plc.vertices) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const double diameter = distance(low, high);
  if (diameter < 1 / kMaxCoordinate) {
    return fail(ErrorCode::kCoordinateRange, "the model's extent of " + describe_number(diameter) +
                                                 " is below the smallest of " +
                                                 describe_number(1 / kMaxCoordinate) +
                                                 "; use another length unit");
  }
  return diameter;
}

const std::vector<std::int32_t>& longest_polygon(const PlcFacet& facet) {
  return *std::max_element(facet.polygons.begin(), facet.polygons.end(),
                           [](const auto& p, const auto& q) { return p.size() < q.size(); });
}

Result<void> check_area(const Plc& plc, std::size_t f) {
  const PlcFacet& facet = plc.facets[f];
  const std::string name = "facet " + std::to_string(f);
  const std::size_t largest = facet.polygons.empty() ? 0 : longest_polygon(facet).size();
  if (largest < 3) {
    return fail(ErrorCode::kDegenerateFacet,
                name + " has no polygon of at least 3 vertices (the largest has " +
                    std::to_string(largest) +
                    "); complete it, or give it as a segment if it is one",
                {static_cast<std::int64_t>(f)}, pointer_to("facets", f));
  }
  if (squared_length(facet_normal(plc, facet)) == 0) {
    return fail(ErrorCode::kDegenerateFacet,
                name + " has no area: its vertices lie on one line, beginning with " +
                    describe_vertex(plc, longest_polygon(facet).front()) + "; remove it",
                {static_cast<std::int64_t>(f)}, pointer_to("facets", f));
  }
  return {};
}

Result<void> check_planar(const Plc& plc, std::size_t f, double diameter) {
  const PlcFacet& facet = plc.facets[f];
  const Point3 normal = facet_normal(plc, facet);
  if (squared_length(normal) == 0) return {};
  // The plane in the middle of the vertices.
  double sum = 0;
  double count = 0;
  Point3 base;
  for (const auto& polygon : facet.polygons) {
    if (!polygon.empty()) base = plc.vertices[at(polygon.front())];
  }
  for (const auto& polygon : facet.polygons) {
    for (const std::int32_t v : polygon) {
      sum += dot(normal, plc.vertices[at(v)] - base);
      count += 1;
    }
  }
  double worst = 0;
  std::int32_t worst_vertex = -1;
  for (const auto& polygon : facet.polygons) {
    for (const std::int32_t v : polygon) {
      const double off = std::abs(dot(normal, plc.vertices[at(v)] - base) - sum / count);
      if (off > worst) {
        worst = off;
        worst_vertex = v;
      }
    }
  }
  if (worst <= kPlanarityToleranceRel * diameter) return {};
  return fail(ErrorCode::kNonplanarFacet,
              "facet " + std::to_string(f) + " is not planar: " +
                  describe_vertex(plc, worst_vertex) + " lies " + describe_rounded(worst) +
                  " off its plane, more than " + describe_rounded(kPlanarityToleranceRel) +
                  " of the model's diameter; split it into planar facets",
              {static_cast<std::int64_t>(f), worst_vertex}, pointer_to("facets", f));
}

}  // namespace

Result<ValidPlc> validate_plc(const Plc& plc, ExecutionContext& context) {
  SYMCELL_TRY(check_size(plc));
  SYMCELL_TRY(check_points(plc));
  SYMCELL_TRY(check_indices(plc));
  const auto diameter = check_extent(plc);
  if (!diameter) return error_of(diameter);
  SYMCELL_TRY(context.check());
  SYMCELL_TRY(check_duplicates(plc));
  SYMCELL_TRY(check_near_duplicates(plc, *diameter));
  for (std::size_t f = 0; f < plc.facets.size(); ++f) {
    SYMCELL_TRY(check_planar(plc, f, *diameter));
  }
  for (std::size_t f = 0; f < plc.facets.size(); ++f) {
    SYMCELL_TRY(check_area(plc, f));
  }
  auto complex = make_plc_complex(plc, context);
  if (!complex) return error_of(complex);
  SYMCELL_TRY(conform(*complex, context));
  SYMCELL_TRY(check_intersections(*complex, context));
  auto cells = find_cells(*complex, context);
  if (!cells) return error_of(cells);
  SYMCELL_TRY(check_cells(*complex, *cells));
  return ValidPlc{std::move(*complex), std::move(*cells)};
}

}  // namespace symcell::solid
