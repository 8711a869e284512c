#include "core/solid/refine/refiner.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/solid/delaunay/legalise.hpp"

namespace symcell::solid {
namespace {

// Least distance of a new point to its nearest vertex, as a share of the shortest edge of the bad
// tetrahedron that caused it: in a Delaunay mesh a circumcentre is B > 1 such edges away, a point
// of a facet or segment that stands in for it at least 1/sqrt(2) or 1/2 of that.
constexpr double kInteriorShare = 0.9;
constexpr double kFacetShare = 0.65;
constexpr double kSegmentShare = 0.45;
// Likewise for the sake of size, of the cube root of the volume.
constexpr double kSizeShare = 0.3;
// Ends of walks that rounding could send in circles: subfacets crossed, tetrahedra round an edge.
constexpr int kMaxPlaneWalk = 1000;
constexpr int kMaxTurns = 500;
constexpr std::uint64_t kCheckEvery = 256;  // steps: some cost nothing, some an insertion
// Of the queue's key: below all others; sizes within a sixteenth of an octave go by slot.
constexpr std::int32_t kLast = std::numeric_limits<std::int32_t>::min();
constexpr double kStepsAnOctave = 16;
// A mesh that has grown by this factor, to this size at least, is put in order again.
constexpr std::size_t kGrowth = 3;
constexpr std::size_t kLeastToOrder = 5'000;
// A subfacet or subsegment is encroached on by points within this share of its diametral sphere's
// radius. Less than 1 makes smaller meshes; the improvement removes flat tetrahedra that result.
constexpr double kEncroachment2 = 0.95 * 0.95;
// Points for the sake of shape that a run may add: some in any case, some a bad tetrahedron of its
// start, some a point that size asked for.
constexpr std::uint64_t kLeastShapeBudget = 1000;
constexpr std::uint64_t kShapeBudgetABadTet = 2;
constexpr std::uint64_t kShapeBudgetASizePoint = 3;

}  // namespace

Refiner::Refiner(Editor& editor, const Criteria& criteria, ExecutionContext& context)
    : editor_(editor), mesh_(editor.mesh()), criteria_(criteria), context_(context) {
}

void Refiner::enqueue(TetId t) {
  const Tet& tet = mesh_.tet(t);
  const TetMeasures& m = editor_.measures(t);
  const double sized = criteria_.size_excess2(m, tet.region);
  const double ratio = criteria_.excess(m, tet.region, Exemption::kNone);
  if (ratio <= 1) {
    bool illegal = false;
    for (std::uint32_t i = 0; illegal_too_ && i < 4; ++i)
      illegal = illegal || is_illegal(editor_, t, i);
    if (illegal) queue_.push({kLast, t, tet.version});
    return;
  }
  const Exemption exemption = sized > 1 ? Exemption::kNone : criteria_.exemption(mesh_, tet);
  const bool exempt = !criteria_.is_bad(m, tet.region, exemption);
  // As far as the sector forces it, merging mends what is bad at the axis, points do not.
  if (exempt && (!exempt_too_ || exemption == Exemption::kAxis)) return;
  // Shape before size, the worst first, but in steps: within one, tetrahedra follow each other as
  // they lie in memory.
  const double key = sized > 1 ? sized : (exempt ? 1e-10 : 1e10) * ratio;
  const auto step = static_cast<std::int32_t>(kStepsAnOctave * std::log2(std::min(key, 1e30)));
  queue_.push({step, t, tet.version});
}

void Refiner::enqueue_added() {
  for (const TetId t : mesh_.added_ids()) enqueue(t);
}

bool Refiner::still_bad(const Entry& e) const {
  return mesh_.alive(e.t) && mesh_.tet(e.t).version == e.version;
}

void Refiner::enqueue_all() {
  queue_ = {};
  for (TetId t = 0; t < mesh_.tet_slots(); ++t) {
    if (mesh_.alive(t)) enqueue(t);
  }
}

Result<void> Refiner::run() {
  depth_.resize(mesh_.vertex_slots(), 0);
  enqueue_all();
  std::size_t ordered = std::max(mesh_.tet_count(), kLeastToOrder);
  shape_budget_ = kLeastShapeBudget + kShapeBudgetABadTet * queue_.size();
  const double initial = static_cast<double>(queue_.size()) + 1;
  for (std::uint64_t step = 0; !queue_.empty(); ++step) {
    if (step % kCheckEvery == 0) {
      SYMCELL_TRY(context_.check(mesh_.tet_count()));
      if (mesh_.tet_count() > most_tets_) {
        return fail(ErrorCode::kElementLimit, "more tetrahedra than are wanted");
      }
      if (mesh_.tet_count() > kGrowth * ordered) {
        editor_.compact();
        ordered = mesh_.tet_count();
        enqueue_all();
      }
      const double left = static_cast<double>(queue_.size());
      context_.report(Phase::kRefine, 0.15 + 0.45 * (1 - left / std::max(initial, left)),
                      mesh_.tet_count(),
                      1 - std::min(1.0, left / static_cast<double>(mesh_.tet_count() + 1)));
    }
    const Entry e = queue_.top();
    queue_.pop();
    if (!still_bad(e)) continue;
    Outcome done = treat(e.t);
    if (done == Outcome::kRefused && still_bad(e)) done = split_too_large(e.t);
    if (done == Outcome::kRefused) {
      ++counters_.refused;
    } else if (still_bad(e)) {
      queue_.push(e);
    }
  }
  return {};
}

Refiner::Cause Refiner::cause_of(TetId t) const {
  const TetMeasures& m = editor_.measures(t);
  const Tet& tet = mesh_.tet(t);
  Cause cause;
  cause.shortest = std::sqrt(m.shortest2);
  cause.size = criteria_.size_excess2(m, tet.region) > 1;
  const Exemption exemption = criteria_.exemption(mesh_, tet);
  cause.spare = exemption != Exemption::kNone && !criteria_.is_bad(m, tet.region, exemption);
  cause.least = cause.size ? kSizeShare * std::cbrt(std::abs(m.volume)) : 0;
  // The ends of the shortest edge.
  double best = std::numeric_limits<double>::infinity();
  for (const auto& e : kEdgeCorners) {
    const double l2 = squared_distance(mesh_.corner_point(t, e[0]), mesh_.corner_point(t, e[1]));
    if (l2 >= best) continue;
    best = l2;
    const auto depth = [&](VertexId v) {
      return static_cast<std::size_t>(v) < depth_.size() ? depth_[static_cast<std::size_t>(v)]
                                                         : std::uint8_t{0};
    };
    cause.depth = std::max(depth(tet.v[e[0]]), depth(tet.v[e[1]]));
  }
  return cause;
}

double Refiner::nearest_to(const Cavity& cavity) const {
  double nearest = std::sqrt(cavity.nearest2);
  if (mesh_.fold() > 1) {
    const Point3 p = cavity.point;
    const double rho = std::sqrt(p.x * p.x + p.y * p.y);
    // Copies of the point itself; on the axis it has none.
    if (rho > 0) nearest = std::min(nearest, 2 * rho * std::sin(std::numbers::pi / mesh_.fold()));
  }
  return nearest;
}

bool Refiner::allowed(const Cavity& cavity, const Cause& cause, double share) const {
  const double nearest = nearest_to(cavity);
  if (nearest < criteria_.min_edge()) return false;
  if (cause.size) return nearest >= cause.least;
  if (!may_add_for_shape()) return false;
  if (nearest < std::max(least_distance_, share * cause.shortest)) return false;
  return nearest >= cause.shortest || (cause.depth < max_depth_ && !cause.spare);
}

// Bounds on size must be kept, however the cavity has to be cut down.
bool Refiner::find_cavity(Point3 p, const Location& where, const Cause& cause) {
  return editor_.find_cavity(p, where, cavity_, cause.size ? Editor::kAny : most_hidden_);
}

Refiner::Outcome Refiner::insert(
    const Cavity& cavity, VertexKind kind, std::int32_t parent, bool on_axis, const Cause& cause) {
  const VertexId v = editor_.insert(cavity, kind, parent, on_axis);
  if (v == Editor::kNoVertex) return Outcome::kRefused;
  depth_.resize(std::max(depth_.size(), mesh_.vertex_slots()), 0);
  const bool nearer = !cause.size && cavity.nearest2 < cause.shortest * cause.shortest;
  depth_[static_cast<std::size_t>(v)] =
      static_cast<std::uint8_t>(cause.size ? 0 : cause.depth + (nearer ? 1 : 0));
  account(cause);
  enqueue_added();
  return Outcome::kInserted;
}

void Refiner::account(const Cause& cause) {
  if (cause.size) {
    shape_budget_ += kShapeBudgetASizePoint;
  } else {
    --shape_budget_;
  }
}

bool Refiner::may_add_for_shape() const {
  return shape_budget_ > 0 && mesh_.tet_count() <= most_shaped_;
}

Refiner::Outcome Refiner::treat(TetId t) {
  const Cause cause = cause_of(t);
  // No point would be allowed, wherever it came to lie: it need not be looked for.
  if (!cause.size && !may_add_for_shape()) return Outcome::kRefused;
  const Point3 p = editor_.measures(t).centre;
  const auto walk = editor_.walk({t, 0}, p);
  if (walk.lost) return Outcome::kRefused;
  if (walk.blocked) return split_subfacet({walk.at, walk.face}, cause);
  Location where;
  where.at = walk.at;
  const bool found = find_cavity(p, where, cause);
  // Where there is none the point lies on a face or an edge of the seeds, and on what is
  // constrained there if it is: models that are made with compasses are full of such places.
  const Encroached e = found ? encroached_by(cavity_, true) : encroached_beside(cavity_, true);
  if (e.what == Encroached::What::kSubsegment) return split_segment(e.at, e.a, e.b, cause);
  if (e.what == Encroached::What::kSubfacet) return split_subfacet(e.subfacet, cause);
  if (!found || !allowed(cavity_, cause, kInteriorShare)) return Outcome::kRefused;
  const Outcome done = insert(cavity_, VertexKind::kFree, -1, false, cause);
  if (done == Outcome::kInserted) ++counters_.interior_points;
  return done;
}

// Subsegments go first: a subfacet beside one may be mended with it.
void Refiner::Encroached::look_at_segments(const QuotientTetrahedralization& mesh,
                                           Point3 p,
                                           const CavityFace& f,
                                           TetCopy owner) {
  for (std::size_t j = 0; j < 3; ++j) {
    const std::size_t k = (j + 1) % 3;
    if (mesh.segment_of(f.corners[j], f.corners[k]) == kNoSegment) continue;
    const Point3 middle = 0.5 * (f.points[j] + f.points[k]);
    const double share =
        4 * squared_distance(p, middle) / squared_distance(f.points[j], f.points[k]);
    if (share >= worst) continue;
    worst = share;
    what = What::kSubsegment;
    at = owner;
    a = f.corners[j];
    b = f.corners[k];
  }
}

void Refiner::Encroached::look_at_facet(Point3 p, const CavityFace& f, Subfacet s) {
  if (f.facet == kNoFacet) return;
  const Point3 centre = triangle_circumcentre(f.points[0], f.points[1], f.points[2]);
  const double share = squared_distance(p, centre) / squared_distance(f.points[0], centre);
  if (share >= worst) return;
  worst = share;
  what = What::kSubfacet;
  subfacet = s;
}

Refiner::Encroached Refiner::encroached_by(const Cavity& cavity, bool facets) const {
  Encroached found;
  found.worst = kEncroachment2;
  for (const CavityFace& f : cavity.faces) {
    found.look_at_segments(mesh_, cavity.point, f, cavity.tets[f.owner]);
  }
  if (found.what != Encroached::What::kNothing || !facets) return found;
  for (const CavityFace& f : cavity.faces) {
    const TetCopy at = cavity.tets[f.owner];
    found.look_at_facet(cavity.point, f, {at, face_with(at, f.corners)});
  }
  return found;
}

Refiner::Encroached Refiner::encroached_beside(const Cavity& cavity, bool facets) const {
  Encroached found;
  found.worst = kEncroachment2;
  for (const bool segments : {true, false}) {
    for (std::size_t s = 0; s < cavity.seeds; ++s) {
      for (std::uint32_t i = 0; i < 4; ++i) {
        const CavityFace f = editor_.face_of_copy(cavity.tets[s], i);
        if (segments) {
          found.look_at_segments(mesh_, cavity.point, f, cavity.tets[s]);
        } else {
          found.look_at_facet(cavity.point, f, {cavity.tets[s], i});
        }
      }
    }
    if (found.what != Encroached::What::kNothing || !facets) break;
  }
  return found;
}

std::uint32_t Refiner::face_with(TetCopy at, const std::array<OrbitVertex, 3>& corners) const {
  std::uint32_t face = 0;
  for (std::uint32_t i = 0; i < 4; ++i) {
    const OrbitVertex x = mesh_.corner(at, i);
    if (std::find(corners.begin(), corners.end(), x) == corners.end()) face = i;
  }
  return face;
}

bool Refiner::cross_edge(Subfacet& s, OrbitVertex a, OrbitVertex b) const {
  if (mesh_.segment_of(a, b) != kNoSegment) return false;
  const std::int32_t facet = mesh_.tet(s.at.t).facet[s.face];
  TetCopy c = s.at;
  std::uint32_t from = s.face;
  for (int turn = 0; turn < kMaxTurns; ++turn) {
    // The other face at the edge.
    std::uint32_t leave = 4;
    for (std::uint32_t i = 0; i < 4; ++i) {
      const OrbitVertex x = mesh_.corner(c, i);
      if (i != from && !(x == a) && !(x == b)) leave = i;
    }
    if (leave == 4) return false;
    const Tet& t = mesh_.tet(c.t);
    if (t.facet[leave] != kNoFacet) {
      if (t.facet[leave] != facet) return false;
      s = {c, leave};
      return true;
    }
    from = face_of(t.nb[leave]);
    c = mesh_.neighbour(c, leave);
  }
  return false;
}

Refiner::Outcome Refiner::split_subfacet(Subfacet s, const Cause& cause) {
  const std::int32_t facet = mesh_.tet(s.at.t).facet[s.face];
  std::array<OrbitVertex, 3> x;
  std::array<Point3, 3> q;
  const auto load = [&] {
    for (std::size_t j = 0; j < 3; ++j) {
      x[j] = mesh_.corner(s.at, kFaceCorners[s.face][j]);
      q[j] = mesh_.lift(x[j]);
    }
  };
  load();
  Point3 p = triangle_circumcentre(q[0], q[1], q[2]);
  const Point3 start = (1.0 / 3.0) * (q[0] + q[1] + q[2]);
  // In the plane of the facet, straight from the subfacet's middle to its circumcentre.
  std::size_t entered = 3;
  for (int step = 0; step < kMaxPlaneWalk; ++step) {
    const Point3 n = cross(q[1] - q[0], q[2] - q[0]);
    std::size_t leave = 3;
    double first = 1;
    for (std::size_t j = 0; j < 3; ++j) {
      if (j == entered) continue;
      const Point3 a = q[j], b = q[(j + 1) % 3];
      const Point3 out = cross(b - a, n);
      const double along = dot(out, p - start);
      if (along <= 0) continue;
      const double at = dot(out, a - start) / along;
      if (at < first) {
        first = at;
        leave = j;
      }
    }
    if (leave == 3) break;
    const OrbitVertex a = x[leave], b = x[(leave + 1) % 3];
    if (mesh_.segment_of(a, b) != kNoSegment) return split_segment(s.at, a, b, cause);
    if (!cross_edge(s, a, b)) return Outcome::kRefused;
    load();
    entered = 3;
    for (std::size_t j = 0; j < 3; ++j) {
      const OrbitVertex c = x[j], d = x[(j + 1) % 3];
      if ((c == a && d == b) || (c == b && d == a)) entered = j;
    }
  }
  // Onto the plane of the subfacet that holds it.
  const Point3 n = cross(q[1] - q[0], q[2] - q[0]);
  p = p - (dot(p - q[0], n) / dot(n, n)) * n;
  Location where;
  where.kind = Location::Kind::kOnSubfacet;
  where.at = s.at;
  where.face = s.face;
  const bool found = find_cavity(p, where, cause);
  const Encroached e = found ? encroached_by(cavity_, false) : encroached_beside(cavity_, false);
  if (e.what == Encroached::What::kSubsegment) return split_segment(e.at, e.a, e.b, cause);
  if (!found || !allowed(cavity_, cause, kFacetShare)) return Outcome::kRefused;
  const Outcome done = insert(cavity_, VertexKind::kFacet, facet, false, cause);
  if (done == Outcome::kInserted) ++counters_.facet_splits;
  return done;
}

// The last resort for what is too large: halve an edge, the longest that can be. Where all edges
// meet copies of their own star (cells of a few tetrahedra round the axis) its middle is always
// free.
Refiner::Outcome Refiner::split_too_large(TetId t) {
  Cause cause = cause_of(t);
  if (!cause.size) return Outcome::kRefused;
  std::array<std::pair<double, std::size_t>, 6> edges;
  for (std::size_t i = 0; i < 6; ++i) {
    const auto& e = kEdgeCorners[i];
    edges[i] = {-squared_distance(mesh_.corner_point(t, e[0]), mesh_.corner_point(t, e[1])), i};
  }
  std::sort(edges.begin(), edges.end());
  // In a narrow sector copies of the point are near whatever is done: the second round takes it so.
  for (const double least : {cause.least, 0.0}) {
    cause.least = least;
    for (const auto& [length2, i] : edges) {
      const Outcome done = split_edge(t, mesh_.corner(t, kEdgeCorners[i][0]),
                                      mesh_.corner(t, kEdgeCorners[i][1]), cause);
      if (done == Outcome::kInserted) return done;
    }
  }
  Point3 middle;
  for (std::uint32_t i = 0; i < 4; ++i) middle = middle + 0.25 * mesh_.corner_point(t, i);
  Location where;
  where.at = {t, 0};
  if (!find_cavity(middle, where, cause)) return Outcome::kRefused;
  if (nearest_to(cavity_) < criteria_.min_edge()) return Outcome::kRefused;
  const Outcome done = insert(cavity_, VertexKind::kFree, -1, false, cause);
  if (done == Outcome::kInserted) ++counters_.interior_points;
  return done;
}

Refiner::Outcome Refiner::split_edge(TetId t, OrbitVertex a, OrbitVertex b, const Cause& cause) {
  if (mesh_.segment_of(a, b) != kNoSegment) return split_segment({t, 0}, a, b, cause);
  Location where;
  where.kind = Location::Kind::kOnEdge;
  where.at = {t, 0};
  where.edge = {a, b};
  const Point3 middle = 0.5 * (mesh_.lift(a) + mesh_.lift(b));
  if (!find_cavity(middle, where, cause)) return Outcome::kRefused;
  if (!allowed(cavity_, cause, kInteriorShare)) return Outcome::kRefused;
  // An edge inside a facet has subfacets of that one facet only.
  const std::int32_t facet = cavity_.outline.empty() ? kNoFacet : cavity_.outline.front().facet;
  const Outcome done = insert(cavity_, facet == kNoFacet ? VertexKind::kFree : VertexKind::kFacet,
                              facet, false, cause);
  if (done == Outcome::kInserted) ++counters_.interior_points;
  return done;
}

Refiner::Outcome Refiner::split_segment(TetCopy at,
                                        OrbitVertex a,
                                        OrbitVertex b,
                                        const Cause& cause) {
  const Point3 p = mesh_.lift(a), q = mesh_.lift(b);
  double at_share = 0.5;
  const bool sharp_a = criteria_.acute_vertex(mesh_, a.orbit);
  const bool sharp_b = criteria_.acute_vertex(mesh_, b.orbit);
  if (sharp_a != sharp_b) {
    // Concentric shells: powers of two from the sharp vertex, so that segments that meet there at a
    // small angle are split at equal distances.
    const double l = distance(p, q);
    const double shell = std::exp2(std::round(std::log2(0.5 * l)));
    at_share = std::clamp(shell / l, 0.3, 0.7);
    if (sharp_b) at_share = 1 - at_share;
  }
  const std::int32_t segment = mesh_.segment_of(a, b);
  Location where;
  where.kind = Location::Kind::kOnEdge;
  where.at = at;
  where.edge = {a, b};
  const Point3 middle = (1 - at_share) * p + at_share * q;
  if (!find_cavity(middle, where, cause)) return Outcome::kRefused;
  if (!allowed(cavity_, cause, kSegmentShare)) return Outcome::kRefused;
  const bool axis = mesh_.on_axis(a.orbit) && mesh_.on_axis(b.orbit);
  const Outcome done = insert(cavity_, VertexKind::kSegment, segment, axis, cause);
  if (done == Outcome::kInserted) ++counters_.segment_splits;
  return done;
}

}  // namespace symcell::solid
