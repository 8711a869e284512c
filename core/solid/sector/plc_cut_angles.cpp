// `cut_angles`: where the half-planes may run.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <vector>

#include "core/solid/sector/plc_sector.hpp"

namespace symcell::solid {
namespace {

// Angle about the axis in [0, 2 pi).
double angle_of(Point3 p) {
  const double a = std::atan2(p.y, p.x);
  return a < 0 ? a + 2 * std::numbers::pi : a;
}

}  // namespace

std::vector<double> cut_angles(const SymmetricPlc& plc) {
  const double wedge = 2 * std::numbers::pi / plc.symmetry.fold;
  std::vector<double> angles;
  for (std::size_t o = 0; o < plc.orbit_points.size(); ++o) {
    if (plc.on_axis[o] != 0) continue;
    angles.push_back(std::fmod(angle_of(plc.orbit_points[o]), wedge));
  }
  if (plc.symmetry.fold == 1 || angles.empty()) return {0};
  std::sort(angles.begin(), angles.end());
  struct Gap {
    double size;
    double begin;
  };
  std::vector<Gap> gaps;
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const double next = i + 1 < angles.size() ? angles[i + 1] : angles.front() + wedge;
    gaps.push_back({next - angles[i], angles[i]});
  }
  std::sort(gaps.begin(), gaps.end(), [](const Gap& g, const Gap& h) {
    return std::tuple(-g.size, g.begin) < std::tuple(-h.size, h.begin);
  });
  // A narrow gap gives short edges; one made by rounding alone gives no sound cut at all.
  constexpr std::size_t kGaps = 8;
  constexpr double kNarrow = 0.05;
  while (gaps.size() > kGaps || gaps.back().size < kNarrow * gaps.front().size) gaps.pop_back();
  std::vector<double> result;
  for (const double share : {0.5, 0.37, 0.61, 0.27, 0.73}) {
    for (const Gap& gap : gaps) result.push_back(std::fmod(gap.begin + share * gap.size, wedge));
  }
  return result;
}

}  // namespace symcell::solid
