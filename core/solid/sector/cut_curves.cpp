#include "core/solid/sector/cut_curves.hpp"

#include <algorithm>
#include <cmath>

namespace symcell::solid {
namespace {

class CurveFinder {
 public:
  explicit CurveFinder(const WedgePatch& patch)
      : patch_(patch), next_lower_(patch.points.size(), -1), next_upper_(patch.points.size(), -1) {}

  Result<CutCurves> run() {
    SYMCELL_TRY(collect());
    CutCurves curves;
    if (!follow(next_lower_, curves.lower) || !follow(next_upper_, curves.higher)) {
      return fail(ErrorCode::kInternal, "a curve of the cut ends in the open");
    }
    for (CutCurve& curve : curves.higher)
      std::reverse(curve.vertices.begin(), curve.vertices.end());
    return curves;
  }

 private:
  Result<void> collect() {
    const std::vector<EdgeUse> uses = sorted_edge_uses(patch_.triangles);
    Result<void> result;
    for_each_edge(uses, [&](std::size_t begin, std::size_t end) {
      if (!result) return;
      const EdgeUse& use = uses[begin];
      const std::int32_t a = use.forward ? use.low : use.high;
      const std::int32_t b = use.forward ? use.high : use.low;
      if (patch_.on_axis(a) && patch_.on_axis(b)) {
        result = fail(ErrorCode::kInternal, "an edge lies on the axis");
        return;
      }
      if (end - begin == 2) return;
      if (end - begin > 2) {
        result = fail(ErrorCode::kInternal, "an edge of the cut has more than two triangles");
        return;
      }
      const bool lower = patch_.on_lower[a] != 0 && patch_.on_lower[b] != 0;
      const bool higher = patch_.on_higher[a] != 0 && patch_.on_higher[b] != 0;
      if (lower == higher) {
        result = fail(ErrorCode::kInternal, "an open edge lies off the cut");
        return;
      }
      std::int32_t& next = (lower ? next_lower_ : next_upper_)[a];
      if (next >= 0) {
        result = fail(ErrorCode::kInternal, "the surface is pinched on the cut");
        return;
      }
      next = b;
    });
    return result;
  }

  // Open curves first: they start at vertices that nothing leads to.
  [[nodiscard]] bool follow(std::vector<std::int32_t>& next, std::vector<CutCurve>& curves) const {
    std::vector<std::uint8_t> entered(next.size(), 0);
    for (const std::int32_t v : next) {
      if (v < 0) continue;
      if (entered[v] != 0) return false;
      entered[v] = 1;
    }
    for (const bool closed : {false, true}) {
      for (std::size_t i = 0; i < next.size(); ++i) {
        auto v = static_cast<std::int32_t>(i);
        if (next[v] < 0 || (!closed && entered[v] != 0)) continue;
        if (!closed && !patch_.on_axis(v)) return false;
        CutCurve curve;
        curve.closed = closed;
        while (v >= 0 && (curve.vertices.empty() || !closed || v != curve.vertices.front())) {
          if (closed && patch_.on_axis(v)) return false;
          curve.vertices.push_back(v);
          const std::int32_t to = next[v];
          next[v] = -1;
          v = to;
          // An axis vertex ends an open curve even if another one starts there.
          if (!closed && v >= 0 && patch_.on_axis(v)) {
            curve.vertices.push_back(v);
            break;
          }
        }
        if (!closed && !patch_.on_axis(curve.vertices.back())) return false;
        curves.push_back(std::move(curve));
      }
    }
    return true;
  }

  const WedgePatch& patch_;
  std::vector<std::int32_t> next_lower_;  // along the boundary, -1: none
  std::vector<std::int32_t> next_upper_;
};

}  // namespace

Result<CutCurves> find_cut_curves(const WedgePatch& patch) {
  return CurveFinder(patch).run();
}

std::vector<Point2> curve_points(const WedgePatch& patch, const CutCurve& curve) {
  std::vector<Point2> points;
  points.reserve(curve.vertices.size() + 1);
  for (const std::int32_t v : curve.vertices) {
    const Point3& p = patch.points[v];
    points.push_back({std::hypot(p.x, p.y), p.z});
  }
  if (curve.closed) points.push_back(points.front());
  return points;
}

}  // namespace symcell::solid
