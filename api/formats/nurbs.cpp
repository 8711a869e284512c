#include "api/formats/nurbs.hpp"

#include <algorithm>
#include <array>

namespace symcell {
namespace {

constexpr std::size_t kMostDegree = 25;  // of what CAD programs write

struct Weighted {
  Point2 place;  // times the weight
  double weight = 1;
};

}  // namespace

bool Nurbs::valid() const {
  return degree >= 1 && degree <= kMostDegree && controls.size() > degree &&
         knots.size() == controls.size() + degree + 1 &&
         std::is_sorted(knots.begin(), knots.end()) && begin() < end() &&
         (weights.empty() || weights.size() == controls.size()) &&
         std::all_of(weights.begin(), weights.end(), [](double w) { return w > 0; });
}

Point2 Nurbs::at(double t) const {
  // The last span that is not empty holds its end, too.
  const auto first = knots.begin() + static_cast<std::ptrdiff_t>(degree);
  const auto last = knots.begin() + static_cast<std::ptrdiff_t>(controls.size());
  auto above = std::upper_bound(first, last, t);
  if (above == last) above = std::lower_bound(first, last, end());
  const auto span = static_cast<std::size_t>(above - knots.begin()) - 1;
  std::array<Weighted, kMostDegree + 1> d;
  for (std::size_t j = 0; j <= degree; ++j) {
    const std::size_t i = span - degree + j;
    const double w = weights.empty() ? 1 : weights[i];
    d[j] = {w * controls[i], w};
  }
  for (std::size_t r = 1; r <= degree; ++r) {
    for (std::size_t j = degree; j >= r; --j) {
      const std::size_t i = span - degree + j;
      const double width = knots[i + degree - r + 1] - knots[i];
      const double a = width > 0 ? (t - knots[i]) / width : 0;
      d[j].place = (1 - a) * d[j - 1].place + a * d[j].place;
      d[j].weight = (1 - a) * d[j - 1].weight + a * d[j].weight;
    }
  }
  return (1 / d[degree].weight) * d[degree].place;
}

}  // namespace symcell
