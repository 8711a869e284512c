#include "core/solid/surface/close_holes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/base/union_find.hpp"
#include "core/geometry/facet_triangulation.hpp"

namespace symcell::solid {
namespace {

constexpr std::size_t kLongestBentLoop = 400;  // edges: cubes of it are taken
// Of the loop's vertices: where the walk along a boundary comes back to itself.
constexpr std::size_t kShortestLoop = 3;

using Loop = std::vector<std::int32_t>;

class Closer {
 public:
  Closer(IndexedSurface& surface, const HoleLimits& limits, ExecutionContext& context)
      : surface_(surface), limits_(limits), context_(context), pieces_(surface.triangles.size()) {}

  Result<ClosedHoles> run() {
    find_boundary();
    std::map<std::int32_t, std::vector<std::int32_t>> members;
    if (!next_.empty()) {
      const auto count = static_cast<std::int32_t>(surface_.triangles.size());
      for (std::int32_t t = 0; t < count; ++t) members[pieces_.root(t)].push_back(t);
    }
    for (const Loop& loop : loops()) {
      SYMCELL_TRY(context_.check());
      SYMCELL_TRY(close(loop, members));
    }
    surface_.triangles.insert(surface_.triangles.end(), added_.begin(), added_.end());
    surface_.source.insert(surface_.source.end(), sources_.begin(), sources_.end());
    result_.triangles = added_.size();
    return std::move(result_);
  }

 private:
  struct Side {
    std::int32_t to;
    std::int32_t triangle;
    bool runs;  // the triangle runs from here to there
    bool used = false;
  };

  void find_boundary() {
    const std::vector<EdgeUse> uses = sorted_edge_uses(surface_.triangles);
    for_each_edge(uses, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin + 1; i < end; ++i) {
        pieces_.join(uses[begin].triangle, uses[i].triangle);
      }
      if (end - begin != 1) return;
      const EdgeUse& use = uses[begin];
      next_[use.low].push_back({use.high, use.triangle, use.forward});
      next_[use.high].push_back({use.low, use.triangle, !use.forward});
    });
  }

  // Walks along the boundary; whenever the walk comes back to a vertex it cuts a loop off.
  [[nodiscard]] std::vector<Loop> loops() {
    std::vector<Loop> found;
    for (auto& [start, sides] : next_) {
      Loop walk{start};
      while (true) {
        Side* step = unused(walk.back());
        if (step == nullptr) {
          walk.pop_back();
          if (walk.empty()) break;
          continue;
        }
        use(walk.back(), *step);
        const auto before = std::find(walk.begin(), walk.end(), step->to);
        if (before == walk.end()) {
          walk.push_back(step->to);
          continue;
        }
        Loop loop(before, walk.end());
        walk.erase(before + 1, walk.end());
        if (loop.size() >= kShortestLoop) found.push_back(std::move(loop));
      }
    }
    return found;
  }

  Side* unused(std::int32_t v) {
    for (Side& side : next_[v]) {
      if (!side.used) return &side;
    }
    return nullptr;
  }

  void use(std::int32_t from, Side& side) {
    side.used = true;
    for (Side& back : next_[side.to]) {
      if (back.to == from && back.triangle == side.triangle) back.used = true;
    }
  }

  [[nodiscard]] const Point3& point(std::int32_t v) const { return surface_.points[v]; }

