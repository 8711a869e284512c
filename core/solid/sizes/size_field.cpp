#include "core/solid/sizes/size_field.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/base/index.hpp"
#include "core/geometry/triangle_tree.hpp"

namespace symcell::solid {
namespace {

constexpr std::int32_t kLeafSize = 4;  // sources: below, a look at each is quicker than a tree
// Of a source's size.
constexpr double kPlateau = 0.5;

constexpr double kTurn = 2 * std::numbers::pi;

double angle_of(Point3 p) {
  return std::atan2(p.y, p.x);
}

// In (-pi, pi].
double wrapped(double angle) {
  return std::remainder(angle, kTurn);
}

Point3 centroid(const SizeSource& s) {
  return (1.0 / 3) * (s.place[0] + s.place[1] + s.place[2]);
}

}  // namespace

double allowed_at(double size, double distance, double slope) {
  return size + slope * std::max(0.0, distance - kPlateau * size);
}

SectorRange sectors_of(const SizeSource& source, std::int32_t fold) {
  // Sides that pass the axis so near, in radians short of half a turn, pass it on either side.
  constexpr double kHalfTurn = std::numbers::pi - 1e-6;
  const auto n = static_cast<double>(fold);
  const SectorRange all{0, n};
  if (fold == 1) return all;
  std::array<double, 3> turns{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Point3 p = source.place[i];
    if (p.x == 0 && p.y == 0) return all;
    turns[i] = angle_of(p);
  }
  const double first = wrapped(turns[1] - turns[0]), second = wrapped(turns[2] - turns[1]),
               third = wrapped(turns[0] - turns[2]);
  // Round the axis they add up to a whole turn, else to none.
  const bool round = std::abs(first + second + third) > 1;
  if (round || std::max({std::abs(first), std::abs(second), std::abs(third)}) > kHalfTurn) {
    return all;
  }
  const double low = std::min({0.0, first, -third}), high = std::max({0.0, first, -third});
  return {(turns[0] + low) / kTurn * n, (turns[0] + high) / kTurn * n};
}

SizeField::SizeField(const std::vector<SizeSource>& sources, double gradation, std::int32_t fold)
    : rotations_(fold), slope_(gradation - 1) {
  // Every place is looked up in the first sector, so all copies get the same. Nearest to a place is a copy
  // that is at most half a sector away from it about the axis; a whole one leaves rounding its room.
  for (const SizeSource& s : sources) {
    const SectorRange range = sectors_of(s, fold);
    const auto from = static_cast<std::int64_t>(std::ceil(-1 - range.last));
    const auto to = static_cast<std::int64_t>(std::floor(2 - range.first));
    const std::int64_t copies = std::min<std::int64_t>(fold, to - from + 1);
    for (std::int64_t k = from; k < from + copies; ++k) {
      SizeSource copy = s;
      for (Point3& p : copy.place) p = rotations_.rotate(p, rotations_.reduce(k));
      sources_.push_back(copy);
    }
  }
  if (!sources_.empty()) build(0, static_cast<std::int32_t>(sources_.size()));
}

std::int32_t SizeField::sector_of(Point3 p) const {
  const std::int32_t n = rotations_.fold();
  if (n == 1) return 0;
  const double turn = angle_of(p) / kTurn;
  const double share = turn < 0 ? turn + 1 : turn;
  return std::min(n - 1, static_cast<std::int32_t>(share * n));
}

std::int32_t SizeField::build(std::int32_t first, std::int32_t last) {
  const auto id = static_cast<std::int32_t>(nodes_.size());
  Node node;
  node.low = node.high = sources_[at(first)].place[0];
  node.first = first;
  node.last = last;
  for (std::int32_t i = first; i < last; ++i) {
    for (const Point3& p : sources_[at(i)].place) {
      node.low = {std::min(node.low.x, p.x), std::min(node.low.y, p.y), std::min(node.low.z, p.z)};
      node.high = {std::max(node.high.x, p.x), std::max(node.high.y, p.y),
                   std::max(node.high.z, p.z)};
    }
    node.least = std::min(node.least, sources_[at(i)].size);
  }
  nodes_.push_back(node);
  if (last - first <= kLeafSize) return id;
  const Point3 d = node.high - node.low;
  const auto along = [&](const SizeSource& s) {
    const Point3 c = centroid(s);
    return d.x >= d.y && d.x >= d.z ? c.x : (d.y >= d.z ? c.y : c.z);
  };
  const std::int32_t middle = first + (last - first) / 2;
  std::nth_element(sources_.begin() + first, sources_.begin() + middle, sources_.begin() + last,
                   [&](const SizeSource& a, const SizeSource& b) { return along(a) < along(b); });
  build(first, middle);
  const std::int32_t right = build(middle, last);
  nodes_[at(id)].right = right;
  return id;
}

double SizeField::distance_to(std::int32_t source, Point3 p) const {
  const SizeSource& s = sources_[at(source)];
  return distance(p, closest_point(p, s.place[0], s.place[1], s.place[2]));
}

double SizeField::allowed_by(std::int32_t source, Point3 p) const {
  return allowed_at(sources_[at(source)].size, distance_to(source, p), slope_);
}

double SizeField::bound_of(const Node& node, Point3 p, double farther) const {
  const double dx = std::max({node.low.x - p.x, 0.0, p.x - node.high.x});
  const double dy = std::max({node.low.y - p.y, 0.0, p.y - node.high.y});
  const double dz = std::max({node.low.z - p.z, 0.0, p.z - node.high.z});
  const double distance = std::sqrt(dx * dx + dy * dy + dz * dz) + farther;
  // A larger size has a wider plateau, but never allows less: of those in the node the least decides
  // as long as growth is no faster than two to one; beyond, only that no source allows less than it is.
  return slope_ * kPlateau <= 1 ? allowed_at(node.least, distance, slope_) : node.least;
}

void SizeField::look_at(std::int32_t id, Point3 p, double farther, double& best) const {
  const Node& node = nodes_[at(id)];
  if (node.right == 0) {
    for (std::int32_t i = node.first; i < node.last; ++i) {
      const double size = sources_[at(i)].size;
      if (size >= best) continue;
      best = std::min(best, allowed_at(size, distance_to(i, p) + farther, slope_));
    }
    return;
  }
  std::pair<double, std::int32_t> near{bound_of(nodes_[at(id + 1)], p, farther), id + 1};
  std::pair<double, std::int32_t> far{bound_of(nodes_[at(node.right)], p, farther), node.right};
  if (far < near) std::swap(near, far);
  if (near.first < best) look_at(near.second, p, farther, best);
  if (far.first < best) look_at(far.second, p, farther, best);
}

double SizeField::smallest(Point3 p, double farther) const {
  double best = kNone;
  if (!nodes_.empty()) look_at(0, p, farther, best);
  return best;
}

bool SizeField::list_within(
    Point3 c, double reach, double most, std::size_t limit, std::vector<std::int32_t>& list) const {
  if (nodes_.empty()) return true;
  const std::size_t before = list.size();
  std::vector<std::int32_t> open{0};
  while (!open.empty()) {
    const std::int32_t id = open.back();
    open.pop_back();
    const Node& node = nodes_[at(id)];
    if (bound_of(node, c, -reach) >= most) continue;
    if (node.right != 0) {
      open.push_back(node.right);
      open.push_back(id + 1);
      continue;
    }
    for (std::int32_t i = node.first; i < node.last; ++i) {
      if (allowed_at(sources_[at(i)].size, distance_to(i, c) - reach, slope_) < most)
        list.push_back(i);
    }
    if (list.size() - before > limit) return false;
  }
  return true;
}

Point3 SizeField::in_first_sector(Point3 p) const {
  return rotations_.rotate(p, rotations_.reduce(-std::int64_t{sector_of(p)}));
}

double SizeField::max_edge(Point3 p, double enough) const {
  return nodes_.empty() ? enough : max_edge_there(in_first_sector(p), enough);
}

double SizeField::max_edge_there(Point3 p, double enough) const {
  double best = enough;
  if (!nodes_.empty()) look_at(0, p, 0, best);
  return best;
}

}  // namespace symcell::solid
