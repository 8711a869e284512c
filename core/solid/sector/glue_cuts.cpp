#include "core/solid/sector/glue_cuts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "core/geometry/segment_index.hpp"
#include "core/solid/sector/cut_curves.hpp"
#include "core/solid/sector/match_curves.hpp"

namespace symcell::solid {
namespace {

constexpr std::size_t kSharpCorners = 8;  // tried as the place where closed curves begin
// New vertices on an edge keep this share of it, and of the merging distance, as a distance from
// each other and its ends.
constexpr double kSpacing = 0.02;

// Twice the area enclosed by a closed polyline (first point repeated at the end).
double twice_area(const std::vector<Point2>& points) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) sum += cross(points[i], points[i + 1]);
  return sum;
}

double turning(Point2 before, Point2 at, Point2 after) {
  return std::abs(std::atan2(cross(at - before, after - at), dot(at - before, after - at)));
}

class Gluer {
 public:
  Gluer(WedgePatch patch, double reach, double merge, ExecutionContext& context)
      : patch_(std::move(patch)), reach_(reach), merge_(merge), context_(context) {}

  Result<GluedSurface> run() {
    auto curves = find_cut_curves(patch_);
    if (!curves) return error_of(curves);
    curves_ = std::move(*curves);
    SYMCELL_TRY(pair_curves());
    index_boundary();
    partner_.assign(patch_.points.size(), -1);
    for (std::size_t i = 0; i < curves_.lower.size(); ++i) {
      SYMCELL_TRY(context_.check());
      if (!match(curves_.lower[i], curves_.higher[pair_of_[i]])) {
        return fail(ErrorCode::kInternal, "the curves of the two cuts differ");
      }
    }
    return build();
  }

 private:
  Result<void> pair_curves() {
    const std::size_t count = curves_.lower.size();
    if (count != curves_.higher.size()) {
      return fail(ErrorCode::kInternal, "the two cuts have different numbers of curves");
    }
    std::vector<std::vector<Point2>> higher;
    for (const CutCurve& c : curves_.higher) higher.push_back(curve_points(patch_, c));
    std::vector<bool> taken(count, false);
    for (const CutCurve& curve : curves_.lower) {
      const std::vector<Point2> points = curve_points(patch_, curve);
      double best = reach_;
      std::size_t best_at = count;
      for (std::size_t k = 0; k < count; ++k) {
        const CutCurve& other = curves_.higher[k];
        if (taken[k] || other.closed != curve.closed) continue;
        if (curve.closed) {
          if (!near_boxes(points, higher[k]) || twice_area(points) * twice_area(higher[k]) < 0) {
            continue;
          }
        } else if (curve.vertices.front() != other.vertices.front() ||
                   curve.vertices.back() != other.vertices.back()) {
          continue;
        }
        const double apart = curve_distance(points, higher[k]);
        if (apart <= best) {
          best = apart;
          best_at = k;
        }
      }
      if (best_at == count) {
        return fail(ErrorCode::kInternal,
                    "a curve of the lower cut has no image on the higher one");
      }
      taken[best_at] = true;
      pair_of_.push_back(best_at);
    }
    return {};
  }

  [[nodiscard]] bool near_boxes(const std::vector<Point2>& a, const std::vector<Point2>& b) const {
    const auto box = [](const std::vector<Point2>& points) {
      std::array<double, 4> r{points[0].x, points[0].x, points[0].y, points[0].y};
      for (const Point2& p : points) {
        r = {std::min(r[0], p.x), std::max(r[1], p.x), std::min(r[2], p.y), std::max(r[3], p.y)};
      }
      return r;
    };
    const auto x = box(a), y = box(b);
    for (std::size_t i = 0; i < 4; ++i) {
      if (std::abs(x[i] - y[i]) > reach_) return false;
    }
    return true;
  }

  void index_boundary() {
    const std::vector<EdgeUse> uses = symcell::sorted_edge_uses(patch_.triangles);
    for_each_edge(uses, [&](std::size_t begin, std::size_t end) {
      if (end - begin == 1) {
        boundary_[{uses[begin].low, uses[begin].high}] = uses[begin].triangle;
      }
    });
  }

  [[nodiscard]] std::int32_t add_vertex(Point3 p, bool lower) {
    patch_.points.push_back(p);
    patch_.on_lower.push_back(lower ? 1 : 0);
    patch_.on_higher.push_back(lower ? 0 : 1);
    partner_.push_back(-1);
    return static_cast<std::int32_t>(patch_.points.size()) - 1;
  }

