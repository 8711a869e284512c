// Which boxes meet a box: a packed R-tree (Boost.Geometry), built once.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "core/geometry/indexed_surface.hpp"

namespace symcell {

class BoxTree {
 public:
  // Ids are positions in `boxes`.  Cost: O(N log N).
  explicit BoxTree(std::span<const Box3> boxes);
  ~BoxTree();
  BoxTree(const BoxTree&) = delete;
  BoxTree& operator=(const BoxTree&) = delete;

  // All ids whose box meets the closed box, in no particular order.
  void visit(const Box3& box, const std::function<void(std::int32_t)>& each) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace symcell
