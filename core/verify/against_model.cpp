// Models examined: measure, pieces and pinches, each from the model alone.
#include "core/verify/against_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

#include "core/base/index.hpp"
#include "core/geometry/point_tree.hpp"
#include "core/geometry/segment_index.hpp"
#include "core/geometry/self_intersections.hpp"
#include "core/solid/surface/make_whole.hpp"
#include "core/solid/surface/shells.hpp"
#include "core/solid/surface/t_junctions.hpp"
#include "core/solid/surface/weld.hpp"

namespace symcell::internal {
namespace {

// A vertex farther than this from where an image of another should be, as a share of the diameter,
// is another vertex and no near miss.
constexpr double kNearMissRel = 1e-5;
// Distances tried in turn at which vertices of a surface are one, as shares of the diameter.
constexpr std::array<double, 5> kWeldRel{1e-8, 1e-7, 1e-6, 1e-5, 3e-5};

// Classes among the marked.
std::size_t marked_classes(UnionFind& classes, const std::vector<char>& marked) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < marked.size(); ++i) {
    const auto index = static_cast<std::int32_t>(i);
    count += marked[i] != 0 && classes.root(index) == index ? 1 : 0;
  }
  return count;
}

std::vector<Point3> raised(const std::vector<Point2>& points) {
  std::vector<Point3> result;
  result.reserve(points.size());
  for (const Point2 p : points) result.push_back({p.x, p.y, 0});
  return result;
}

Result<void> check_indices(const Pslg& pslg) {
  const auto count = static_cast<std::int32_t>(pslg.vertices.size());
  for (std::size_t s = 0; s < pslg.segments.size(); ++s) {
    const auto [a, b, marker] = pslg.segments[s];
    if (a < 0 || b < 0 || a >= count || b >= count || a == b) {
      return fail(ErrorCode::kIndexOutOfRange,
                  "segment " + std::to_string(s) + " joins no two vertices of the model");
    }
  }
  const bool finite =
      std::ranges::all_of(pslg.vertices, [](Point2 p) { return std::isfinite(p.x + p.y); });
  if (!finite) return fail(ErrorCode::kNonFinite, "a vertex of the model is not finite");
  return {};
}

// A vertex pinches if the meshed sectors round it form more than one run: each begins at a
// half-edge with the domain on its left and none on its right.
ModelPinches planar_pinches(const Pslg& pslg, const plane::Subdomains& subdomains) {
  const plane::PlanarMap& map = subdomains.map;
  std::vector<std::int32_t> runs(pslg.vertices.size(), 0);
  for (std::int32_t h = 0; at(h) < map.face.size(); ++h) {
    const bool begins = subdomains.left_of(h).meshed && !subdomains.left_of(h ^ 1).meshed;
    if (begins) ++runs[at(map.origin(h))];
  }
  ModelPinches pinches;
  for (std::size_t v = 0; v < runs.size(); ++v) {
    if (runs[v] > 1) pinches.points.push_back({pslg.vertices[v].x, pslg.vertices[v].y, 0});
  }
  return pinches;
}

Result<ExaminedModel> examine(const Pslg& pslg) {
  SYMCELL_TRY(check_indices(pslg));
  ExecutionContext context;
  Result<plane::Subdomains> subdomains = plane::make_subdomains(pslg, context);
  if (!subdomains) return error_of(subdomains);
  ModelFacts facts;
  facts.diameter = diameter(raised(pslg.vertices));
  UnionFind parts(subdomains->faces.size());
  const plane::PlanarMap& map = subdomains->map;
  for (std::size_t p = 0; p < map.pieces.size(); ++p) {
    const auto h = static_cast<std::int32_t>(2 * p);
    const bool left = subdomains->left_of(h).meshed, right = subdomains->left_of(h + 1).meshed;
    if (left && right) parts.join(map.face[2 * p], map.face[2 * p + 1]);
    if (left == right) continue;
    facts.boundary_size +=
        distance(pslg.vertices[at(map.pieces[p].a)], pslg.vertices[at(map.pieces[p].b)]);
  }
  double area = 0;
  std::vector<char> meshed;
  for (const plane::Subdomain& face : subdomains->faces) {
    meshed.push_back(face.meshed ? 1 : 0);
    if (face.meshed) area += face.area;
  }
  facts.measure = area;
  facts.pieces = marked_classes(parts, meshed);
  facts.pinches = planar_pinches(pslg, *subdomains);
  return ExaminedModel{std::move(facts), PlanarModel{&pslg, std::move(*subdomains)}};
}

double off_plane(const solid::PlcComplex& complex) {
  double farthest = 0;
  for (const solid::ComplexFacet& facet : complex.facets) {
    const double size = length(facet.graph.normal);
    if (facet.graph.segments.empty() || !(size > 0)) continue;
    const Point3 normal = (1 / size) * facet.graph.normal;
    const double level = dot(normal, complex.points[at(facet.graph.segments[0][0])]);
    for (const auto& segment : facet.graph.segments) {
      for (const std::int32_t v : segment) {
        farthest = std::max(farthest, std::abs(dot(normal, complex.points[at(v)]) - level));
      }
    }
  }
  return farthest;
}