  // Puts vertices into boundary edge pq, in this order from p on.
  void split_edge(std::int32_t p, std::int32_t q, const std::vector<std::int32_t>& inner) {
    const auto found = boundary_.find({std::min(p, q), std::max(p, q)});
    const std::int32_t t = found->second;
    boundary_.erase(found);
    const Triangle old = patch_.triangles[t];
    std::size_t i = 0;
    while (!((old[i] == p && old[(i + 1) % 3] == q) || (old[i] == q && old[(i + 1) % 3] == p))) ++i;
    std::vector<std::int32_t> chain{p};
    chain.insert(chain.end(), inner.begin(), inner.end());
    chain.push_back(q);
    if (old[i] != p) std::reverse(chain.begin(), chain.end());
    const std::int32_t apex = old[(i + 2) % 3];
    const Point3 normal = patch_.normals[t];
    for (std::size_t k = 0; k + 1 < chain.size(); ++k) {
      std::int32_t id = t;
      if (k == 0) {
        patch_.triangles[t] = {chain[0], chain[1], apex};
      } else {
        id = static_cast<std::int32_t>(patch_.triangles.size());
        patch_.triangles.push_back({chain[k], chain[k + 1], apex});
        patch_.normals.push_back(normal);
      }
      boundary_[{std::min(chain[k], chain[k + 1]), std::max(chain[k], chain[k + 1])}] = id;
    }
    // The side from the chain's end to the apex may be on a boundary too.
    const std::int32_t last = chain.back();
    const auto side = boundary_.find({std::min(last, apex), std::max(last, apex)});
    if (side != boundary_.end() && side->second == t) {
      side->second = static_cast<std::int32_t>(patch_.triangles.size()) - 1;
    }
  }

  // Turns both closed curves so that their first vertices match; may add one to the higher curve.
  void align(CutCurve& lower, CutCurve& higher) {
    const std::vector<Point2> a = curve_points(patch_, lower), b = curve_points(patch_, higher);
    const std::size_t na = lower.vertices.size(), nb = higher.vertices.size();
    std::vector<std::pair<double, std::size_t>> corners;
    for (std::size_t i = 0; i < na; ++i) {
      corners.emplace_back(-turning(a[(i + na - 1) % na], a[i], a[i + 1]), i);
    }
    std::sort(corners.begin(), corners.end());
    double best = merge_ * merge_;
    std::size_t start_a = corners.front().second, start_b = nb;
    for (std::size_t k = 0; k < corners.size() && (k < kSharpCorners || start_b == nb); ++k) {
      const std::size_t i = corners[k].second;
      for (std::size_t j = 0; j < nb; ++j) {
        const double squared = squared_distance(a[i], b[j]);
        if (squared > best) continue;
        best = squared;
        start_a = i;
        start_b = j;
      }
    }
    if (start_b == nb) {
      std::size_t edge = 0;
      best = std::numeric_limits<double>::infinity();
      for (std::size_t j = 0; j < nb; ++j) {
        const double squared = squared_distance_to_segment(a[start_a], b[j], b[j + 1]);
        if (squared < best) {
          best = squared;
          edge = j;
        }
      }
      const std::int32_t p = higher.vertices[edge], q = higher.vertices[(edge + 1) % nb];
      const Point2 d = b[edge + 1] - b[edge];
      const double t =
          std::clamp(dot(a[start_a] - b[edge], d) / squared_length(d), kSpacing, 1 - kSpacing);
      const std::int32_t v =
          add_vertex(patch_.points[p] + t * (patch_.points[q] - patch_.points[p]), false);
      split_edge(p, q, {v});
      higher.vertices.insert(higher.vertices.begin() + static_cast<std::ptrdiff_t>(edge) + 1, v);
      start_b = edge + 1;
    }
    std::rotate(lower.vertices.begin(),
                lower.vertices.begin() + static_cast<std::ptrdiff_t>(start_a),
                lower.vertices.end());
    std::rotate(higher.vertices.begin(),
                higher.vertices.begin() + static_cast<std::ptrdiff_t>(start_b),
                higher.vertices.end());
  }

  [[nodiscard]] bool match(CutCurve& lower, CutCurve& higher) {
    if (lower.closed) align(lower, higher);
    const std::vector<Point2> a = curve_points(patch_, lower), b = curve_points(patch_, higher);
    const std::vector<CurveMatch> matches = match_curves(a, b, merge_);
    if (matches.empty()) return false;
    const auto vertex = [](const CutCurve& c, std::int32_t i) {
      return c.vertices[static_cast<std::size_t>(i) % c.vertices.size()];
    };
    std::vector<std::int32_t> on_a, on_b;  // patch vertices of the common curve
    for (const CurveMatch& m : matches) {
      on_a.push_back(m.a < 0 ? -1 : vertex(lower, m.a));
      on_b.push_back(m.b < 0 ? -1 : vertex(higher, m.b));
    }
    fill(on_a, on_b, true);
    fill(on_b, on_a, false);
    for (std::size_t i = 0; i < on_a.size(); ++i) {
      if (on_a[i] == on_b[i]) continue;  // on the axis
      partner_[on_b[i]] = on_a[i];
      const Point3 p = patch_.points[on_a[i]], q = patch_.points[on_b[i]];
      const double move = std::hypot(std::hypot(p.x, p.y) - std::hypot(q.x, q.y), p.z - q.z);
      largest_move_ = std::max(largest_move_, move);
    }
    return largest_move_ <= reach_;
  }

