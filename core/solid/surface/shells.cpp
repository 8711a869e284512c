#include "core/solid/surface/shells.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "core/base/union_find.hpp"
#include "core/geometry/triangle_tree.hpp"
#include "core/geometry/winding.hpp"
#include "core/model/describe.hpp"

namespace symcell::solid {
namespace {

// A shell thinner than this share of its box is no body: its volume's sign would be noise.
constexpr double kFlatVolumeRel = 1e-12;
constexpr std::size_t kCheckEvery = 512;  // shells, each against all others
// Of a shell that meets another, so many triangles at most are looked at, those that lie on it, to a
// share of the diameter, apart.
constexpr std::size_t kMostLookedAt = 2000;
constexpr double kOnShellRel = 1e-7;
constexpr double kSurelyOutside = 0.25, kSurelyInside = 0.75;

struct Neighbour {
  std::int32_t triangle = -1;
  bool agrees = false;
};

std::vector<std::array<Neighbour, 3>> neighbours_of(std::span<const Triangle> triangles) {
  std::vector<std::array<Neighbour, 3>> result(triangles.size());
  const std::vector<EdgeUse> uses = sorted_edge_uses(triangles);
  const auto side = [&](const EdgeUse& use) {
    const Triangle& t = triangles[use.triangle];
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t a = t[i], b = t[(i + 1) % 3];
      if (std::min(a, b) == use.low && std::max(a, b) == use.high) return i;
    }
    return std::size_t{0};
  };
  for_each_edge(uses, [&](std::size_t begin, std::size_t end) {
    if (end - begin != 2) return;
    const EdgeUse &a = uses[begin], &b = uses[begin + 1];
    const bool agrees = a.forward != b.forward;
    result[a.triangle][side(a)] = {b.triangle, agrees};
    result[b.triangle][side(b)] = {a.triangle, agrees};
  });
  return result;
}

class Orienter {
 public:
  Orienter(IndexedSurface& surface,
           ExecutionContext& context,
           std::span<const std::pair<std::int32_t, std::int32_t>> crossing)
      : surface_(surface), context_(context), crossing_(crossing) {}

  Result<Shells> run() {
    SYMCELL_TRY(agree());
    SYMCELL_TRY(join_at_edges());
    SYMCELL_TRY(nest());
    return std::move(shells_);
  }

 private:
  void turn(std::int32_t t) { std::swap(surface_.triangles[t][1], surface_.triangles[t][2]); }

  Result<void> agree() {
    const auto count = surface_.triangles.size();
    const auto neighbours = neighbours_of(surface_.triangles);
    std::vector<char> flip(count, -1);
    shells_.of_triangle.assign(count, -1);
    for (std::size_t seed = 0; seed < count; ++seed) {
      if (shells_.of_triangle[seed] >= 0) continue;
      const std::int32_t shell = shells_.count++;
      std::vector<std::int32_t> members{static_cast<std::int32_t>(seed)};
      shells_.of_triangle[seed] = shell;
      flip[seed] = 0;
      for (std::size_t k = 0; k < members.size(); ++k) {
        const std::int32_t t = members[k];
        for (const Neighbour& n : neighbours[t]) {
          if (n.triangle < 0) continue;
          const char wanted = static_cast<char>(n.agrees ? flip[t] : 1 - flip[t]);
          if (shells_.of_triangle[n.triangle] < 0) {
            shells_.of_triangle[n.triangle] = shell;
            flip[n.triangle] = wanted;
            members.push_back(n.triangle);
          } else if (flip[n.triangle] != wanted) {
            return fail(ErrorCode::kNotWatertight,
                        "the surface is one-sided: triangles " +
                            std::to_string(surface_.source[t]) + " and " +
                            std::to_string(surface_.source[n.triangle]) +
                            " cannot be oriented alike; mend the surface so that it bounds a solid",
                        {surface_.source[t], surface_.source[n.triangle]});
          }
        }
      }
      std::size_t turned = 0;
      for (const std::int32_t t : members) turned += flip[t] == 1 ? 1 : 0;
      const bool turn_others = turned > members.size() / 2;
      for (const std::int32_t t : members) {
        if ((flip[t] == 1) == turn_others) continue;
        turn(t);
        ++shells_.flipped_alone;
      }
      members_.push_back(std::move(members));
    }
    return {};
  }

