#include "core/solid/surface/shells.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>

#include "core/model/describe.hpp"

namespace symcell::solid {
namespace {

// A shell thinner than this share of its box is no body: its volume's sign would be noise.
constexpr double kFlatVolumeRel = 1e-12;
constexpr std::size_t kCheckEvery = 512;  // shells, each against all others

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

// Solid angle of the shell seen from p over 4 pi: 1 inside a closed surface, 0 outside.
// Source: [van Oosterom-Strackee83].
double winding_number(const IndexedSurface& surface,
                      const std::vector<std::int32_t>& triangles,
                      Point3 p) {
  double sum = 0;
  for (const std::int32_t t : triangles) {
    const Triangle& v = surface.triangles[t];
    const Point3 a = surface.points[v[0]] - p;
    const Point3 b = surface.points[v[1]] - p;
    const Point3 c = surface.points[v[2]] - p;
    const double la = length(a), lb = length(b), lc = length(c);
    const double denominator = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
    sum += 2 * std::atan2(dot(a, cross(b, c)), denominator);
  }
  return sum / (4 * std::numbers::pi);
}

bool encloses(const Box3& outer, const Box3& inner) {
  return outer.low.x <= inner.low.x && outer.low.y <= inner.low.y && outer.low.z <= inner.low.z &&
         outer.high.x >= inner.high.x && outer.high.y >= inner.high.y &&
         outer.high.z >= inner.high.z;
}

class Orienter {
 public:
  Orienter(IndexedSurface& surface, ExecutionContext& context)
      : surface_(surface), context_(context) {}

  Result<Shells> run() {
    SYMCELL_TRY(agree());
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
    for (std::size_t s = 0; s < count; ++s) {
      if (s % kCheckEvery == 0) {
        SYMCELL_TRY(context_.check());
      }
      for (std::size_t o = 0; o < count; ++o) {
        if (o == s || !encloses(boxes[o], boxes[s])) continue;
        const double w = winding_number(surface_, members_[o], point(members_[s].front(), 0));
        if (std::abs(w) > 0.5) ++shells_.depth[s];
      }
    }
    for (std::size_t s = 0; s < count; ++s) {
      if (positive_[s] == (shells_.depth[s] % 2 == 0)) continue;
      for (const std::int32_t t : members_[s]) turn(t);
      ++shells_.flipped_shells;
    }
    return {};
  }

  [[nodiscard]] Point3 point(std::int32_t t, std::size_t i) const {
    return surface_.points[surface_.triangles[t][i]];
  }

  IndexedSurface& surface_;
  ExecutionContext& context_;
  Shells shells_;
  std::vector<std::vector<std::int32_t>> members_;  // triangles of each shell
  std::vector<bool> positive_;
};

}  // namespace

Result<Shells> orient_shells(IndexedSurface& surface, ExecutionContext& context) {
  return Orienter(surface, context).run();
}

}  // namespace symcell::solid
