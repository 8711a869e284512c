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

// Material that begins and ends within so few radians is what bodies overlap by, not one of them.
constexpr double kThinWedge = 1e-3;

// Which triangles at an edge belong together, and material in between.
class Pairing {
 public:
  // kSolid: what bounds one solid. kBodies: what bounds bodies that may overlap by rounding.
  enum class Of : std::uint8_t { kSolid, kBodies };

  Pairing(const IndexedSurface& surface, Of of) : surface_(surface), of_(of) {}

  // Calls join(use, use) for each two, and branches(uses) before at edges with more than two.
  template <class Join, class Branches>
  [[nodiscard]] Result<void> run(const Join& join, const Branches& branches) const {
    const std::vector<EdgeUse> uses = sorted_edge_uses(surface_.triangles);
    Result<void> state;
    for_each_edge(uses, [&](std::size_t begin, std::size_t end) {
      if (!state) return;
      if (end - begin == 2) {
        join(uses[begin], uses[begin + 1]);
        return;
      }
      branches(uses[begin]);
      state = pair_up({uses.begin() + static_cast<std::ptrdiff_t>(begin),
                       uses.begin() + static_cast<std::ptrdiff_t>(end)},
                      join);
    });
    return state;
  }

 private:
  [[nodiscard]] Point3 apex(const EdgeUse& use) const {
    const Triangle& t = surface_.triangles[use.triangle];
    std::size_t i = 0;
    while (t[i] == use.low || t[i] == use.high) ++i;
    return surface_.points[t[i]];
  }

  // Sorts the triangles as they follow each other round the edge. Of those in one place the ones that
  // material ends at come first: bodies touch there.
  void sort_round(std::vector<EdgeUse>& ring, Point3 u, Point3 v) const {
    const EdgeUse first = ring.front();
    const Point3 reference = apex(first), side = cross(v - u, reference - u);
    const auto part = [&](const EdgeUse& use) {
      const Point3 p = apex(use);
      switch (orientation_3(u, v, reference, p)) {
        case Sign::kPositive: return 1;
        case Sign::kNegative: return 3;
        case Sign::kZero: break;
      }
      if (dot(side, cross(v - u, p - u)) < 0) return 2;  // opposite
      return first.forward ? 0 : 4;
    };
    std::sort(ring.begin() + 1, ring.end(), [&](const EdgeUse& a, const EdgeUse& b) {
      const int pa = part(a), pb = part(b);
      if (pa != pb) return pa < pb;
      const Sign turn = orientation_3(u, v, apex(a), apex(b));
      return turn != Sign::kZero ? turn == Sign::kPositive : a.forward > b.forward;
    });
  }

  template <class Join>
  [[nodiscard]] Result<void> pair_up(std::vector<EdgeUse> ring, const Join& join) const {
    const Point3 u = surface_.points[ring.front().low], v = surface_.points[ring.front().high];
    sort_round(ring, u, v);
    // Turning on beyond a triangle that runs against the edge one is behind it: material begins there.
    std::ptrdiff_t depth = 0, least = 0;
    std::size_t start = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      depth += ring[i].forward ? -1 : 1;
      if (depth < least) {
        least = depth;
        start = i + 1;
      }
    }
    std::rotate(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(start % ring.size()),
                ring.end());
    if (depth != 0) return unbalanced(ring);
    std::vector<EdgeUse> begins, ends;
    for (const EdgeUse& use : ring) (use.forward ? ends : begins).push_back(use);
    const std::size_t shift = of_ == Of::kBodies ? first_to_end(begins, ends) : 0;
    for (std::size_t i = 0; i < begins.size(); ++i) {
      join(begins[i], ends[(i + shift) % ends.size()]);
    }
    return {};
  }

  // Material that began first ends first. With which of the ends? Where bodies fill all that is round the
  // edge, and overlap, with the second one.
  [[nodiscard]] std::size_t first_to_end(const std::vector<EdgeUse>& begins,
                                         const std::vector<EdgeUse>& ends) const {
    for (std::size_t shift = 0; shift < begins.size(); ++shift) {
      bool thin = false;
      for (std::size_t i = 0; i < begins.size(); ++i) {
        thin = thin || is_thin(begins[i], ends[(i + shift) % ends.size()]);
      }
      if (!thin) return shift;
    }
    return 0;
  }

  [[nodiscard]] bool is_thin(const EdgeUse& a, const EdgeUse& b) const {
    const Point3 u = surface_.points[a.low], along = surface_.points[a.high] - u;
    const Point3 p = cross(along, apex(a) - u), q = cross(along, apex(b) - u);
    return std::atan2(length(cross(p, q)), dot(p, q)) < kThinWedge;
  }

  [[nodiscard]] Failure unbalanced(const std::vector<EdgeUse>& ring) const {
    const std::int32_t a = surface_.source[ring[0].triangle],
                       b = surface_.source[ring[1 % ring.size()].triangle];
    return fail(ErrorCode::kNotWatertight,
                "of the triangles at the edge from " +
                    describe_point(surface_.points[ring.front().low]) + " to " +
                    describe_point(surface_.points[ring.front().high]) + ", such as " +
                    std::to_string(a) + " and " + std::to_string(b) +
                    ", not as many have material on one side as on the other",
                {a, b});
  }

  const IndexedSurface& surface_;
  Of of_;
};