  // Shells with as many triangles one way as the other at every edge stand alone.
  Result<void> join_at_edges() {
    const std::vector<EdgeUse> uses = sorted_edge_uses(surface_.triangles);
    UnionFind joined(members_.size());
    Result<void> state;
    for_each_edge(uses, [&](std::size_t begin, std::size_t end) {
      if (!state || end - begin == 2) return;
      std::map<std::int32_t, std::int32_t> net;  // by shell
      std::int32_t sum = 0;
      for (std::size_t i = begin; i < end; ++i) {
        const std::int32_t step = uses[i].forward ? 1 : -1;
        net[shells_.of_triangle[uses[i].triangle]] += step;
        sum += step;
      }
      if (sum != 0) {
        const EdgeUse& use = uses[begin];
        state = fail(ErrorCode::kNotWatertight,
                     std::to_string(end - begin) + " triangles at the edge from " +
                         describe_point(surface_.points[use.low]) + " to " +
                         describe_point(surface_.points[use.high]) + ", such as " +
                         std::to_string(surface_.source[use.triangle]) +
                         ", cannot be told apart: as many must run one way as the other",
                     {surface_.source[use.triangle]});
        return;
      }
      std::int32_t first = -1;
      for (const auto& [shell, steps] : net) {
        if (steps == 0) continue;
        if (first < 0) first = shell;
        joined.join(first, shell);
      }
    });
    if (!state) return state;
    std::vector<std::int32_t> number(members_.size(), -1);
    std::vector<std::vector<std::int32_t>> members;
    for (std::size_t s = 0; s < members_.size(); ++s) {
      std::int32_t& n = number[joined.root(static_cast<std::int32_t>(s))];
      if (n < 0) {
        n = static_cast<std::int32_t>(members.size());
        members.emplace_back();
      }
      members[n].insert(members[n].end(), members_[s].begin(), members_[s].end());
    }
    members_ = std::move(members);
    shells_.count = static_cast<std::int32_t>(members_.size());
    for (std::size_t s = 0; s < members_.size(); ++s) {
      for (const std::int32_t t : members_[s]) {
        shells_.of_triangle[t] = static_cast<std::int32_t>(s);
      }
    }
    return {};
  }

  // Pairs of shells that meet, the smaller number first.
  [[nodiscard]] std::vector<std::pair<std::int32_t, std::int32_t>> meeting_shells() const {
    std::vector<std::pair<std::int32_t, std::int32_t>> pairs;
    for (const auto& [a, b] : crossing_) {
      const auto pair = std::minmax(shells_.of_triangle[a], shells_.of_triangle[b]);
      if (pair.first != pair.second) pairs.emplace_back(pair);
    }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
  }

  // Of a shell that meets another in corners or edges at most: where one of its triangles clearly is.
  [[nodiscard]] bool is_inside(std::size_t inner, std::size_t outer) const {
    double clearest = 0.5;
    for (const std::int32_t t : members_[inner]) {
      const Point3 middle = (1.0 / 3) * (point(t, 0) + point(t, 1) + point(t, 2));
      const double w = std::abs(winding_number(surface_, members_[outer], middle));
      if (std::abs(w - 0.5) > std::abs(clearest - 0.5)) clearest = w;
      if (clearest < kSurelyOutside || clearest > kSurelyInside) break;
    }
    return clearest > 0.5;
  }

  // Of a shell that meets another: whether some of it lies inside the other, some outside.
  struct Lies {
    bool inside = false;
    bool outside = false;
  };
  [[nodiscard]] Result<Lies> lies(std::size_t inner, std::size_t outer) const {
    const std::size_t step = members_[inner].size() / kMostLookedAt + 1;
    std::vector<Triangle> triangles;
    for (const std::int32_t t : members_[outer]) triangles.push_back(surface_.triangles[t]);
    const TriangleTree tree(surface_.points, triangles);
    const double on = kOnShellRel * bounding_box(surface_.points).diagonal();
    Lies result;
    for (std::size_t i = 0; i < members_[inner].size(); i += step) {
      SYMCELL_TRY(context_.check());
      const std::int32_t t = members_[inner][i];
      const Point3 middle = (1.0 / 3) * (point(t, 0) + point(t, 1) + point(t, 2));
      if (tree.within(middle, on)) continue;
      const double w = std::abs(winding_number(surface_, members_[outer], middle));
      result.outside |= w < kSurelyOutside;
      result.inside |= w > kSurelyInside;
      if (result.outside && result.inside) break;
    }
    return result;
  }

