#include "core/plane/refine/criteria.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/geometry/tolerances.hpp"
#include "core/plane/quotient/star.hpp"

namespace symcell::plane {
namespace {

// Two points on shells of one acute vertex count as equally far from it within this ratio; shells
// themselves are a factor of two apart.
constexpr double kShellRatio = 1e-3;

// The square of a length just inside a bound must not round to one outside.
constexpr double kLengthSafety = 1e-12;

double angle_between(Point2 from, Point2 to) {
  const double a = std::atan2(cross(from, to), dot(from, to));
  return a < 0 ? a + 2 * std::numbers::pi : a;
}

}  // namespace

Criteria::Criteria(const QuotientTriangulation& mesh,
                   const std::vector<SubdomainOrbit>& subdomains,
                   const MeshOptions& options,
                   const LocalSizes& sizes)
    : keep_boundary_(options.keep_boundary),
      has_local_sizes_(!sizes.of_segment.empty() || !sizes.at_vertex.empty() || sizes.graded),
      sizes_(sizes) {
  const double bound = options.min_angle_deg > 0 ? options.min_angle_deg + kAngleMarginDeg : 0;
  goal_angle_ = bound * kRadiansADegree;
  cos2_goal_ = bound > 0 ? std::cos(goal_angle_) * std::cos(goal_angle_) : 2.0;
  cos_lens_ = std::cos(2 * std::max(goal_angle_, kLeastLensDeg * kRadiansADegree));
  shell_angle_ = std::max(kShellAngleDeg * kRadiansADegree, kShellFactor * goal_angle_);
  max_edge2_ = options.max_edge * options.max_edge * (1 - kLengthSafety);
  min_edge2_ = options.min_edge * options.min_edge * (1 + kLengthSafety);
  has_size_bound_ = options.max_edge < kInfinity || has_local_sizes_;
  for (const SubdomainOrbit& s : subdomains) {
    max_area_.push_back(std::min(options.max_area, s.max_area));
    has_size_bound_ = has_size_bound_ || max_area_.back() < kInfinity;
  }
  const double sector = 360.0 / static_cast<double>(mesh.fold());
  centre_is_narrow_ = mesh.centre() >= 0 && sector < options.min_angle_deg;
  centre_is_exact_ = mesh.centre() >= 0 && !centre_is_narrow_ && sector < bound;
  find_corners(mesh);
}

double Criteria::star_angle() const {
  return std::max(goal_angle_, kLeastStarDeg * kRadiansADegree);
}

void Criteria::find_corners(const QuotientTriangulation& mesh) {
  acute_.assign(mesh.vertex_slots(), 0);
  // Each corner of the input begins at a triangle whose clockwise side at the vertex is a segment,
  // whatever wedges the vertex has.
  for (TriangleId t = 0; t < mesh.triangle_slots(); ++t) {
    if (!mesh.alive(t)) continue;
    for (std::uint32_t i = 0; i < 3; ++i) {
      const SubsegmentId first = mesh.triangle(t).seg[prev3(i)];
      if (first == kNoSubsegment) continue;
      const VertexId v = mesh.triangle(t).v[i];
      StarItem item = star_item(mesh, 3 * t + i);
      const auto direction = [&](std::uint32_t which) {
        const OrbitVertex c = star_corner(mesh, item, which);
        return mesh.lift(c.orbit, c.exponent) - mesh.point(v);
      };
      const Point2 from = direction(1);
      while (mesh.triangle(item.t).seg[next3(item.i)] == kNoSubsegment) {
        if (!rotate_ccw(mesh, item)) break;
      }
      // Between a segment at the centre and its own next copy: the fold's angle, not the input's.
      const bool whole_sector =
          v == mesh.centre() && first == mesh.triangle(item.t).seg[next3(item.i)];
      if (!whole_sector) add_corner(mesh, v, from, direction(2));
    }
  }
  std::sort(narrow_.begin(), narrow_.end(),
            [](const NarrowCorner& a, const NarrowCorner& b) { return a.v < b.v; });
}

void Criteria::add_corner(const QuotientTriangulation& mesh, VertexId v, Point2 from, Point2 to) {
  double angle = angle_between(from, to);
  // Rounding may turn a full turn (a dangling segment's end) into a tiny angle.
  constexpr double kFullTurnSlack = 1e-9;
  if (angle < kFullTurnSlack) angle = 2 * std::numbers::pi;
  if (angle < shell_angle_) acute_[static_cast<std::size_t>(v)] |= 1;
  if (angle >= goal_angle_) return;
  acute_[static_cast<std::size_t>(v)] |= 2;
  const std::int32_t copies = v == mesh.centre() ? mesh.fold() : 1;
  for (std::int32_t k = 0; k < copies; ++k) {
    narrow_.push_back({v, mesh.rotations().rotate(from, k), mesh.rotations().rotate(to, k)});
  }
}

Assessment Criteria::assess(Point2 a, Point2 b, Point2 c, std::int32_t face) const {
  const Point2 ab = b - a, bc = c - b, ca = a - c;
  const double e[3] = {squared_length(bc), squared_length(ca), squared_length(ab)};
  std::uint32_t s = e[0] < e[1] ? 0 : 1;
  if (e[2] < e[s]) s = 2;
  const double p = e[next3(s)], q = e[prev3(s)];
  Assessment result{Verdict::kGood, false, e[s], s};
  if (has_size_bound_) {
    const double doubled_area = cross(ab, bc);
    if (doubled_area > 2 * max_area_[static_cast<std::size_t>(face)] || p > max_edge2_ ||
        q > max_edge2_) {
      result.verdict = Verdict::kSize;
      result.too_large = true;
    }
  }
  // cos^2 of the smallest angle, which faces the shortest edge: ((p + q - s) / 2 sqrt(pq))^2.
  const double numerator = p + q - e[s];
  if (numerator * numerator > 4 * cos2_goal_ * p * q) result.verdict = Verdict::kAngle;
  return result;
}

Assessment Criteria::assess(const QuotientTriangulation& mesh, const Triangle& t) const {
  Assessment result =
      assess(mesh.corner_point(t, 0), mesh.corner_point(t, 1), mesh.corner_point(t, 2), t.face);
  for (std::uint32_t j = 0; has_local_sizes_ && !result.too_large && j < 3; ++j) {
    result.too_large = edge_too_long(mesh, t, j);
  }
  if (result.too_large && result.verdict == Verdict::kGood) result.verdict = Verdict::kSize;
  return result;
}

bool Criteria::edge_too_long(const QuotientTriangulation& mesh,
                             const Triangle& t,
                             std::uint32_t j) const {
  double limit2 = max_edge2_;
  if (has_local_sizes_) {
    double limit = std::min(max_edge_at(mesh, t.v[next3(j)]), max_edge_at(mesh, t.v[prev3(j)]));
    if (t.seg[j] != kNoSubsegment && !sizes_.of_segment.empty()) {
      const auto parent = static_cast<std::size_t>(mesh.subsegment(t.seg[j]).parent);
      limit = std::min(limit, sizes_.of_segment[parent]);
    }
    limit2 = std::min(limit2, limit * limit * (1 - kLengthSafety));
  }
  return squared_distance(mesh.corner_point(t, next3(j)), mesh.corner_point(t, prev3(j))) > limit2;
}

double Criteria::graded_edge_at(const QuotientTriangulation& mesh, VertexId v) const {
  const auto at = static_cast<std::size_t>(v);
  const Point2 p = mesh.point(v);
  if (at >= graded_edges_.size()) graded_edges_.resize(mesh.vertex_slots());
  EdgeAt& known = graded_edges_[at];
  if (known.longest == 0 || !(known.p == p)) known = {p, sizes_.graded->max_edge(p)};
  return known.longest;
}

bool Criteria::has_short_edge(const QuotientTriangulation& mesh, const Triangle& t) const {
  if (!has_least_edge()) return false;
  const auto given = [&](std::uint32_t i) { return mesh.kind(t.v[i]) == VertexKind::kInput; };
  for (std::uint32_t i = 0; i < 3; ++i) {
    const std::uint32_t j = next3(i);
    if (given(i) && given(j)) continue;
    if (squared_distance(mesh.corner_point(t, i), mesh.corner_point(t, j)) < min_edge2_)
      return true;
  }
  return false;
}

bool Criteria::in_narrow_corner(const QuotientTriangulation& mesh,
                                const Triangle& t,
                                std::uint32_t i) const {
  const VertexId v = t.v[i];
  if (!is_narrow(v)) return false;
  const Point2 p = mesh.corner_point(t, i);
  const Point2 middle = 0.5 * (mesh.corner_point(t, next3(i)) + mesh.corner_point(t, prev3(i)));
  const std::int32_t back = v == mesh.centre() ? 0 : mesh.subtract(0, t.k[i]);
  const Point2 d = mesh.rotations().rotate(middle - p, back);
  const auto first = std::lower_bound(narrow_.begin(), narrow_.end(), v,
                                      [](const NarrowCorner& c, VertexId id) { return c.v < id; });
  for (auto it = first; it != narrow_.end() && it->v == v; ++it) {
    if (cross(it->from, d) > 0 && cross(d, it->to) > 0) return true;
  }
  return false;
}

// [Miller-Pav-Walkington03]: an edge between two segments that meet in a narrow corner, its ends
// equally far from it.
bool Criteria::is_seditious(const QuotientTriangulation& mesh,
                            const Triangle& t,
                            const Assessment& assessment) const {
  const std::uint32_t i = next3(assessment.shortest), j = prev3(assessment.shortest);
  if (mesh.kind(t.v[i]) != VertexKind::kSegment || mesh.kind(t.v[j]) != VertexKind::kSegment) {
    return false;
  }
  const auto shifted = [&](OrbitVertex c, std::int32_t e) {
    return OrbitVertex{c.orbit, mesh.shift(c.orbit, c.exponent, e)};
  };
  const SegmentEnds& s = ends_[static_cast<std::size_t>(t.v[i])];
  const SegmentEnds& r = ends_[static_cast<std::size_t>(t.v[j])];
  for (const OrbitVertex& a : {shifted(s.a, t.k[i]), shifted(s.b, t.k[i])}) {
    for (const OrbitVertex& b : {shifted(r.a, t.k[j]), shifted(r.b, t.k[j])}) {
      if (!(a == b) || !is_narrow(a.orbit)) continue;
      const Point2 apex = mesh.lift(a.orbit, a.exponent);
      const Point2 p = mesh.corner_point(t, i) - apex, q = mesh.corner_point(t, j) - apex;
      const double rp = length(p), rq = length(q);
      // The apex has a narrow corner, but it must be the one between these two segments.
      const bool narrow = dot(p, q) > std::cos(goal_angle_) * rp * rq;
      if (narrow && std::abs(rp - rq) <= kShellRatio * rp) return true;
    }
  }
  return false;
}

namespace {

bool is_self_adjacent(const Triangle& t, TriangleId id) {
  for (const HalfEdge g : t.nb) {
    if (g != kNoHalfEdge && triangle_of(g) == id) return true;
  }
  return false;
}

}  // namespace

Exemption Criteria::exemption(const QuotientTriangulation& mesh,
                              TriangleId id,
                              const Assessment& assessment) const {
  const Triangle& t = mesh.triangle(id);
  for (std::uint32_t i = 0; i < 3; ++i) {
    if (in_narrow_corner(mesh, t, i)) return Exemption::kSmallInputAngle;
  }
  if ((centre_is_narrow_ || centre_is_exact_) && is_self_adjacent(t, id)) {
    return centre_is_narrow_ ? Exemption::kFoldAngleAtCentre : Exemption::kMet;
  }
  if (is_seditious(mesh, t, assessment)) return Exemption::kSeditious;
  return Exemption::kNone;
}

bool Criteria::in_lens(Point2 a, Point2 b, Point2 p) const {
  const Point2 pa = a - p, pb = b - p;
  const double d = dot(pa, pb);
  if (d >= 0) return false;
  return d * d >= cos_lens_ * cos_lens_ * squared_length(pa) * squared_length(pb);
}

void Criteria::set_segment_ends(VertexId v, const SegmentEnds& ends) {
  if (static_cast<std::size_t>(v) >= ends_.size()) ends_.resize(static_cast<std::size_t>(v) + 1);
  ends_[static_cast<std::size_t>(v)] = ends;
}

Criteria::SegmentEnds Criteria::segment_ends(const QuotientTriangulation& mesh,
                                             OrbitVertex v,
                                             OrbitVertex other) const {
  for (const OrbitVertex& c : {v, other}) {
    if (mesh.kind(c.orbit) != VertexKind::kSegment) continue;
    const SegmentEnds& ends = ends_[static_cast<std::size_t>(c.orbit)];
    return {{ends.a.orbit, mesh.shift(ends.a.orbit, ends.a.exponent, c.exponent)},
            {ends.b.orbit, mesh.shift(ends.b.orbit, ends.b.exponent, c.exponent)}};
  }
  return {v, other};
}

bool Criteria::is_shell_vertex(VertexId v) const {
  const SegmentEnds& ends = ends_[static_cast<std::size_t>(v)];
  return is_narrow(ends.a.orbit) || is_narrow(ends.b.orbit);
}

}  // namespace symcell::plane
