// How long edges may be where they grow away from small ones by a given factor: a size at each of many
// points, and between them the smallest of what each allows, growing linearly with the distance
// (gradient limiting: [Persson06], in closed form).
#pragma once

#include <vector>

#include "core/geometry/point.hpp"
#include "core/model/mesh_options.hpp"

namespace symcell::plane {

class GradedSize {
 public:
  struct Source {
    Point2 p;
    double size = 0;  // input units
  };

  // `gradation`: by how much an edge may be longer than the next, > 1.  Cost: O(N log N).
  GradedSize(std::vector<Source> sources, double gradation);

  // The longest edge that may begin at x; kInfinity without sources.  Cost: O(log N) where sizes vary
  // slowly.
  [[nodiscard]] double max_edge(Point2 x) const;

 private:
  struct Node {
    Point2 low;
    Point2 high;
    double least = kInfinity;  // size
    std::size_t first = 0;     // sources
    std::size_t last = 0;
    std::size_t right = 0;  // the left child follows its parent; 0: a leaf
  };

  std::size_t build(std::size_t first, std::size_t last);
  void look_at(std::size_t node, Point2 x, double& best) const;
  [[nodiscard]] double bound_of(const Node& node, Point2 x) const;

  double gradation_;
  double slope_;
  std::vector<Source> sources_;
  std::vector<Node> nodes_;
};

}  // namespace symcell::plane