  // Makes vertices for the -1 entries of `own`, on its edges next to those of `other`.
  void fill(std::vector<std::int32_t>& own, const std::vector<std::int32_t>& other, bool lower) {
    for (std::size_t i = 0; i < own.size();) {
      std::size_t end = i + 1;
      if (end == own.size()) break;
      while (own[end] < 0) ++end;
      const std::int32_t p = own[i], q = own[end];
      const std::size_t count = end - i - 1;
      if (count > 0) {
        const Point3 from = patch_.points[p], to = patch_.points[q];
        const std::vector<double> places = place_on_edge(p, q, other, i, end);
        std::vector<std::int32_t> inner;
        for (std::size_t k = 0; k < count; ++k) {
          own[i + 1 + k] = add_vertex(from + places[k] * (to - from), lower);
          inner.push_back(own[i + 1 + k]);
        }
        split_edge(p, q, inner);
      }
      i = end;
    }
  }

  [[nodiscard]] std::vector<double> place_on_edge(std::int32_t p,
                                                  std::int32_t q,
                                                  const std::vector<std::int32_t>& other,
                                                  std::size_t begin,
                                                  std::size_t end) const {
    const auto flat = [this](std::int32_t v) {
      const Point3& x = patch_.points[v];
      return Point2{std::hypot(x.x, x.y), x.z};
    };
    const Point2 from = flat(p), d = flat(q) - from;
    const std::size_t count = end - begin - 1;
    // A little apart from each other and the ends, in their order.
    const double apart = std::min(kSpacing / static_cast<double>(count + 1),
                                  kSpacing * merge_ / std::sqrt(squared_length(d)));
    std::vector<double> places;
    double before = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const double t = dot(flat(other[begin + 1 + k]) - from, d) / squared_length(d);
      before = std::max(t, before + apart);
      places.push_back(before);
    }
    double after = 1;
    for (std::size_t k = count; k-- > 0;) {
      after = std::min(places[k], after - apart);
      places[k] = after;
    }
    return places;
  }

  Result<GluedSurface> build() const {
    GluedSurface glued;
    glued.largest_move = largest_move_;
    QuotientSurface& s = glued.surface;
    s.fold = patch_.fold;
    s.start_angle = patch_.start_angle;
    std::vector<std::int32_t> orbit(patch_.points.size(), -1);
    for (std::size_t v = 0; v < patch_.points.size(); ++v) {
      if (partner_[v] >= 0) continue;
      const auto id = static_cast<std::int32_t>(v);
      if (patch_.on_higher[v] != 0 && !patch_.on_axis(id)) {
        return fail(ErrorCode::kInternal, "a vertex of the higher cut has no partner");
      }
      orbit[v] = static_cast<std::int32_t>(s.points.size());
      s.points.push_back(patch_.points[v]);
      s.on_axis.push_back(patch_.on_axis(id) ? 1 : 0);
      s.on_cut.push_back(patch_.on_lower[v]);
    }
    for (const Triangle& t : patch_.triangles) {
      QuotientTriangle corners;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::int32_t partner = partner_[t[i]];
        corners[i] = partner >= 0 ? OrbitVertex{orbit[partner], 1} : OrbitVertex{orbit[t[i]], 0};
      }
      s.triangles.push_back(corners);
    }
    s.normals = patch_.normals;
    return glued;
  }

  WedgePatch patch_;
  double reach_;
  double merge_;
  ExecutionContext& context_;
  CutCurves curves_;
  std::vector<std::size_t> pair_of_;   // higher curve of each lower one
  std::vector<std::int32_t> partner_;  // of vertices of the higher cut: theirs on the lower one
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> boundary_;  // edge -> triangle
  double largest_move_ = 0;
};

}  // namespace

Result<GluedSurface> glue_cuts(WedgePatch patch,
                               double reach,
                               double merge,
                               ExecutionContext& context) {
  return Gluer(std::move(patch), reach, merge, context).run();
}

}  // namespace symcell::solid