Result<ExaminedModel> examine(const Plc& plc) {
  ExecutionContext context;
  Result<solid::ValidPlc> valid = solid::validate_plc(plc, context);
  if (!valid) return error_of(valid);
  PlcModel model{&plc, std::move(*valid), 0};
  const solid::PlcComplex& complex = model.valid.complex;
  const solid::PlcCells& cells = model.valid.cells;
  model.off_plane = off_plane(complex);
  ModelFacts facts;
  facts.diameter = complex.diameter;
  facts.measure = cells.volume;
  UnionFind parts(cells.cells.size());
  SidedTriangles solid{complex.points, {}, {}};
  for (std::size_t f = 0; f < complex.facets.size(); ++f) {
    const auto& triangles = complex.facets[f].triangles.triangles;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      const auto [front, back] = cells.sides[f][t];
      const bool before = model.meshed(front), behind = model.meshed(back);
      solid.triangles.push_back(triangles[t]);
      solid.material.push_back({before, behind});
      if (before && behind) parts.join(front, back);
      if (before == behind) continue;
      const Point3& a = complex.points[at(triangles[t][0])];
      facts.boundary_size += 0.5 * length(area_normal(a, complex.points[at(triangles[t][1])],
                                                      complex.points[at(triangles[t][2])]));
    }
  }
  std::vector<char> meshed;
  for (const solid::PlcCell& cell : cells.cells) meshed.push_back(cell.meshed ? 1 : 0);
  facts.pieces = marked_classes(parts, meshed);
  facts.pinches = find_model_pinches(solid);
  return ExaminedModel{std::move(facts), std::move(model)};
}

Result<void> check_triangles(const TriangleSurface& surface) {
  const bool finite = std::ranges::all_of(
      surface.vertices, [](const Point3& p) { return std::isfinite(p.x + p.y + p.z); });
  const auto count = static_cast<std::int32_t>(surface.vertices.size());
  const bool in_range = std::ranges::all_of(surface.triangles, [&](const Triangle& t) {
    return std::ranges::all_of(t, [&](std::int32_t v) { return v >= 0 && v < count; });
  });
  if (finite && in_range && !surface.triangles.empty()) return {};
  return fail(ErrorCode::kIndexOutOfRange,
              "the surface has no triangles, or a corner that does not exist or is not finite");
}

// How the triangles meet at the edges of a surface.
struct Closure {
  bool closed = true;    // an even number of triangles at each edge
  bool agreeing = true;  // as many run one way as the other
  bool manifold = true;  // two triangles an edge
};

Closure closure_of(const IndexedSurface& surface) {
  Closure result;
  const std::vector<EdgeUse> uses = sorted_edge_uses(surface.triangles);
  for_each_edge(uses, [&](std::size_t begin, std::size_t end) {
    std::size_t forward = 0;
    for (std::size_t i = begin; i < end; ++i) forward += uses[i].forward ? 1 : 0;
    result.closed &= (end - begin) % 2 == 0;
    result.agreeing &= 2 * forward == end - begin;
    result.manifold &= end - begin == 2;
  });
  return result;
}

// Vertices that are one made one, at the least tolerance that closes the surface.
IndexedSurface closed_surface(const TriangleSurface& given, double size) {
  IndexedSurface exact = solid::weld_exactly(given);
  solid::drop_doubled_triangles(exact);
  if (exact.triangles.empty() || closure_of(exact).closed) return exact;
  for (const double share : kWeldRel) {
    IndexedSurface welded = solid::weld_within(exact, share * size);
    if (!welded.triangles.empty() && closure_of(welded).closed) return welded;
  }
  IndexedSurface split = exact;
  solid::split_at_t_junctions(split, solid::kJunctionRel * size);
  return closure_of(split).closed ? split : exact;
}

SidedTriangles sided(const IndexedSurface& surface) {
  return {surface.points, surface.triangles,
          std::vector<std::array<bool, 2>>(surface.triangles.size(), {false, true})};
}

Result<ExaminedModel> examine(const TriangleSurface& given) {
  SYMCELL_TRY(check_triangles(given));
  ModelFacts facts;
  facts.diameter = diameter(given.vertices);
  SurfaceModel model{&given, closed_surface(given, facts.diameter), false, false};
  Closure closure = closure_of(model.welded);
  ExecutionContext unlimited;
  const auto crossing = self_intersections(model.welded, 1, unlimited);
  model.crosses = !crossing || !crossing->empty();
  if (model.crosses) return ExaminedModel{std::move(facts), std::move(model)};
  if (closure.manifold) {
    // Each shell at even depth encloses one piece; those at odd depth are cavities.
    ExecutionContext context;
    const Result<solid::Shells> shells = solid::orient_shells(model.welded, context);
    closure.agreeing = shells.has_value();
    model.manifold = shells.has_value();
    if (shells) {
      facts.pieces = static_cast<std::size_t>(
          std::ranges::count_if(shells->depth, [](std::int32_t d) { return d % 2 == 0; }));
    }
  }
  facts.boundary_size = surface_area(model.welded);
  if (closure.closed && closure.agreeing && !model.welded.triangles.empty()) {
    const Box3 box = bounding_box(model.welded.points);
    facts.measure = std::abs(enclosed_volume(model.welded, 0.5 * (box.low + box.high)));
    facts.pinches = find_model_pinches(sided(model.welded));
  }
  return ExaminedModel{std::move(facts), std::move(model)};
}