  Result<void> nest() {
    const auto count = static_cast<std::size_t>(shells_.count);
    std::vector<Box3> boxes(count);
    for (std::size_t s = 0; s < count; ++s) {
      const Point3 first = point(members_[s].front(), 0);
      double sixfold = 0;
      std::vector<Point3> corners;
      corners.reserve(3 * members_[s].size());
      for (const std::int32_t t : members_[s]) {
        for (std::size_t i = 0; i < 3; ++i) corners.push_back(point(t, i));
        const auto end = corners.size();
        sixfold += dot(corners[end - 3] - first,
                       cross(corners[end - 2] - first, corners[end - 1] - first));
      }
      boxes[s] = bounding_box(corners);
      const double size = boxes[s].diagonal();
      if (!(std::abs(sixfold) > kFlatVolumeRel * size * size * size)) {
        return fail(ErrorCode::kDegenerateGeometry,
                    "the closed part of the surface with triangle " +
                        std::to_string(surface_.source[members_[s].front()]) + " at " +
                        describe_point(first) + " encloses no volume; remove it",
                    {surface_.source[members_[s].front()]});
      }
      positive_.push_back(sixfold > 0);
    }
    shells_.depth.assign(count, 0);
    shells_.in_overlap.assign(count, false);
    shells_.turned.assign(count, false);
    const auto meeting = meeting_shells();
    for (std::size_t s = 0; s < count; ++s) {
      if (s % kCheckEvery == 0) {
        SYMCELL_TRY(context_.check());
      }
      std::vector<std::int32_t> enclosing;
      for (std::size_t o = 0; o < count; ++o) {
        if (o == s || !boxes[o].encloses(boxes[s])) continue;
        const std::pair<std::int32_t, std::int32_t> both =
            std::minmax(static_cast<std::int32_t>(s), static_cast<std::int32_t>(o));
        if (std::binary_search(meeting.begin(), meeting.end(), both)) {
          if (positive_[s] == positive_[o]) continue;
          const auto where = lies(s, o);
          if (!where) return error_of(where);
          if (where->inside && !where->outside) enclosing.push_back(static_cast<std::int32_t>(o));
          continue;
        }
        if (is_inside(s, o)) enclosing.push_back(static_cast<std::int32_t>(o));
      }
      shells_.depth[s] = count_apart(enclosing, meeting);
      shells_.in_overlap[s] = shells_.depth[s] < static_cast<std::int32_t>(enclosing.size());
    }
    SYMCELL_TRY(deepen_in_hollows(meeting));
    for (std::size_t s = 0; s < count; ++s) {
      if (positive_[s] == (shells_.depth[s] % 2 == 0)) continue;
      for (const std::int32_t t : members_[s]) turn(t);
      shells_.turned[s] = true;
      ++shells_.flipped_shells;
    }
    return {};
  }

  // A body that lies in a hollow, and in its wall by more than rounding, is a body in a hollow.
  Result<void> deepen_in_hollows(
      const std::vector<std::pair<std::int32_t, std::int32_t>>& meeting) {
    const std::vector<std::int32_t> depth = shells_.depth;
    const auto is_hollow = [&](std::size_t s) { return !positive_[s] && depth[s] % 2 == 1; };
    for (const auto& [a, b] : meeting) {
      for (const auto& [body, hollow] : {std::pair(a, b), std::pair(b, a)}) {
        if (!is_hollow(hollow) || !positive_[body] || shells_.depth[body] != depth[hollow])
          continue;
        const auto where = lies(body, hollow);
        if (!where) return error_of(where);
        if (where->inside) ++shells_.depth[body];
      }
    }
    return {};
  }

  // Bodies that meet are one where it is asked how deep something lies: in the overlap of two it is
  // no deeper than in one.
  [[nodiscard]] std::int32_t count_apart(
      const std::vector<std::int32_t>& shells,
      const std::vector<std::pair<std::int32_t, std::int32_t>>& meeting) const {
    UnionFind bodies(shells.size());
    auto apart = static_cast<std::int32_t>(shells.size());
    for (std::size_t i = 0; i < shells.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const std::pair<std::int32_t, std::int32_t> both = std::minmax(shells[i], shells[j]);
        const bool meet = positive_[shells[i]] == positive_[shells[j]] &&
                          std::binary_search(meeting.begin(), meeting.end(), both);
        if (!meet || bodies.root(static_cast<std::int32_t>(i)) ==
                         bodies.root(static_cast<std::int32_t>(j))) {
          continue;
        }
        bodies.join(static_cast<std::int32_t>(i), static_cast<std::int32_t>(j));
        --apart;
      }
    }
    return apart;
  }

  [[nodiscard]] Point3 point(std::int32_t t, std::size_t i) const {
    return surface_.points[surface_.triangles[t][i]];
  }

  IndexedSurface& surface_;
  ExecutionContext& context_;
  std::span<const std::pair<std::int32_t, std::int32_t>> crossing_;
  Shells shells_;
  std::vector<std::vector<std::int32_t>> members_;  // triangles of each shell
  std::vector<bool> positive_;
};

}  // namespace

Result<Shells> orient_shells(IndexedSurface& surface,
                             ExecutionContext& context,
                             std::span<const std::pair<std::int32_t, std::int32_t>> crossing) {
  return Orienter(surface, context, crossing).run();
}

}  // namespace symcell::solid
