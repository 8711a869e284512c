#include "core/solid/surface/resolve_crossings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/base/union_find.hpp"
#include "core/geometry/self_intersections.hpp"
#include "core/geometry/surface_distance.hpp"
#include "core/geometry/triangle_tree.hpp"
#include "core/model/describe.hpp"
#include "core/solid/surface/refusals.hpp"
#include "core/solid/surface/solid_boundary.hpp"
#include "core/solid/surface/weld.hpp"

namespace symcell::solid {
namespace {

using Pairs = std::vector<std::pair<std::int32_t, std::int32_t>>;

// Rounding may make triangles cross by the last digits: they are cut again, so often at most.
constexpr int kMostRounds = 6;
constexpr std::size_t kMostPairs = 100'000;  // of a round
// Sheets that touched are moved apart by this share of the tolerance.
constexpr double kGapShare = 0.01;
// Thin triangles go where vertices nearer than this share of the tolerance can be joined.
constexpr std::array<double, 3> kTidyShares = {0.03, 0.003, 0.0001};
// How wide what bodies overlap by may be, in depths: that of edges whose sides rise by 15 degrees is.
constexpr double kContactWidth = 8;
// Rounding and gaps change the volume by far less.
constexpr double kSameVolumeRel = 1e-4;

class Resolver {
 public:
  Resolver(const IndexedSurface& surface,
           double tolerance,
           double contact,
           ExecutionContext& context,
           std::string& reason)
      : input_(surface),
        tolerance_(tolerance),
        contact_(contact),
        context_(context),
        reason_(reason) {}

  Result<std::optional<Resolved>> run(Pairs pairs) {
    result_.surface = input_;
    for (int round = 0; round < kMostRounds; ++round) {
      auto cut = solid_boundary(result_.surface, pairs, context_);
      if (!cut) return refused(cut.error());
      if (cut->surface.triangles.empty()) return refused("nothing is inside");
      if (round == 0) first_ = *cut;
      result_.surface = std::move(cut->surface);
      if (const auto odd = odd_edges(result_.surface); !odd.empty()) {
        return refused("pieces do not fit together near " +
                       describe_point(result_.surface.points[odd.front().a]));
      }
      if (round == 0) close_contacts();
      const auto split = split_touching();
      if (!split) return refused(split.error());
      auto left = self_intersections(result_.surface, kMostPairs, context_);
      if (!left) return error_of(left);
      if (left->empty()) {
        SYMCELL_TRY(tidy());
        fill_thin_voids();
        return checked();
      }
      pairs = std::move(*left);
    }
    return refused(plural(pairs.size(), "pair") + " still cross after " +
                   std::to_string(kMostRounds) + " rounds of cutting");
  }

 private:
  Result<std::optional<Resolved>> refused(const Error& error) {
    if (is_limit(error.code)) return fail(error);
    return refused(error.message);
  }
  std::optional<Resolved> refused(std::string reason) {
    reason_ = std::move(reason);
    return std::nullopt;
  }

  // Bodies that touch in an edge or a corner now hang together by what they were put into each other:
  // an edge or a corner again, at which they are taken apart.
  void close_contacts() {
    if (contact_ == 0) return;
    IndexedSurface welded = weld_within(result_.surface, kContactWidth * contact_);
    if (welded.triangles.empty() || !odd_edges(welded).empty() || !same_volume(welded)) return;
    result_.surface = std::move(welded);
  }

  // An edge whose ends are each in one sheet only is split in its middle as well.
  Result<void> split_touching() {
    constexpr int kTimes = 3;
    for (int i = 0; i < kTimes; ++i) {
      if (i > 0) put_in_middles(branching_edges(result_.surface));
      const auto split = split_sheets(result_.surface, kGapShare * tolerance_);
      if (!split) return error_of(split);
      if (split->none()) return {};
      if (i == 0) {
        result_.split.edges += split->edges;
        result_.split.corners += split->corners;
      }
      result_.gap = kGapShare * tolerance_;
    }
    const Touching left = touching_places(result_.surface);
    if (left.none()) return {};
    return fail(ErrorCode::kNotWatertight, "sheets that touch could not be told apart");
  }

  void put_in_middles(const std::vector<OddEdge>& edges) {
    IndexedSurface& s = result_.surface;
    for (const OddEdge& e : edges) {
      const auto middle = static_cast<std::int32_t>(s.points.size());
      s.points.push_back(0.5 * (s.points[e.a] + s.points[e.b]));
      const std::size_t count = s.triangles.size();
      for (std::size_t t = 0; t < count; ++t) {
        for (std::size_t i = 0; i < 3; ++i) {
          const Triangle old = s.triangles[t];
          const std::int32_t a = old[i], b = old[(i + 1) % 3], c = old[(i + 2) % 3];
          if (!((a == e.a && b == e.b) || (a == e.b && b == e.a))) continue;
          s.triangles[t] = {a, middle, c};
          s.triangles.push_back({middle, b, c});
          s.source.push_back(s.source[t]);
          break;
        }
      }
    }
  }