// Corners of triangles at one point that hang together over edges.
class Fans {
 public:
  explicit Fans(const IndexedSurface& surface)
      : surface_(surface), fans_(3 * surface.triangles.size()) {}

  void join(const EdgeUse& a, const EdgeUse& b) {
    for (const std::int32_t v : {a.low, a.high}) {
      fans_.join(corner(a.triangle, v), corner(b.triangle, v));
    }
  }

  // `corner`: 3 a triangle.
  [[nodiscard]] std::int32_t root(std::int32_t corner) { return fans_.root(corner); }

  // Points with more than one, ascending.
  [[nodiscard]] std::vector<std::int32_t> pinched() {
    std::vector<std::int32_t> only(surface_.points.size(), -1);
    std::vector<std::int32_t> result;
    const auto corners = static_cast<std::int32_t>(3 * surface_.triangles.size());
    for (std::int32_t c = 0; c < corners; ++c) {
      const std::int32_t v = surface_.triangles[c / 3][c % 3];
      if (only[v] < 0) only[v] = root(c);
      if (only[v] != root(c)) result.push_back(v);
    }
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  }

 private:
  [[nodiscard]] std::int32_t corner(std::int32_t t, std::int32_t v) const {
    const Triangle& corners = surface_.triangles[t];
    return 3 * t + static_cast<std::int32_t>(std::find(corners.begin(), corners.end(), v) -
                                             corners.begin());
  }

  const IndexedSurface& surface_;
  UnionFind fans_;
};

class Splitter {
 public:
  explicit Splitter(IndexedSurface& surface) : surface_(surface), fans_(surface) {}

  Result<Touching> run(double gap) {
    std::vector<std::int32_t> ends;
    SYMCELL_TRY(Pairing(surface_, Pairing::Of::kSolid)
                    .run([&](const EdgeUse& a, const EdgeUse& b) { fans_.join(a, b); },
                         [&](const EdgeUse& edge) {
                           ++split_.edges;
                           ends.insert(ends.end(), {edge.low, edge.high});
                         }));
    const std::vector<std::int32_t> touched = fans_.pinched();
    std::sort(ends.begin(), ends.end());
    split_.corners =
        static_cast<std::size_t>(std::count_if(touched.begin(), touched.end(), [&](std::int32_t v) {
          return !std::binary_search(ends.begin(), ends.end(), v);
        }));
    if (!touched.empty()) copy_points(touched, gap);
    return split_;
  }

 private:
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
  Fans fans_;
  Touching split_;
};

}  // namespace

Touching touching_places(const IndexedSurface& surface, std::vector<Point3>* places) {
  Touching found;
  Fans fans(surface);
  std::vector<std::int32_t> ends;
  const std::vector<EdgeUse> uses = sorted_edge_uses(surface.triangles);
  for_each_edge(uses, [&](std::size_t begin, std::size_t end) {
    if (end - begin > 2) {
      ++found.edges;
      ends.insert(ends.end(), {uses[begin].low, uses[begin].high});
      if (places != nullptr) places->push_back(surface.points[uses[begin].low]);
    }
    for (std::size_t i = begin + 1; i < end; ++i) fans.join(uses[begin], uses[i]);
  });
  std::sort(ends.begin(), ends.end());
  for (const std::int32_t v : fans.pinched()) {
    if (std::binary_search(ends.begin(), ends.end(), v)) continue;
    ++found.corners;
    if (places != nullptr) places->push_back(surface.points[v]);
  }
  return found;
}

Result<Touching> split_sheets(IndexedSurface& surface, double gap) {
  return Splitter(surface).run(gap);
}

Result<std::vector<std::int32_t>> bodies_of(const IndexedSurface& surface) {
  UnionFind bodies(surface.triangles.size());
  SYMCELL_TRY(
      Pairing(surface, Pairing::Of::kBodies)
          .run([&](const EdgeUse& a, const EdgeUse& b) { bodies.join(a.triangle, b.triangle); },
               [](const EdgeUse&) {}));
  std::vector<std::int32_t> result(surface.triangles.size());
  for (std::size_t t = 0; t < result.size(); ++t) {
    result[t] = bodies.root(static_cast<std::int32_t>(t));
  }
  return result;
}

}  // namespace symcell::solid
