// Hanging nodes: nodes inside a boundary facet of the full mesh that they are no corner of. Where
// two parts of a mesh meet without sharing their facets, the nodes of one stand on facets of the
// other, and every check of the elements alone passes.
#include <algorithm>
#include <functional>

#include "core/geometry/box_tree.hpp"
#include "core/geometry/segment_index.hpp"
#include "core/geometry/triangle_tree.hpp"
#include "core/verify/support.hpp"

namespace symcell::internal {
namespace {

class HangingNodes {
 public:
  HangingNodes(const FacetedMesh& full, double tolerance) : full_(full), tolerance_(tolerance) {
    for (std::size_t g = 0; g < full.group_count(); ++g) {
      if (full.sides(g) == 1) boundary_.push_back(g);
    }
  }

  Flaws run() {
    std::vector<Box3> boxes;
    std::vector<std::int32_t> nodes;
    for (const std::size_t g : boundary_) {
      boxes.push_back(box_of(g));
      const auto& corners = full_.first(g).nodes;
      nodes.insert(nodes.end(), corners.begin(), corners.begin() + full_.mesh.dimension);
    }
    std::ranges::sort(nodes);
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    const BoxTree tree(boxes);
    for (const std::int32_t node : nodes) look(tree, node);
    return flaws_;
  }

 private:
  [[nodiscard]] Box3 box_of(std::size_t group) const {
    const auto& nodes = full_.first(group).nodes;
    std::array<Point3, 3> p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = full_.point(nodes[i] < 0 ? nodes[0] : nodes[i]);
    return bounding_box(p);
  }

  [[nodiscard]] double distance_to(std::size_t group, const Point3& p) const {
    if (full_.mesh.dimension == 2) {
      const auto& nodes = full_.first(group).nodes;
      return std::sqrt(squared_distance_to_segment(planar(p), planar(full_.point(nodes[0])),
                                                   planar(full_.point(nodes[1]))));
    }
    const auto [a, b, c] = full_.triangle(group);
    return distance(p, closest_point(p, a, b, c));
  }

  void look(const BoxTree& tree, std::int32_t node) {
    const Point3& p = full_.point(node);
    const Point3 reach{tolerance_, tolerance_, tolerance_};
    bool hangs = false;
    tree.visit({p - reach, p + reach}, [&](std::int32_t i) {
      const std::size_t group = boundary_[static_cast<std::size_t>(i)];
      const auto& corners = full_.first(group).nodes;
      if (hangs || std::ranges::find(corners, node) != corners.end()) return;
      if (distance_to(group, p) > tolerance_) return;
      hangs = true;
      flaws_.note([&] {
        return "node " + std::to_string(node) + " lies in boundary " + facet_name(corners) +
               " and is no corner of it";
      });
    });
  }

  const FacetedMesh& full_;
  double tolerance_;
  std::vector<std::size_t> boundary_;  // groups
  Flaws flaws_;
};

}  // namespace

void check_hanging_nodes(const FacetedMesh& full, double tolerance, Checks& checks) {
  HangingNodes(full, tolerance).run().report(checks, "full.hanging_nodes");
}

}  // namespace symcell::internal
