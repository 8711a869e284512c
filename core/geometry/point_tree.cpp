#include "core/geometry/point_tree.hpp"

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
using Entry = std::pair<TreePoint, std::int32_t>;

std::vector<Entry> entries_of(std::span<const Point3> points) {
  std::vector<Entry> entries;
  entries.reserve(points.size());
  for (const Point3 p : points) {
    entries.emplace_back(TreePoint(p.x, p.y, p.z), static_cast<std::int32_t>(entries.size()));
  }
  return entries;
}

}  // namespace

struct PointTree::Tree {
  bgi::rtree<Entry, bgi::quadratic<16>> rtree;
};

PointTree::PointTree(std::span<const Point3> points)
    : tree_(
          std::make_unique<Tree>(Tree{bgi::rtree<Entry, bgi::quadratic<16>>(entries_of(points))})) {
}
PointTree::PointTree(PointTree&&) noexcept = default;
PointTree& PointTree::operator=(PointTree&&) noexcept = default;
PointTree::~PointTree() = default;

PointTree::Hit PointTree::nearest(Point3 p) const {
  Hit hit;
  tree_->rtree.query(bgi::nearest(TreePoint(p.x, p.y, p.z), 1),
                     boost::make_function_output_iterator([&](const Entry& entry) {
                       const TreePoint& q = entry.first;
                       hit = {entry.second, distance(p, {q.get<0>(), q.get<1>(), q.get<2>()})};
                     }));
  return hit;
}

void PointTree::within_box(Point3 low,
                           Point3 high,
                           const std::function<void(std::int32_t)>& visit) const {
  const bg::model::box<TreePoint> box(TreePoint(low.x, low.y, low.z),
                                      TreePoint(high.x, high.y, high.z));
  tree_->rtree.query(bgi::intersects(box), boost::make_function_output_iterator(
                                               [&](const Entry& entry) { visit(entry.second); }));
}

}  // namespace symcell
