#include "core/plane/refine/refiner.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <string>

namespace symcell::plane {
namespace {

// An angle bound is out of reach where edges this much shorter than the smallest feature of the
// initial triangulation appear: fair grading stays orders of magnitude above it, a cascade falls
// below within a few hundred steps.
constexpr double kCascadeRatio = 1e-5;
// Edges below this share of the model's extent drown in rounding.
constexpr double kResolution = 1e-12;
// A vertex is relocated at most this often while refining: area bounds could make it wander.
constexpr std::uint8_t kMaxMoves = 12;
constexpr std::uint64_t kCheckEvery = 256;  // steps: some cost nothing, some an insertion
// Off-centres lie where the new triangle's angle is a little above the bound [Shewchuk, Triangle].
constexpr double kOffCentreFactor = 0.475;
// Samples lie within this many shortest edges of the off-centre.
constexpr double kSampleReach = 1.5;

// Bits of Subsegment::queued: to be split if encroached on, and in any case.
constexpr std::uint8_t kQueued = 1;
constexpr std::uint8_t kForced = 2;

// The distance from a corner to the subsegment opposite it, squared, where its foot lies within:
// gaps between segments may be far smaller than all edges.
double squared_gap(const QuotientTriangulation& mesh, const Triangle& t) {
  double least2 = std::numeric_limits<double>::infinity();
  for (std::uint32_t j = 0; j < 3; ++j) {
    if (t.seg[j] == kNoSubsegment) continue;
    const Point2 p = mesh.corner_point(t, j);
    const Point2 a = mesh.corner_point(t, next3(j)), b = mesh.corner_point(t, prev3(j));
    if (dot(p - a, b - a) <= 0 || dot(p - b, a - b) <= 0) continue;
    const double doubled = cross(b - a, p - a);
    least2 = std::min(least2, doubled * doubled / squared_distance(a, b));
  }
  return least2;
}

}  // namespace

Refiner::Refiner(Editor& editor,
                 Criteria& criteria,
                 const Settings& settings,
                 ExecutionContext& context)
    : editor_(editor),
      mesh_(editor.mesh()),
      criteria_(criteria),
      settings_(settings),
      relocate_(settings.relocate && criteria.has_bound()),
      context_(context),
      random_(settings.seed),
      surgery_(editor, criteria) {
  double shortest2 = std::numeric_limits<double>::infinity(), extent = 0;
  for (TriangleId t = 0; t < mesh_.triangle_slots(); ++t) {
    if (!mesh_.alive(t)) continue;
    const Triangle& tri = mesh_.triangle(t);
    shortest2 =
        std::min({shortest2, criteria_.assess(mesh_, tri).shortest2, squared_gap(mesh_, tri)});
    for (const VertexId v : tri.v) extent = std::max(extent, length(mesh_.point(v)));
  }
  const double cascade = kCascadeRatio * std::sqrt(shortest2);
  const double limit = std::max(cascade, kResolution * extent);
  shortest_allowed2_ = limit * limit;
  unit_ = extent;
}

Result<void> Refiner::tick() {
  if (++steps_ % kCheckEvery != 0) return {};
  const auto elements = static_cast<std::uint64_t>(mesh_.triangle_count());
  const double waiting = static_cast<double>(queue_.size());
  const double quality = std::max(0.0, 1.0 - waiting / static_cast<double>(elements));
  if (elements > settings_.most_triangles) {
    return fail(ErrorCode::kElementLimit, "more triangles than this start may have");
  }
  context_.report(Phase::kRefine, 0.1 + 0.6 * quality, elements, quality);
  return context_.check(elements);
}

void Refiner::enqueue_subsegment(SubsegmentId s) {
  Subsegment& seg = mesh_.subsegment(s);
  if (seg.queued == 0) segments_.push_back(s);
  seg.queued |= kForced;
}

void Refiner::look_at_subsegment(SubsegmentId s) {
  Subsegment& seg = mesh_.subsegment(s);
  if (seg.queued != 0 || !encroached(s) || !may_split(s)) return;
  seg.queued = kQueued;
  segments_.push_back(s);
}

// By one of the vertices opposite it, or by its own length.
bool Refiner::encroached(SubsegmentId s) const {
  const HalfEdge h = mesh_.subsegment(s).half_edge;
  const Triangle& t = mesh_.triangle(triangle_of(h));
  const std::uint32_t j = local_of(h);
  const Point2 a = mesh_.corner_point(t, next3(j)), b = mesh_.corner_point(t, prev3(j));
  if (criteria_.edge_too_long(mesh_, t, j)) return true;
  // What a lens would catch is a bad triangle too, treated as such, or no angle is asked for.
  if (relocate_ || criteria_.goal_angle() <= 0) return false;
  if (criteria_.in_lens(a, b, mesh_.corner_point(t, j))) return true;
  const HalfEdge g = t.nb[j];
  if (g == kNoHalfEdge) return false;
  const Triangle& u = mesh_.triangle(triangle_of(g));
  const std::uint32_t i = local_of(g);
  return criteria_.in_lens(mesh_.corner_point(u, next3(i)), mesh_.corner_point(u, prev3(i)),
                           mesh_.corner_point(u, i));
}

void Refiner::enqueue_all() {
  for (std::size_t s = 0; s < mesh_.subsegment_slots(); ++s) {
    if (mesh_.subsegment(static_cast<SubsegmentId>(s)).alive) {
      look_at_subsegment(static_cast<SubsegmentId>(s));
    }
  }
  for (TriangleId t = 0; t < mesh_.triangle_slots(); ++t) {
    if (!mesh_.alive(t)) continue;
    const Assessment a = criteria_.assess(mesh_, mesh_.triangle(t));
    if (a.verdict != Verdict::kGood) queue_.push(mesh_, t, a.shortest2);
  }
}

void Refiner::enqueue_created() {
  for (const TriangleId t : editor_.created()) {
    if (!mesh_.alive(t)) continue;
    const Triangle& tri = mesh_.triangle(t);
    for (const SubsegmentId s : tri.seg) {
      if (s != kNoSubsegment) look_at_subsegment(s);
    }
    const Assessment a = criteria_.assess(mesh_, tri);
    if (a.verdict != Verdict::kGood) queue_.push(mesh_, t, a.shortest2);
  }
}

Result<void> Refiner::run() {
  enqueue_all();
  for (;;) {
    SYMCELL_TRY(split_queued_subsegments());
    const auto t = queue_.pop(mesh_);
    if (!t) break;
    SYMCELL_TRY(tick());
    switch (treat(*t)) {
      case Outcome::kExempt: break;
      case Outcome::kDone:
      case Outcome::kRetry: {
        // What was done near it may have left the triangle as it was.
        if (!mesh_.alive(*t)) break;
        const Assessment a = criteria_.assess(mesh_, mesh_.triangle(*t));
        if (a.verdict != Verdict::kGood) queue_.push(mesh_, *t, a.shortest2);
        break;
      }
      case Outcome::kStuck: return fail(unreachable(*t));
    }
  }
  return context_.check(mesh_.triangle_count());
}

Error Refiner::unreachable(TriangleId t) const {
  const Triangle& tri = mesh_.triangle(t);
  const Point2 p = mesh_.corner_point(tri, 0) + settings_.centre;
  char text[256];
  std::snprintf(text, sizeof text,
                "the bounds cannot be reached near (%.9g, %.9g): edges shrink there without end; "
                "lower min_angle, or look for nearly touching segments or small angles there",
                p.x, p.y);
  return {ErrorCode::kBoundUnreachable, text, {}, ""};
}

// ---------------------------------------------------------------------------- subsegments

Result<void> Refiner::split_queued_subsegments() {
  while (!segments_.empty()) {
    const SubsegmentId s = segments_.back();
    segments_.pop_back();
    if (static_cast<std::size_t>(s) >= mesh_.subsegment_slots()) continue;  // of a split taken back
    Subsegment& seg = mesh_.subsegment(s);
    if (!seg.alive || seg.queued == 0) continue;
    const bool forced = (seg.queued & kForced) != 0;
    seg.queued = 0;
    if (!forced && !encroached(s)) continue;
    SYMCELL_TRY(tick());
    if (criteria_.may_leave_bad()) {
      split_if_allowed(s);
    } else {
      SYMCELL_TRY(split(s));
    }
  }
  return {};
}

bool Refiner::may_split(SubsegmentId s) const {
  if (criteria_.keeps_any_segment()) {
    const Subsegment& segment = mesh_.subsegment(s);
    const HalfEdge h = segment.half_edge;
    const bool on_boundary = mesh_.triangle(triangle_of(h)).nb[local_of(h)] == kNoHalfEdge;
    if (criteria_.keeps(segment.parent, on_boundary)) return false;
  }
  const auto at = static_cast<std::size_t>(s);
  return at >= refused_.size() || refused_[at] == 0;
}

// Splits a subsegment unless that makes an edge too short, or cannot be done: then it stays for good.
void Refiner::split_if_allowed(SubsegmentId s) {
  if (!may_split(s)) return;
  mesh_.begin();
  const RefineCounters counted = counters_;
  if (split(s) && !made_short_edge()) {
    mesh_.commit();
    return;
  }
  mesh_.roll_back();
  counters_ = counted;
  if (static_cast<std::size_t>(s) >= refused_.size()) refused_.resize(mesh_.subsegment_slots(), 0);
  refused_[static_cast<std::size_t>(s)] = 1;
}

bool Refiner::made_short_edge() const {
  for (const TriangleId t : editor_.created()) {
    if (mesh_.alive(t) && criteria_.has_short_edge(mesh_, mesh_.triangle(t))) return true;
  }
  return false;
}

// Free vertices inside the diametral circle would be too near to the new vertex: delete them
// [Chew93], [Shewchuk02].
void Refiner::clear_lens(SubsegmentId s) {
  for (int side = 0; side < 2; ++side) {
    for (;;) {
      HalfEdge h = mesh_.subsegment(s).half_edge;
      if (side == 1) h = mesh_.triangle(triangle_of(h)).nb[local_of(h)];
      if (h == kNoHalfEdge) break;
      const Triangle& t = mesh_.triangle(triangle_of(h));
      const std::uint32_t j = local_of(h);
      const Point2 p = mesh_.corner_point(t, j);
      const VertexId apex = t.v[j];
      if (mesh_.kind(apex) != VertexKind::kFree) break;
      if (dot(mesh_.corner_point(t, next3(j)) - p, mesh_.corner_point(t, prev3(j)) - p) >= 0) break;
      if (!surgery_.remove(apex)) break;
      enqueue_created();
      ++counters_.removed;
    }
  }
}

// The midpoint, or, next to an acute vertex, the nearest shell: lengths of a power of two.
Point2 Refiner::split_point(OrbitVertex a, OrbitVertex b) const {
  const Point2 p = mesh_.lift(a.orbit, a.exponent), q = mesh_.lift(b.orbit, b.exponent);
  const bool at_a = criteria_.is_acute(a.orbit), at_b = criteria_.is_acute(b.orbit);
  if (at_a == at_b) return 0.5 * (p + q);
  const double len = distance(p, q) / unit_;
  // A shell between a third and two thirds of the way.
  int exponent = 0;
  static_cast<void>(std::frexp(len / 1.5, &exponent));
  double shell = std::ldexp(1.0, exponent - 1);
  if (shell > len * 2.0 / 3.0) shell *= 0.5;
  const double part = shell / len;
  return at_a ? p + part * (q - p) : q + part * (p - q);
}

Result<void> Refiner::split(SubsegmentId s) {
  clear_lens(s);
  const HalfEdge h = mesh_.subsegment(s).half_edge;
  const TriangleId t = triangle_of(h);
  const std::uint32_t j = local_of(h);
  const Triangle& tri = mesh_.triangle(t);
  const OrbitVertex a{tri.v[next3(j)], tri.k[next3(j)]}, b{tri.v[prev3(j)], tri.k[prev3(j)]};
  const Point2 p = mesh_.lift(a.orbit, a.exponent), q = mesh_.lift(b.orbit, b.exponent);
  if (squared_distance(p, q) < 4 * shortest_allowed2_) {
    return fail(unreachable(t));
  }
  const Criteria::SegmentEnds ends = criteria_.segment_ends(mesh_, a, b);
  Point2 x = split_point(a, b);
  editor_.compute_edge_cavity(h, x, cavity_);
  bool optimal = false;
  const bool on_shells = criteria_.is_narrow(ends.a.orbit) || criteria_.is_narrow(ends.b.orbit);
  if (relocate_ && !on_shells && cavity_.simple) {
    surgery_.lift_edges(cavity_.edges, star_edges_);
    if (const auto y = surgery_.region().find_on_line(star_edges_, p, q - p)) {
      x = *y;
      optimal = true;
    }
  }
  const VertexId v = editor_.insert_on_edge(h, x, cavity_, VertexKind::kSegment);
  if (v < 0) return fail(unreachable(t));
  if (optimal) settle_star();
  criteria_.set_segment_ends(v, ends);
  ++counters_.splits;
  ++counters_.inserted;
  enqueue_created();
  return {};
}

// The star of a point that is not the one its cavity was made for need not be Delaunay.
void Refiner::settle_star() {
  editor_.queue_star();
  editor_.legalise();
}

// ---------------------------------------------------------------------------- bad triangles

Refiner::Outcome Refiner::treat(TriangleId t) {
  const Assessment a = criteria_.assess(mesh_, mesh_.triangle(t));
  if (a.verdict == Verdict::kGood) return Outcome::kDone;
  if (!a.too_large && criteria_.exemption(mesh_, t, a) != Exemption::kNone) {
    return Outcome::kExempt;
  }
  const Outcome outcome = improve(t, a);
  return outcome == Outcome::kStuck && criteria_.may_leave_bad() ? Outcome::kExempt : outcome;
}

Refiner::Outcome Refiner::improve(TriangleId t, const Assessment& a) {
  if (a.shortest2 < shortest_allowed2_) return Outcome::kStuck;
  if (relocate_ && a.verdict == Verdict::kAngle && relocate_corner_of(t)) return Outcome::kDone;
  if (settings_.samples > 0 && a.verdict == Verdict::kAngle && insert_sampled(t, a)) {
    return Outcome::kDone;
  }
  const Outcome first = insert_for(t, off_centre(t, a, false));
  if (first != Outcome::kStuck) return first;
  return insert_for(t, off_centre(t, a, true));
}

bool Refiner::relocate_corner_of(TriangleId t) {
  const Triangle tri = mesh_.triangle(t);
  for (std::uint32_t i = 0; i < 3; ++i) {
    const VertexId v = tri.v[i];
    if (mesh_.kind(v) == VertexKind::kInput) continue;
    if (static_cast<std::size_t>(v) >= moves_.size()) moves_.resize(mesh_.vertex_slots(), 0);
    if (moves_[static_cast<std::size_t>(v)] >= kMaxMoves || !surgery_.relocate(v)) continue;
    ++moves_[static_cast<std::size_t>(v)];
    ++counters_.relocations;
    enqueue_created();
    return true;
  }
  return false;
}

// On the bisector of the shortest edge: the circumcentre, or nearer, where the new triangle just
// keeps the bound [Ungor04].
Point2 Refiner::off_centre(TriangleId t, const Assessment& assessment, bool farther) const {
  const Triangle& tri = mesh_.triangle(t);
  const std::uint32_t s = assessment.shortest;
  const Point2 a = mesh_.corner_point(tri, next3(s)), b = mesh_.corner_point(tri, prev3(s));
  const Point2 c = mesh_.corner_point(tri, s);
  const Point2 ab = b - a, ac = c - a;
  const double doubled = 2 * cross(ab, ac);
  const double b2 = squared_length(ab), c2 = squared_length(ac);
  const Point2 centre{(ac.y * b2 - ab.y * c2) / doubled, (ab.x * c2 - ac.x * b2) / doubled};
  const double goal = criteria_.goal_angle();
  if (farther || goal <= 0) return a + centre;
  const double reach = kOffCentreFactor / std::tan(0.5 * goal);
  const Point2 off{0.5 * ab.x - reach * ab.y, 0.5 * ab.y + reach * ab.x};
  const Point2 half = 0.5 * ab;
  return squared_distance(off, half) < squared_distance(centre, half) ? a + off : a + centre;
}

// Which subsegments of a cavity's boundary x encroaches on; they are queued to be split, unless one of
// them must not be.
Refiner::Encroachment Refiner::encroachment(const Cavity& cavity, Point2 x) {
  encroached_.clear();
  for (const CavityEdge& e : cavity.edges) {
    if (e.seg == kNoSubsegment) continue;
    if (!criteria_.in_lens(mesh_.lift(e.a.orbit, e.a.exponent), mesh_.lift(e.b.orbit, e.b.exponent),
                           x)) {
      continue;
    }
    if (!may_split(e.seg)) return Encroachment::kRefused;
    encroached_.push_back(e.seg);
  }
  for (const SubsegmentId s : encroached_) enqueue_subsegment(s);
  return encroached_.empty() ? Encroachment::kNone : Encroachment::kQueued;
}

Refiner::Outcome Refiner::insert_for(TriangleId t, Point2 x) {
  if (!std::isfinite(x.x) || !std::isfinite(x.y)) return Outcome::kStuck;
  const Location where = locate(mesh_, t, x);
  if (where.kind == Location::Kind::kLost) return Outcome::kStuck;
  if (where.kind == Location::Kind::kBlocked) {
    const SubsegmentId s =
        mesh_.triangle(triangle_of(where.half_edge)).seg[local_of(where.half_edge)];
    if (!may_split(s)) return Outcome::kStuck;
    enqueue_subsegment(s);
    return Outcome::kRetry;
  }
  const TriangleId home = triangle_of(where.half_edge);
  x = mesh_.rotations().rotate(x, mesh_.subtract(0, where.exponent));
  if (const auto y = good_star_near(home, x)) return insert_at(home, *y, true, where.exponent);
  switch (encroachment(cavity_, x)) {
    case Encroachment::kNone: break;
    case Encroachment::kQueued: return Outcome::kRetry;
    case Encroachment::kRefused: return Outcome::kStuck;
  }
  return insert_at(home, x, false, where.exponent);
}

// Leaves the cavity of x in cavity_. A point in it whose star keeps all bounds, if there is one.
std::optional<Point2> Refiner::good_star_near(TriangleId home, Point2 x) {
  editor_.compute_cavity(home, x, cavity_);
  if (!relocate_ || !cavity_.simple) return std::nullopt;
  surgery_.lift_edges(cavity_.edges, star_edges_);
  return surgery_.region().find(star_edges_);
}

// Inserts x, whose cavity is in cavity_.
Refiner::Outcome Refiner::insert_at(TriangleId home,
                                    Point2 x,
                                    bool optimal,
                                    std::int32_t exponent) {
  const double least2 = std::max(shortest_allowed2_, criteria_.min_edge2());
  for (const CavityEdge& e : cavity_.edges) {
    if (squared_distance(mesh_.lift(e.a.orbit, e.a.exponent), x) < least2) return Outcome::kStuck;
  }
  // A cavity that met itself gives edges that it does not show.
  const bool guarded = criteria_.has_least_edge();
  if (guarded) mesh_.begin();
  const VertexId v = editor_.insert_in_cavity(home, x, cavity_, VertexKind::kFree);
  if (v >= 0 && optimal) settle_star();
  if (guarded) {
    if (v < 0 || made_short_edge()) {
      mesh_.roll_back();
      return Outcome::kStuck;
    }
    mesh_.commit();
  }
  if (v < 0) return Outcome::kStuck;
  if (exponent != 0) ++editor_.counters().crossings;
  if (static_cast<std::size_t>(v) < moves_.size()) moves_[static_cast<std::size_t>(v)] = 0;
  ++counters_.inserted;
  enqueue_created();
  return Outcome::kDone;
}

// Other cavities than the off-centre's may have room for a good star: tries random points round the
// off-centre. Pays at bounds near 40 degrees, where plain refinement cascades.
bool Refiner::insert_sampled(TriangleId t, const Assessment& assessment) {
  const Point2 middle = off_centre(t, assessment, false);
  const double reach = kSampleReach * std::sqrt(assessment.shortest2);
  for (int i = 0; i < settings_.samples; ++i) {
    const double angle = 2 * std::numbers::pi * random_.uniform();
    const double radius = i == 0 ? 0 : reach * std::sqrt(random_.uniform());
    Point2 x = middle + radius * Point2{std::cos(angle), std::sin(angle)};
    const Location where = locate(mesh_, t, x);
    if (where.kind != Location::Kind::kInside) continue;
    const TriangleId home = triangle_of(where.half_edge);
    x = mesh_.rotations().rotate(x, mesh_.subtract(0, where.exponent));
    const auto y = good_star_near(home, x);
    const bool replaces = std::any_of(cavity_.triangles.begin(), cavity_.triangles.end(),
                                      [&](const CavityTriangle& c) { return c.t == t; });
    if (y && replaces && insert_at(home, *y, true, where.exponent) == Outcome::kDone) return true;
  }
  return false;
}

}  // namespace symcell::plane
