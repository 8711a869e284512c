#include "core/solid/surface/sheets.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/base/union_find.hpp"
#include "core/geometry/predicates_3.hpp"
#include "core/model/describe.hpp"

namespace symcell::solid {
namespace {

class Splitter {
 public:
  explicit Splitter(IndexedSurface& surface)
      : surface_(surface), fans_(3 * surface.triangles.size()) {}

  Result<std::size_t> run(double gap) {
    const std::vector<EdgeUse> uses = sorted_edge_uses(surface_.triangles);
    std::vector<std::int32_t> touched;
    Result<void> state;
    for_each_edge(uses, [&](std::size_t begin, std::size_t end) {
      if (!state) return;
      if (end - begin == 2) {
        join(uses[begin], uses[begin + 1]);
        return;
      }
      ++split_;
      touched.insert(touched.end(), {uses[begin].low, uses[begin].high});
      state = pair_up({uses.begin() + static_cast<std::ptrdiff_t>(begin),
                       uses.begin() + static_cast<std::ptrdiff_t>(end)});
    });
    if (!state) return error_of(state);
    if (split_ == 0) return 0;
    std::sort(touched.begin(), touched.end());
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    copy_points(touched, gap);
    return split_;
  }

 private:
  [[nodiscard]] std::int32_t corner(std::int32_t t, std::int32_t v) const {
    const Triangle& corners = surface_.triangles[t];
    return 3 * t + static_cast<std::int32_t>(std::find(corners.begin(), corners.end(), v) -
                                             corners.begin());
  }

  void join(const EdgeUse& a, const EdgeUse& b) {
    for (const std::int32_t v : {a.low, a.high}) {
      fans_.join(corner(a.triangle, v), corner(b.triangle, v));
    }
  }

  [[nodiscard]] Point3 apex(const EdgeUse& use) const {
    const Triangle& t = surface_.triangles[use.triangle];
    std::size_t i = 0;
    while (t[i] == use.low || t[i] == use.high) ++i;
    return surface_.points[t[i]];
  }

  Result<void> pair_up(std::vector<EdgeUse> ring) {
    const Point3 u = surface_.points[ring.front().low], v = surface_.points[ring.front().high];
    const Point3 reference = apex(ring.front());
    const auto half = [&](const EdgeUse& use) {
      return 1 - static_cast<int>(orientation_3(u, v, reference, apex(use)));
    };
    std::sort(ring.begin() + 1, ring.end(), [&](const EdgeUse& a, const EdgeUse& b) {
      const int ha = half(a), hb = half(b);
      return ha != hb ? ha < hb : orientation_3(u, v, apex(a), apex(b)) == Sign::kPositive;
    });
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const EdgeUse& next = ring[(i + 1) % ring.size()];
      if (ring[i].forward == next.forward) {
        return fail(ErrorCode::kNotWatertight,
                    "the " + std::to_string(ring.size()) + " triangles at the edge from " +
                        describe_point(u) + " to " + describe_point(v) + ", such as " +
                        std::to_string(surface_.source[ring[i].triangle]) + " and " +
                        std::to_string(surface_.source[next.triangle]) +
                        ", do not have material and empty space between them by turns",
                    {surface_.source[ring[i].triangle], surface_.source[next.triangle]});
      }
      // Turning on beyond a triangle that runs against the edge one is behind it.
      if (!ring[i].forward) join(ring[i], next);
    }
    return {};
  }

  void copy_points(const std::vector<std::int32_t>& touched, double gap) {
    std::vector<std::int32_t> number(surface_.points.size(), -1);
    for (std::size_t k = 0; k < touched.size(); ++k) {
      number[touched[k]] = static_cast<std::int32_t>(k);
    }
    // Of each touched point: its fans, by their first corners.
    std::vector<std::vector<std::int32_t>> fans(touched.size());
    const auto count = static_cast<std::int32_t>(surface_.triangles.size());
    for (std::int32_t c = 0; c < 3 * count; ++c) {
      const std::int32_t k = number[surface_.triangles[c / 3][c % 3]];
      if (k < 0) continue;
      const std::int32_t root = fans_.root(c);
      if (std::find(fans[k].begin(), fans[k].end(), root) == fans[k].end()) fans[k].push_back(root);
    }
    std::vector<Point3> normals(fans_size(), Point3{});
    for (std::int32_t c = 0; c < 3 * count; ++c) {
      const Triangle& t = surface_.triangles[c / 3];
      if (number[t[c % 3]] < 0) continue;
      const Point3 at = surface_.points[t[c % 3]];
      const Point3 p = surface_.points[t[(c + 1) % 3]] - at,
                   q = surface_.points[t[(c + 2) % 3]] - at;
      const double angle = std::atan2(length(cross(p, q)), dot(p, q));
      const Point3 n = area_normal(surface_, t);
      if (!(length(n) > 0)) continue;
      Point3& sum = normals[fans_.root(c)];
      sum = sum + (angle / length(n)) * n;
    }
    std::vector<std::int32_t> copy(fans_size(), -1);
    for (std::size_t k = 0; k < touched.size(); ++k) {
      if (fans[k].size() < 2) continue;
      const Point3 place = surface_.points[touched[k]];
      for (std::size_t i = 0; i < fans[k].size(); ++i) {
        const Point3 n = normals[fans[k][i]];
        const Point3 moved = length(n) > 0 ? place - (gap / length(n)) * n : place;
        if (i == 0) {
          copy[fans[k][i]] = touched[k];
          surface_.points[touched[k]] = moved;
        } else {
          copy[fans[k][i]] = static_cast<std::int32_t>(surface_.points.size());
          surface_.points.push_back(moved);
        }
      }
    }
    for (std::int32_t c = 0; c < 3 * count; ++c) {
      const std::int32_t to = copy[fans_.root(c)];
      if (to >= 0) surface_.triangles[c / 3][c % 3] = to;
    }
  }

  [[nodiscard]] std::size_t fans_size() const { return 3 * surface_.triangles.size(); }

  IndexedSurface& surface_;
  UnionFind fans_;  // of corners, 3 a triangle: joined across edges within a sheet
  std::size_t split_ = 0;
};

}  // namespace

Result<std::size_t> split_sheets(IndexedSurface& surface, double gap) {
  return Splitter(surface).run(gap);
}

}  // namespace symcell::solid
