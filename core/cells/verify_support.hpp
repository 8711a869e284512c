// Shared by the parts of verify_mesh; nothing else includes it.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "core/cells/mesh_data.hpp"
#include "core/cells/verify_mesh.hpp"
#include "core/geometry/rotation.hpp"

namespace symcell::internal {

[[nodiscard]] inline Point2 planar(const Point3& p) {
  return {p.x, p.y};
}

// An edge of one element, as it runs round the element; `mid` is -1 for order 1.
struct HalfEdge {
  std::int32_t low = 0;
  std::int32_t high = 0;
  bool ascending = true;  // runs from low to high
  std::int32_t element = 0;
  std::int32_t mid = -1;
};

// All edges of the elements, sorted by (low, high); copies of one edge stand side by side.
[[nodiscard]] std::vector<HalfEdge> sorted_edges(const MeshData& mesh);

// Begins of the groups of equal edges, and the end.
[[nodiscard]] std::vector<std::size_t> edge_groups(const std::vector<HalfEdge>& edges);

[[nodiscard]] double total_area(const MeshData& mesh);
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

// The checks that a mesh must pass whatever it meshes; `tag` is "cell" or "full". False if the rest
// cannot be looked at.
bool check_elements(const MeshData& mesh, const std::string& tag, double diameter, Checks& checks);

// model.*: `full` against the model.  Returns, per group of equal edges, whether it is constrained.
std::vector<char> check_model(const MeshData& full,
                              const std::vector<HalfEdge>& edges,
                              const std::vector<std::size_t>& groups,
                              const Pslg& model,
                              double tolerance,
                              Checks& checks);

}  // namespace symcell::internal