// Distance of the image of a vertex from what it may be taken for.
double planar_miss(const PointTree& vertices,
                   const SegmentIndex& segments,
                   const Point3& image,
                   double near) {
  const double miss = vertices.nearest(image).distance;
  if (miss < near) return miss;
  return segments.nearest(planar(image), near).distance;
}

}  // namespace

Result<ExaminedModel> examine_model(const Model& model) {
  return std::visit([](const auto& given) { return examine(given); }, model);
}

Result<TriangleSurface> all_sectors(const TriangleSurface& sector,
                                    std::int32_t sectors,
                                    const AxisFrame& axis,
                                    double tolerance_rel) {
  SYMCELL_TRY(check_triangles(sector));
  const double size = diameter(sector.vertices);
  IndexedSurface closed = closed_surface(sector, size);
  if (!closure_of(closed).closed) {
    return fail(ErrorCode::kNotWatertight, "the surface of the sector is not closed");
  }
  ExecutionContext unlimited;
  const auto shells = solid::orient_shells(closed, unlimited);
  if (!shells) return error_of(shells);
  return solid::make_whole(closed, sectors, axis, tolerance_rel * size);
}

std::vector<char> vertices_of_domain(const PlanarModel& model) {
  const plane::PlanarMap& map = model.subdomains.map;
  std::vector<char> result(model.pslg->vertices.size(), 0);
  for (std::size_t p = 0; p < map.pieces.size(); ++p) {
    if (!model.meshed_beside(p)) continue;
    result[at(map.pieces[p].a)] = 1;
    result[at(map.pieces[p].b)] = 1;
  }
  for (std::size_t v = 0; v < result.size(); ++v) {
    const std::int32_t face = map.vertex_face[v];
    if (face >= 0 && model.subdomains.faces[at(face)].meshed) result[v] = 1;
  }
  return result;
}

double model_asymmetry(const ExaminedModel& model,
                       const std::function<Point3(const Point3&)>& rotate) {
  const double near = kNearMissRel * model.facts.diameter;
  double worst = 0;
  const auto note = [&](double miss) {
    if (miss < near) worst = std::max(worst, miss);
  };
  if (const auto* plc = std::get_if<PlcModel>(&model.geometry)) {
    const PointTree tree(plc->given->vertices);
    for (const Point3& p : plc->given->vertices) note(tree.nearest(rotate(p)).distance);
  }
  if (const auto* planar_model = std::get_if<PlanarModel>(&model.geometry)) {
    const Pslg& pslg = *planar_model->pslg;
    const std::vector<char> needed = vertices_of_domain(*planar_model);
    std::vector<Point3> vertices;
    for (std::size_t v = 0; v < needed.size(); ++v) {
      if (needed[v] != 0) vertices.push_back({pslg.vertices[v].x, pslg.vertices[v].y, 0});
    }
    std::vector<IndexedSegment> segments;
    const plane::PlanarMap& map = planar_model->subdomains.map;
    for (std::size_t p = 0; p < map.pieces.size(); ++p) {
      if (!planar_model->meshed_beside(p)) continue;
      segments.push_back({pslg.vertices[at(map.pieces[p].a)], pslg.vertices[at(map.pieces[p].b)]});
    }
    const PointTree tree(vertices);
    const SegmentIndex index(segments);
    for (const Point3& p : vertices) note(planar_miss(tree, index, rotate(p), near));
  }
  return worst;
}

SurfaceTopology topology_of(std::span<const Triangle> triangles) {
  const std::vector<EdgeUse> uses = sorted_edge_uses(triangles);
  UnionFind shells(triangles.size()), fans(3 * triangles.size());
  const auto corner = [&](std::int32_t t, std::int32_t v) {
    const Triangle& corners = triangles[static_cast<std::size_t>(t)];
    return 3 * t + static_cast<std::int32_t>(std::ranges::find(corners, v) - corners.begin());
  };
  std::int64_t edges = 0;
  for_each_edge(uses, [&](std::size_t begin, std::size_t end) {
    ++edges;
    const EdgeUse& first = uses[begin];
    for (std::size_t i = begin + 1; i < end; ++i) {
      shells.join(first.triangle, uses[i].triangle);
      for (const std::int32_t v : {first.low, first.high}) {
        fans.join(corner(first.triangle, v), corner(uses[i].triangle, v));
      }
    }
  });
  return {shells.class_count(), static_cast<std::int64_t>(fans.class_count()) - edges +
                                    static_cast<std::int64_t>(triangles.size())};
}

}  // namespace symcell::internal