  Result<void> close(Loop loop, const std::map<std::int32_t, std::vector<std::int32_t>>& members) {
    // Against the triangles along it.
    std::ptrdiff_t against = 0;
    std::int32_t beside = -1;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      for (const Side& side : next_[loop[i]]) {
        if (side.to != loop[(i + 1) % loop.size()]) continue;
        against += side.runs ? 1 : -1;
        beside = side.triangle;
      }
    }
    if (against > 0) std::reverse(loop.begin(), loop.end());
    std::vector<Point3> corners;
    for (const std::int32_t v : loop) corners.push_back(point(v));
    const Box3 box = bounding_box(corners);
    const Point3 middle = 0.5 * (box.low + box.high);
    Point3 normal{};
    for (std::size_t i = 0; i < loop.size(); ++i) {
      normal = normal + cross(corners[i] - middle, corners[(i + 1) % loop.size()] - middle);
    }
    const auto height = [&](const Point3& p) {
      return std::abs(dot(p - middle, normal)) / length(normal);
    };
    const bool planar = length(normal) > 0 &&
                        std::all_of(corners.begin(), corners.end(),
                                    [&](const Point3& p) { return height(p) <= limits_.flat; });
    if (beside >= 0 && length(normal) > 0 && is_sheet(members.at(pieces_.root(beside)), height)) {
      result_.sheets.push_back(corners.front());
      return {};
    }
    const double extent = box.diagonal();
    const bool small = extent <= limits_.extent;
    const bool simple =
        planar && loop.size() <= limits_.planar_edges && extent <= limits_.planar_extent;
    if (!small && !simple) return {};
    const std::size_t before = added_.size();
    if (planar && loop.size() > kShortestLoop) fill_plane(loop, normal);
    if (added_.size() == before) {
      SYMCELL_TRY(fill_least_area(loop));
    }
    if (added_.size() == before) return {};
    sources_.resize(added_.size(), beside < 0 ? -1 : surface_.source[beside]);
    ++result_.count;
    result_.largest = std::max(result_.largest, extent);
    result_.places.push_back(middle);
    return {};
  }

  template <class Height>
  [[nodiscard]] bool is_sheet(const std::vector<std::int32_t>& triangles,
                              const Height& height) const {
    return std::all_of(triangles.begin(), triangles.end(), [&](std::int32_t t) {
      const Triangle& v = surface_.triangles[t];
      return std::all_of(v.begin(), v.end(), [&](std::int32_t corner) {
        return height(point(corner)) <= limits_.sheet;
      });
    });
  }

  void fill_plane(const Loop& loop, Point3 normal) {
    FacetGraph graph;
    graph.normal = normal;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      graph.segments.push_back({loop[i], loop[(i + 1) % loop.size()]});
    }
    const auto filled = triangulate_facet(surface_.points, graph);
    if (!filled || filled->triangles.size() != loop.size() - 2) return;
    added_.insert(added_.end(), filled->triangles.begin(), filled->triangles.end());
  }

  // Source: [Barequet-Sharir95], by area only.
  Result<void> fill_least_area(const Loop& loop) {
    const std::size_t n = loop.size();
    if (n > kLongestBentLoop) return {};
    std::vector<double> least(n * n, 0);
    std::vector<std::size_t> apex(n * n, 0);
    for (std::size_t span = 2; span < n; ++span) {
      SYMCELL_TRY(context_.check());
      for (std::size_t i = 0; i + span < n; ++i) {
        const std::size_t k = i + span;
        double best = std::numeric_limits<double>::infinity();
        for (std::size_t j = i + 1; j < k; ++j) {
          const double area = length(area_normal(point(loop[i]), point(loop[j]), point(loop[k]))) +
                              least[i * n + j] + least[j * n + k];
          if (area >= best) continue;
          best = area;
          apex[i * n + k] = j;
        }
        least[i * n + k] = best;
      }
    }
    std::vector<std::pair<std::size_t, std::size_t>> open{{0, n - 1}};
    while (!open.empty()) {
      const auto [i, k] = open.back();
      open.pop_back();
      if (k - i < 2) continue;
      const std::size_t j = apex[i * n + k];
      added_.push_back({loop[i], loop[j], loop[k]});
      open.emplace_back(i, j);
      open.emplace_back(j, k);
    }
    return {};
  }

  IndexedSurface& surface_;
  const HoleLimits& limits_;
  ExecutionContext& context_;
  UnionFind pieces_;  // triangles, over common edges
  std::map<std::int32_t, std::vector<Side>> next_;
  std::vector<Triangle> added_;
  std::vector<std::int32_t> sources_;  // of those
  ClosedHoles result_;
};

}  // namespace

Result<ClosedHoles> close_holes(IndexedSurface& surface,
                                const HoleLimits& limits,
                                ExecutionContext& context) {
  return Closer(surface, limits, context).run();
}

}  // namespace symcell::solid