  // Cutting leaves slivers.
  Result<void> tidy() {
    for (const double share : kTidyShares) {
      IndexedSurface welded = weld_within(result_.surface, share * tolerance_);
      if (welded.points.size() == result_.surface.points.size()) continue;
      if (!odd_edges(welded).empty()) continue;
      if (!touching_places(welded).none()) continue;
      auto crossing = self_intersections(welded, 1, context_);
      if (!crossing) return error_of(crossing);
      if (!crossing->empty()) continue;
      if (!same_volume(welded)) continue;
      result_.surface = std::move(welded);
      return {};
    }
    return {};
  }

  // Closed parts that look inwards; what the input had of them had another part within the
  // tolerance, or had the same void.
  void fill_thin_voids() {
    IndexedSurface& s = result_.surface;
    UnionFind parts(s.triangles.size());
    const std::vector<EdgeUse> uses = sorted_edge_uses(s.triangles);
    for_each_edge(uses, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin + 1; i < end; ++i) {
        parts.join(uses[begin].triangle, uses[i].triangle);
      }
    });
    struct Figures {
      double volume = 0, area = 0;
    };
    std::vector<Figures> figures(s.triangles.size());
    const Point3 origin = s.points.front();
    const auto count = static_cast<std::int32_t>(s.triangles.size());
    for (std::int32_t t = 0; t < count; ++t) {
      const Triangle& v = s.triangles[t];
      const Point3 a = s.points[v[0]], n = area_normal(s, v);
      figures[parts.root(t)].volume += dot(a - origin, n) / 6;
      figures[parts.root(t)].area += length(n) / 2;
    }
    const auto thin = [&](std::int32_t part) {
      const Figures& f = figures[part];
      return f.volume < 0 && -2 * f.volume <= tolerance_ * f.area;
    };
    IndexedSurface kept;
    kept.points = s.points;
    for (std::int32_t t = 0; t < count; ++t) {
      const std::int32_t part = parts.root(t);
      if (!thin(part)) {
        kept.triangles.push_back(s.triangles[t]);
        kept.source.push_back(s.source[t]);
      } else if (part == t) {
        ++result_.voids;
        result_.void_volume -= figures[part].volume;
      }
    }
    if (result_.voids == 0 || kept.triangles.empty()) return;
    drop_unused_points(kept);
    s = std::move(kept);
  }

  [[nodiscard]] bool same_volume(const IndexedSurface& surface) const {
    const double volume = enclosed_volume(surface, surface.points.front());
    return std::abs(volume - result_.void_volume - first_.volume) <=
           std::max(kSameVolumeRel * first_.volume, result_.gap * surface_area(surface));
  }

  std::optional<Resolved> moved(Point3 p) {
    return refused("the surface would move by more than " + describe_rounded(tolerance_) +
                   " near " + describe_point(p));
  }

  Result<std::optional<Resolved>> checked() {
    const IndexedSurface& solid = result_.surface;
    if (!same_volume(solid)) {
      return refused("the volume would become " +
                     describe_rounded(enclosed_volume(solid, solid.points.front())) +
                     " instead of " + describe_rounded(first_.volume));
    }
    SYMCELL_TRY(context_.check());
    const TriangleTree tree(solid.points, solid.triangles);
    const TriangleTree before(first_.surface.points, first_.surface.triangles);
    const auto covered = [&](const TriangleTree& by, const Point3& p) {
      return by.within(p, tolerance_);
    };
    for (const Point3& p : samples_of(solid)) {
      if (!covered(before, p)) return moved(p);
    }
    // Sides of voids that were filled are gone.
    for (const Point3& p : result_.voids > 0 ? std::vector<Point3>{} : samples_of(first_.surface)) {
      if (!covered(tree, p)) return moved(p);
    }
    for (const Point3& p : samples_of(first_.inverted)) {
      if (tree.within(p, tolerance_)) continue;
      return refused("a part of volume " + describe_rounded(std::abs(first_.inverted_volume)) +
                     " near " + describe_point(p) + " is inside out");
    }
    result_.overlap_volume = first_.overlap_volume;
    result_.cancelled_area = first_.cancelled_area;
    result_.inverted_volume = std::abs(first_.inverted_volume);
    return std::optional(std::move(result_));
  }

  const IndexedSurface& input_;
  double tolerance_;
  double contact_;
  ExecutionContext& context_;
  std::string& reason_;
  SolidBoundary first_;
  Resolved result_;
};

}  // namespace

Result<std::optional<Resolved>> resolve_crossings(
    const IndexedSurface& surface,
    std::span<const std::pair<std::int32_t, std::int32_t>> pairs,
    double tolerance,
    double contact,
    ExecutionContext& context,
    std::string& reason) {
  return Resolver(surface, tolerance, contact, context, reason).run({pairs.begin(), pairs.end()});
}

}  // namespace symcell::solid
