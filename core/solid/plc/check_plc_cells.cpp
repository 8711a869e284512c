// `check_cells`: what hole and region seeds must hold.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "core/base/index.hpp"
#include "core/geometry/resolution.hpp"
#include "core/geometry/triangle_tree.hpp"
#include "core/model/describe.hpp"
#include "core/solid/plc/plc_cells.hpp"

namespace symcell::solid {
namespace {

std::string seed_name(const char* kind, std::size_t i, Point3 p) {
  return std::string(kind) + " seed " + std::to_string(i) + " at " + describe_point(p);
}

Result<void> check_enclosure(const PlcComplex& complex, const PlcCells& cells) {
  if (cells.cells.size() > 1) return {};
  std::string message = "the facets enclose no volume";
  std::vector<std::int64_t> elements;
  constexpr std::size_t kNamed = 3;  // open segments in the message
  for (std::size_t i = 0; i < std::min(kNamed, cells.open_edges.size()); ++i) {
    const ComplexEdge& e = complex.edges[at(cells.open_edges[i])];
    message += std::string(i == 0 ? ": open at the segment" : ", at that") + " from vertex " +
               std::to_string(e.a) + " at " + describe_point(complex.points[at(e.a)]) +
               " to vertex " + std::to_string(e.b) + " at " +
               describe_point(complex.points[at(e.b)]);
    elements.insert(elements.end(), {e.a, e.b});
  }
  if (cells.open_edges.size() > kNamed) {
    message += " and " + std::to_string(cells.open_edges.size() - kNamed) + " more";
  }
  return fail(ErrorCode::kNotWatertight, message + "; add the facets that close the surface",
              std::move(elements));
}

// A seed on a facet between two cells is in neither. Facets within one cell leave no doubt.
Result<void> check_seeds_off_facets(const PlcComplex& complex, const PlcCells& cells) {
  if (complex.holes.empty() && complex.regions.empty()) return {};
  std::vector<Triangle> triangles;
  std::vector<std::int32_t> source;
  for (std::size_t f = 0; f < complex.facets.size(); ++f) {
    const ComplexFacet& facet = complex.facets[f];
    for (std::size_t t = 0; t < facet.triangles.triangles.size(); ++t) {
      const auto [front, back] = cells.sides[f][t];
      if (front == back) continue;
      triangles.push_back(facet.triangles.triangles[t]);
      source.push_back(facet.source);
    }
  }
  const TriangleTree tree(complex.points, triangles);
  const double resolution = resolution_of(complex.diameter, complex.magnitude);
  const auto check = [&](const char* kind, const char* list, std::size_t i, Point3 p) {
    const TriangleTree::Hit hit = tree.nearest(p, resolution);
    if (hit.triangle < 0) return Result<void>{};
    return Result<void>(
        fail(ErrorCode::kUnreachableSeed,
             seed_name(kind, i, p) + " lies on facet " + std::to_string(source[at(hit.triangle)]) +
                 "; move it into the cell it is meant for",
             {static_cast<std::int64_t>(i)}, "/" + std::string(list) + "/" + std::to_string(i)));
  };
  for (std::size_t i = 0; i < complex.holes.size(); ++i) {
    SYMCELL_TRY(check("hole", "holes", i, complex.holes[i]));
  }
  for (std::size_t i = 0; i < complex.regions.size(); ++i) {
    SYMCELL_TRY(check("region", "regions", i, complex.regions[i].point));
  }
  return {};
}

}  // namespace

Result<void> check_cells(const PlcComplex& complex, const PlcCells& cells) {
  SYMCELL_TRY(check_enclosure(complex, cells));
  SYMCELL_TRY(check_seeds_off_facets(complex, cells));
  const auto unreachable = [](const std::string& seed, std::size_t i, const char* list) {
    return fail(ErrorCode::kUnreachableSeed,
                seed +
                    " is not enclosed by facets; move it into a cell, close the facets round "
                    "it, or remove it",
                {static_cast<std::int64_t>(i)}, "/" + std::string(list) + "/" + std::to_string(i));
  };
  for (std::size_t i = 0; i < cells.hole_cell.size(); ++i) {
    if (cells.hole_cell[i] == kOutside) {
      return unreachable(seed_name("hole", i, complex.holes[i]), i, "holes");
    }
  }
  for (std::size_t i = 0; i < cells.region_cell.size(); ++i) {
    const PlcRegion& region = complex.regions[i];
    const std::string name = seed_name("region", i, region.point);
    if (cells.region_cell[i] == kOutside) return unreachable(name, i, "regions");
    const PlcCell& cell = cells.cells[at(cells.region_cell[i])];
    const PlcRegion& first = complex.regions[at(cell.region)];
    std::string other;
    if (cell.hole >= 0) {
      other = seed_name("hole", at(cell.hole), complex.holes[at(cell.hole)]);
    } else if (first.attribute != region.attribute || first.max_volume != region.max_volume) {
      other = seed_name("region", at(cell.region), first.point);
    }
    if (other.empty()) continue;
    return fail(ErrorCode::kConflictingSeeds,
                other + " and " + name +
                    " lie in the same cell, with no facet between; keep one of them or close the "
                    "facets between them",
                {static_cast<std::int64_t>(i)}, "/regions/" + std::to_string(i));
  }
  const bool meshed = std::any_of(cells.cells.begin(), cells.cells.end(),
                                  [](const PlcCell& c) { return c.meshed; });
  if (meshed) return {};
  return fail(ErrorCode::kDegenerateGeometry,
              "every cell has a hole seed, so nothing is left to mesh; remove a hole seed");
}

}  // namespace symcell::solid
