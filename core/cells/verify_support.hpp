// Shared by the parts of verify_mesh; nothing else includes it.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/cells/mesh_data.hpp"
#include "core/cells/verify_mesh.hpp"
#include "core/geometry/rotation.hpp"

namespace symcell::internal {

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
  explicit Checks(VerifyReport& report) : report_(&report) {}
  bool add(std::string name, bool holds, std::string detail);
  void skip(std::string name, std::string why);

 private:
  VerifyReport* report_;
};

// A mesh with its facets, as the checks against a model take them.
struct FacetedMesh {
  const MeshData& mesh;
  const std::vector<HalfFacet>& facets;
  const std::vector<std::size_t>& groups;

  [[nodiscard]] std::size_t group_count() const { return groups.size() - 1; }
  [[nodiscard]] std::size_t sides(std::size_t group) const {
    return groups[group + 1] - groups[group];
  }
  [[nodiscard]] const HalfFacet& first(std::size_t group) const { return facets[groups[group]]; }
  [[nodiscard]] const HalfFacet& second(std::size_t group) const {
    return facets[groups[group] + 1];
  }
  // Of a tetrahedral mesh.
  [[nodiscard]] std::array<Point3, 3> triangle(std::size_t group) const {
    std::array<Point3, 3> p;
    for (std::size_t i = 0; i < 3; ++i) {
      p[i] = mesh.points[static_cast<std::size_t>(first(group).nodes[i])];
    }
    return p;
  }
};

// The checks that a mesh must pass whatever it meshes; `tag` is "cell" or "full". False if the rest
// cannot be looked at.
bool check_elements(const MeshData& mesh, const std::string& tag, double diameter, Checks& checks);

// model.*: the full mesh against the model. Return, per group of equal facets, whether it is
// constrained; the mesh's dimension is that of the model.
std::vector<char> check_model(const FacetedMesh& full,
                              const Pslg& model,
                              double tolerance,
                              Checks& checks);
std::vector<char> check_model(const FacetedMesh& full,
                              const Plc& model,
                              double tolerance,
                              Checks& checks);
std::vector<char> check_model(const FacetedMesh& full,
                              const TriangleSurface& model,
                              double tolerance,
                              Checks& checks);

// Places at which the elements round a node or an edge are not all connected by facets.
struct Pinches {
  std::vector<std::int32_t> nodes;                 // ascending
  std::vector<std::array<std::int32_t, 2>> edges;  // likewise; ends ascending
};
// Of a tetrahedral mesh.  Cost: O(E log E).
[[nodiscard]] Pinches find_pinches(const FacetedMesh& mesh);

// What is told, not checked: the share of free facets that are locally Delaunay, and the quality.
void tell_delaunay(const FacetedMesh& full, const std::vector<char>& constrained, Checks& checks);
void tell_quality(const MeshData& mesh, Checks& checks);

}  // namespace symcell::internal
