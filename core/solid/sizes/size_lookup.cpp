#include "core/solid/sizes/size_lookup.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace symcell::solid {
namespace {

// Sources of a cube that is not divided: a look at them costs no more than a few steps of a descent.
constexpr std::size_t kFew = 6;
// Nor is a cube divided in which sizes differ by less than this share: there are many sources alike, and
// its least answers most questions.
constexpr double kAlike = 0.15;
// About 100 MB; beyond, the field's own tree answers.
constexpr std::size_t kMostCubes = std::size_t{1} << 21;
// Half a diagonal of a cube by half a side, rounded up.
constexpr double kCorner = 1.7320509;

}  // namespace

SizeLookup::SizeLookup(std::shared_ptr<const SizeField> field, Point3 centre, double half)
    : field_(std::move(field)), centre_(centre), half_(half), cubes_(1) {
}

void SizeLookup::explore(std::size_t id, Point3 centre, double half) {
  Cube cube;
  const double reach = kCorner * half;
  cube.most = field_->most_within(centre, reach);
  cube.least = field_->least_within(centre, reach);
  cube.first = listed_.size();
  if (field_->list_within(centre, reach, cube.most, kFew, listed_)) {
    cube.state = State::kListed;
    cube.count = static_cast<std::int32_t>(listed_.size() - cube.first);
  } else {
    listed_.resize(cube.first);
    const bool alike = cube.most - cube.least <= kAlike * cube.most;
    if (alike || cubes_.size() + 8 > kMostCubes) {
      cube.state = State::kCrowded;
    } else {
      cube.state = State::kDivided;
      cube.first = cubes_.size();
      cubes_.resize(cubes_.size() + 8);
    }
  }
  cubes_[id] = cube;
}

double SizeLookup::max_edge(Point3 p, double enough) {
  const Point3 q = field_->in_first_sector(p);
  Point3 c = centre_;
  double half = half_;
  const bool inside =
      std::abs(q.x - c.x) <= half && std::abs(q.y - c.y) <= half && std::abs(q.z - c.z) <= half;
  if (!inside) return field_->max_edge_there(q, enough);
  for (std::size_t id = 0;;) {
    if (cubes_[id].state == State::kNew) explore(id, c, half);
    const Cube& cube = cubes_[id];
    if (cube.least >= enough) return enough;
    if (cube.state == State::kCrowded) return field_->max_edge_there(q, enough);
    if (cube.state == State::kListed) {
      double best = std::min(enough, cube.most);
      for (std::size_t i = cube.first; i < cube.first + static_cast<std::size_t>(cube.count); ++i) {
        best = std::min(best, field_->allowed_by(listed_[i], q));
      }
      return best;
    }
    half /= 2;
    const bool x = q.x > c.x, y = q.y > c.y, z = q.z > c.z;
    c = c + Point3{x ? half : -half, y ? half : -half, z ? half : -half};
    id = cube.first + (x ? 1U : 0U) + (y ? 2U : 0U) + (z ? 4U : 0U);
  }
}

}  // namespace symcell::solid
