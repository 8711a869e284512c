// Shared by the parts of verify_mesh; beside them only what reads cells of files includes it, for their facets.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/union_find.hpp"
#include "core/verify/mesh_data.hpp"
#include "core/verify/verify_mesh.hpp"

namespace symcell::internal {

inline constexpr double kFar = std::numeric_limits<double>::infinity();  // farther than anything

[[nodiscard]] inline Point2 planar(const Point3& p) {
  return {p.x, p.y};
}

// An edge of a triangle or a face of a tetrahedron, as its element sees it.
struct HalfFacet {
  std::array<std::int32_t, 3> nodes{};  // corners, ascending; in the plane the third is -1
  bool even = true;  // the sorted corners run counter-clockwise seen from outside the element
  std::int32_t element = 0;
  std::int32_t opposite = 0;  // corner of the element, 0 to 3
};

// All facets of the elements, sorted by nodes; the two sides of one facet stand together.
[[nodiscard]] std::vector<HalfFacet> sorted_facets(const MeshData& mesh);

// Begins of the groups of equal facets, and the end.
[[nodiscard]] std::vector<std::size_t> facet_groups(const std::vector<HalfFacet>& facets);

// "edge 3-7", "face 3-7-9"
[[nodiscard]] std::string facet_name(const std::array<std::int32_t, 3>& nodes);

// Sorts the corners of a facet; true if that is an even permutation.
bool sort_facet(std::array<std::int32_t, 3>& nodes, std::int32_t dimension);

struct ElementEdge {
  std::int32_t low = 0;
  std::int32_t high = 0;
  std::int32_t mid = -1;  // -1 for order 1
  friend auto operator<=>(const ElementEdge&, const ElementEdge&) = default;
};

// The edges of all elements, each once; if an edge has several mid nodes, once with each.
[[nodiscard]] std::vector<ElementEdge> element_edges(const MeshData& mesh);

// Corner pairs of an element's edges in VTK's order of mid-side nodes.
[[nodiscard]] std::span<const std::array<std::size_t, 2>> edge_corners(std::int32_t dimension);

// Positions of an element's corners; of a triangle the fourth is the origin.
[[nodiscard]] std::array<Point3, 4> corners_of(const MeshData& mesh, std::size_t element);

[[nodiscard]] double total_measure(const MeshData& mesh);  // area or volume
[[nodiscard]] double diameter(const std::vector<Point3>& points);

// A number as messages show it.
[[nodiscard]] std::string shown(double value);

// Collects the checks of one report.
class Checks {
 public:
  // `most_exempt`: elements of the full mesh that may break a bound.
  explicit Checks(VerifyReport& report, std::size_t most_exempt = 0)
      : report_(&report), most_exempt_(most_exempt) {}
  bool add(std::string name, bool holds, std::string detail);
  void skip(std::string name, std::string why);
  [[nodiscard]] std::size_t most_exempt() const { return most_exempt_; }

 private:
  VerifyReport* report_;
  std::size_t most_exempt_;
};

// What one check finds: the first flaw in words, and how many there are.
class Flaws {
 public:
  // `describe` is called for the first flaw only.
  template <class Describe>
  void note(const Describe& describe) {
    if (count_++ == 0) first_ = describe();
  }
  [[nodiscard]] bool none() const { return count_ == 0; }
  // Fails if there is a flaw, and reports it; else reports `fine`.
  bool report(Checks& checks, std::string name, std::string fine = {}) const;
  // The same of elements beyond a bound, of which as many as are exempt may be.
  bool report_beyond_bound(Checks& checks, std::string name, std::string fine = {}) const;

 private:
  std::size_t count_ = 0;
  std::string first_;
};

// A mesh with its facets; the sides of one facet are a group.
struct FacetedMesh {
  explicit FacetedMesh(const MeshData& of)
      : mesh(of), facets(sorted_facets(of)), groups(facet_groups(facets)) {}

  const MeshData& mesh;
  std::vector<HalfFacet> facets;
  std::vector<std::size_t> groups;

  [[nodiscard]] std::size_t group_count() const { return groups.size() - 1; }
  [[nodiscard]] std::size_t sides(std::size_t group) const {
    return groups[group + 1] - groups[group];
  }
  [[nodiscard]] const HalfFacet& first(std::size_t group) const { return facets[groups[group]]; }
  [[nodiscard]] const HalfFacet& second(std::size_t group) const {
    return facets[groups[group] + 1];
  }
  [[nodiscard]] const Point3& point(std::int32_t node) const {
    return mesh.points[static_cast<std::size_t>(node)];
  }
  // Of a tetrahedral mesh.
  [[nodiscard]] std::array<Point3, 3> triangle(std::size_t group) const {
    const auto& nodes = first(group).nodes;
    return {point(nodes[0]), point(nodes[1]), point(nodes[2])};
  }
  // The group of a facet's nodes, ascending; group_count() if there is none.  Cost: O(log N).
  [[nodiscard]] std::size_t find(const std::array<std::int32_t, 3>& nodes) const;
};

// f(element, element) for each facet between two elements.
template <class F>
void each_inner_facet(const FacetedMesh& mesh, const F& f) {
  for (std::size_t g = 0; g < mesh.group_count(); ++g) {
    if (mesh.sides(g) == 2) f(mesh.first(g).element, mesh.second(g).element);
  }
}

// The checks of a mesh by itself, whatever it meshes; `tag` is "cell" or "full". False if the rest
// cannot be looked at.  `tolerance`: nodes closer than this are one node written twice.
bool check_fields(const MeshData& mesh, const std::string& tag, Checks& checks);
bool check_elements(const FacetedMesh& mesh,
                    const std::string& tag,
                    double tolerance,
                    Checks& checks);

// Places at which the elements round a node or an edge are not all connected by facets.
struct Pinches {
  std::vector<std::int32_t> nodes;                 // ascending
  std::vector<std::array<std::int32_t, 2>> edges;  // likewise; ends ascending; in space only
};
// Cost: O(E log E).
[[nodiscard]] Pinches find_pinches(const FacetedMesh& mesh);

// Places at which a model's own material is not connected by faces.
struct ModelPinches {
  std::vector<Point3> points;
  std::vector<std::array<Point3, 2>> edges;
  double tolerance = 0;  // how far nodes may be from them

  [[nodiscard]] bool empty() const { return points.empty() && edges.empty(); }
  [[nodiscard]] bool on_edge(const Point3& p) const;
  // Per point, whether it is at a pinch: on an edge, or the nearest of them to a pinched vertex.
  [[nodiscard]] std::vector<char> exempted(const std::vector<Point3>& places) const;
};

// *.vertex_links, *.edge_links
void check_links(const FacetedMesh& mesh,
                 const std::string& tag,
                 const ModelPinches& pinches,
                 Checks& checks);

// full.hanging_nodes
void check_hanging_nodes(const FacetedMesh& full, double tolerance, Checks& checks);

// Reported, not checked: the share of free facets that are locally Delaunay, and the quality.
void tell_delaunay(const FacetedMesh& full, const std::vector<char>& constrained, Checks& checks);
void tell_quality(const MeshData& mesh, Checks& checks);

}  // namespace symcell::internal
