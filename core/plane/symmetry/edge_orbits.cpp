#include "core/plane/symmetry/edge_orbits.hpp"

#include <algorithm>
#include <string>

#include "core/base/index.hpp"

namespace symcell::plane {
namespace {

Failure not_symmetric(std::string what, std::vector<std::int64_t> segments) {
  const std::string pointer = "/segments/" + std::to_string(segments.front());
  return fail(ErrorCode::kNotSymmetric, std::move(what), std::move(segments), pointer);
}

}  // namespace

void EdgeOrbits::add(OrbitVertex from, OrbitVertex to, const PreparedEdge& edge) {
  if (from == to) return;  // shorter than the link distance
  Copy copy;
  copy.marker = edge.marker;
  copy.segment = edge.segment;
  copy.left = edge.left;
  copy.right = edge.right;
  copy.labels = {edge.left_label, edge.right_label};
  const std::int32_t turn = rotations_.subtract(to.exponent, from.exponent);
  const bool later = to.orbit < from.orbit || (to.orbit == from.orbit && 2 * turn > fold());
  if (from.orbit == centre_orbit_ || (to.orbit != centre_orbit_ && later)) {
    std::swap(from, to);
    std::swap(copy.left, copy.right);
    std::swap(copy.labels.left, copy.labels.right);
  }
  copy.a = from.orbit;
  copy.b = to.orbit;
  copy.exponent = from.exponent;
  copy.turn = to.orbit == centre_orbit_ ? 0 : rotations_.subtract(to.exponent, from.exponent);
  copies_.push_back(copy);
}

Result<void> EdgeOrbits::close(ClosedOrbits& result) {
  std::sort(copies_.begin(), copies_.end(), [](const Copy& s, const Copy& t) {
    return std::tie(s.a, s.b, s.turn, s.exponent, s.segment) <
           std::tie(t.a, t.b, t.turn, t.exponent, t.segment);
  });
  // Two edges merged into one place count once.
  const auto same_place = [](const Copy& s, const Copy& t) {
    return s.orbit() == t.orbit() && s.exponent == t.exponent;
  };
  copies_.erase(std::unique(copies_.begin(), copies_.end(), same_place), copies_.end());
  result.pslg.segments.reserve(copies_.size() / at(fold()));
  result.sides.reserve(copies_.size());
  result.pslg.uniform_markers = markers_are_uniform();
  for (std::size_t i = 0; i < copies_.size();) {
    std::size_t end = i + 1;
    while (end < copies_.size() && copies_[end].orbit() == copies_[i].orbit()) ++end;
    SYMCELL_TRY(check_orbit(i, end));
    add_segment(i, result);
    i = end;
  }
  return {};
}

bool EdgeOrbits::markers_are_uniform() const {
  for (std::size_t i = 1; i < copies_.size(); ++i) {
    const Copy& s = copies_[i - 1];
    const Copy& t = copies_[i];
    if (s.orbit() == t.orbit() && s.marker != t.marker) return false;
  }
  return true;
}

Result<void> EdgeOrbits::check_orbit(std::size_t begin, std::size_t end) const {
  const Copy& first = copies_[begin];
  const std::string name = "segment " + std::to_string(first.segment);
  if (first.a == first.b && 2 * first.turn == fold()) {
    return not_symmetric(name + " is its own image under half a turn, but misses the centre",
                         {first.segment});
  }
  if (end - begin != at(fold())) {
    const std::size_t missing = at(fold()) - (end - begin);
    return not_symmetric(name + " lacks " + std::to_string(missing) + " of its " +
                             std::to_string(fold()) + " images",
                         {first.segment});
  }
  for (std::size_t i = begin + 1; i < end; ++i) {
    SYMCELL_TRY(check_alike(first, copies_[i]));
  }
  return {};
}

Result<void> EdgeOrbits::check_alike(const Copy& first, const Copy& other) const {
  std::string difference;
  if ((other.left == 0) != (first.left == 0) || (other.right == 0) != (first.right == 0)) {
    difference = "a hole or the outside lies beside only one of them";
  } else if (other.left != first.left || other.right != first.right) {
    difference =
        "the regions beside them differ in attribute or max_area (ignore_markers sets regions "
        "aside)";
  } else if (other.marker != first.marker && !ignore_markers_) {
    difference = "their markers " + std::to_string(first.marker) + " and " +
                 std::to_string(other.marker) + " differ (ignore_markers sets markers aside)";
  } else {
    return {};
  }
  return not_symmetric("segments " + std::to_string(first.segment) + " and " +
                           std::to_string(other.segment) + " are images of each other, but " +
                           difference,
                       {first.segment, other.segment});
}

// Copies are sorted by exponent, so the first one has exponent 0.
void EdgeOrbits::add_segment(std::size_t begin, ClosedOrbits& result) const {
  const Copy& copy = copies_[begin];
  SymmetricPslg& pslg = result.pslg;
  SymmetricSegment segment;
  segment.a = {copy.a, 0};
  segment.b = {copy.b, copy.turn};
  segment.first_marker = static_cast<std::int32_t>(pslg.segment_markers.size());
  pslg.segments.push_back(segment);
  for (std::size_t k = 0; k < at(fold()); ++k) {
    const Copy& image = copies_[begin + k];
    if (k == 0 || !pslg.uniform_markers) pslg.segment_markers.push_back(image.marker);
    result.sides.push_back(image.labels);
  }
}

}  // namespace symcell::plane
