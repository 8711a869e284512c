#include "core/geometry/box_tree.hpp"

#include <boost/function_output_iterator.hpp>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <utility>
#include <vector>

namespace symcell {
namespace {

namespace bg = boost::geometry;
namespace bgi = boost::geometry::index;
using TreePoint = bg::model::point<double, 3, bg::cs::cartesian>;
using TreeBox = bg::model::box<TreePoint>;
using Entry = std::pair<TreeBox, std::int32_t>;

TreeBox tree_box(const Box3& box) {
  return {TreePoint(box.low.x, box.low.y, box.low.z),
          TreePoint(box.high.x, box.high.y, box.high.z)};
}

std::vector<Entry> entries_of(std::span<const Box3> boxes) {
  std::vector<Entry> entries;
  entries.reserve(boxes.size());
  for (const Box3& box : boxes) {
    entries.emplace_back(tree_box(box), static_cast<std::int32_t>(entries.size()));
  }
  return entries;
}

}  // namespace

struct BoxTree::Tree {
  bgi::rtree<Entry, bgi::quadratic<16>> rtree;
};

BoxTree::BoxTree(std::span<const Box3> boxes)
    : tree_(
          std::make_unique<Tree>(Tree{bgi::rtree<Entry, bgi::quadratic<16>>(entries_of(boxes))})) {
}
BoxTree::~BoxTree() = default;

void BoxTree::visit(const Box3& box, const std::function<void(std::int32_t)>& each) const {
  tree_->rtree.query(
      bgi::intersects(tree_box(box)),
      boost::make_function_output_iterator([&](const Entry& entry) { each(entry.second); }));
}

}  // namespace symcell
