// A PLC as a complex: every straight segment once, every facet as a graph of such segments with its
// triangulation. What validation, symmetry and the cut into sectors work on.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/geometry/facet_triangulation.hpp"
#include "core/model/plc.hpp"

namespace symcell::solid {

struct ComplexEdge {
  std::int32_t a = 0;  // points of the complex, a < b
  std::int32_t b = 0;
  std::int32_t marker = 0;
};

struct ComplexFacet {
  FacetGraph graph;                 // segments with a < b, sorted
  std::vector<std::int32_t> edges;  // per segment of the graph, in the complex
  FacetTriangles triangles;
  std::int32_t marker = 0;
  std::int32_t source = 0;  // facet of the input
};

// Invariants: no edge twice; the points of the input come first, in its order.
struct PlcComplex {
  std::vector<Point3> points;
  std::vector<ComplexEdge> edges;  // sorted by (a, b)
  std::vector<ComplexFacet> facets;
  std::vector<Point3> holes;
  std::vector<PlcRegion> regions;
  Point3 box_low;
  Point3 box_high;
  double diameter = 0;   // of the bounding box of all input vertices
  double magnitude = 0;  // largest absolute coordinate
};

// Requires: indices and numbers of the PLC are sound.  Errors: kSelfIntersection, kDegenerateFacet,
// kUnreachableSeed (a facet's hole point that no polygon encloses), limits.
// Cost: O(N log N).
[[nodiscard]] Result<PlcComplex> make_plc_complex(const Plc& plc, ExecutionContext& context);

// Adds the facets' segments to the complex's edges, sorts them, keeps each once (with the largest
// marker, where one is given at all) and sets the facets' `edges` anew.
void collect_facet_edges(PlcComplex& complex);

// Whether one of the facet's triangles, seen along its normal, has the point; `points` are those of
// the complex.  Cost: O(triangles).
[[nodiscard]] bool covers(std::span<const Point3> points, const ComplexFacet& facet, Point3 p);

// Normal of the facet's plane, of unit length; zero where all its vertices lie on one line.
[[nodiscard]] Point3 facet_normal(const Plc& plc, const PlcFacet& facet);

}  // namespace symcell::solid
