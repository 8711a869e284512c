#include "core/solid/delaunay/editor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "core/base/assert.hpp"

namespace symcell::solid {
namespace {

// More steps than any walk in a sane mesh takes; slivers can make a walk go in circles.
constexpr int kMaxWalk = 2000;
// Cavities larger than this come from huge flat tetrahedra of the first mesh: the smallest cavity
// will do there.
constexpr std::size_t kMaxCavity = 1500;
// Share of the way by which a point may lie in front of a subfacet and yet count as on it.
constexpr double kOnSubfacet = 1e-6;
// More tetrahedra than this do not meet at a point or edge of a sane mesh.
constexpr std::size_t kMaxSeeds = 64;
// A sphere contains a point if it does so by this share: ties are left alone.
constexpr double kInSphereShare = 1e-10;

bool is_flat(Point3 p, Point3 a, Point3 b, Point3 c, double relative) {
  const double volume6 = six_volumes(p, a, b, c);
  if (volume6 <= 0) return true;
  const double l2 =
      std::max({squared_distance(p, a), squared_distance(p, b), squared_distance(p, c),
                squared_distance(a, b), squared_distance(b, c), squared_distance(c, a)});
  return volume6 <= relative * l2 * std::sqrt(l2);
}

// Whether p and `inner` are on one side of the line through a and b; all four lie in one plane but
// for rounding. As with volumes, what is nearly on the line is not.
bool is_seen(Point3 p, Point3 a, Point3 b, Point3 inner) {
  const Point3 d = b - a, q = p - a;
  const Point3 normal = cross(d, inner - a);
  const double reach2 = std::max(dot(d, d), dot(q, q));
  return dot(cross(d, q), normal) > kMinRelativeVolume * reach2 * length(normal);
}

}  // namespace

Editor::Editor(QuotientTetrahedralization& mesh) : mesh_(mesh) {
  remeasure_all();
}

void Editor::remeasure_all() {
  measures_.assign(mesh_.tet_slots(), {});
  for (TetId t = 0; t < mesh_.tet_slots(); ++t) {
    if (mesh_.alive(t)) measures_[t] = measure(t);
  }
}

void Editor::begin() {
  mesh_.begin();
  counters_before_ = counters_;
}

std::vector<TetId> Editor::roll_back() {
  std::vector<TetId> written = mesh_.roll_back();
  std::erase_if(written, [&](TetId t) { return !mesh_.alive(t); });
  for (const TetId t : written) measures_[t] = measure(t);
  counters_ = counters_before_;
  return written;
}

void Editor::compact() {
  std::vector<TetMeasures> measures;
  measures.reserve(mesh_.tet_count());
  for (const TetId old : mesh_.compact_tets()) measures.push_back(measures_[old]);
  measures_ = std::move(measures);
}

bool Editor::replace(std::span<const TetCopy> removed,
                     std::span<const NewTet> added,
                     std::span<const EdgeKey> segment_edges) {
  bool crosses = false;
  for (const TetCopy& c : removed) crosses = crosses || c.e != removed.front().e;
  if (!mesh_.replace(removed, added, segment_edges)) return false;
  if (measures_.size() < mesh_.tet_slots())
    measures_.resize(mesh_.tet_slots() + mesh_.tet_slots() / 2);
  for (const TetId t : mesh_.added_ids()) measures_[t] = measure(t);
  if (crosses) ++counters_.crossings;
  return true;
}

bool Editor::in_sphere(TetCopy c, Point3 p) const {
  const TetMeasures& m = measures_[c.t];
  const Point3 q = mesh_.rotations().rotate(p, mesh_.subtract(0, c.e));
  return squared_distance(q, m.centre) < m.radius2 * (1 - kInSphereShare);
}

Editor::Walk Editor::walk(TetCopy from, Point3 p) const {
  Walk w;
  w.at = from;
  auto x = points(from);
  const Point3 start = 0.25 * (x[0] + x[1] + x[2] + x[3]);
  const Point3 way = p - start;
  std::uint32_t entered = 4;
  for (int step = 0; step < kMaxWalk; ++step) {
    // The straight way leaves through the face whose plane it meets first.
    std::uint32_t leave = 4;
    double first = std::numeric_limits<double>::infinity();
    for (std::uint32_t i = 0; i < 4; ++i) {
      if (i == entered) continue;
      const Point3 a = x[kFaceCorners[i][0]];
      const Point3 n = cross(x[kFaceCorners[i][1]] - a, x[kFaceCorners[i][2]] - a);
      const double along = dot(n, way);
      if (along <= 0) continue;
      const double at = dot(n, a - start) / along;
      // A point on a subfacet is not behind it, but must not be taken for one inside.
      const bool subfacet = mesh_.tet(w.at.t).facet[i] != kNoFacet;
      if (at < first && at < (subfacet ? 1 + kOnSubfacet : 1)) {
        first = at;
        leave = i;
      }
    }
    if (leave == 4) return w;
    const Tet& t = mesh_.tet(w.at.t);
    if (t.facet[leave] != kNoFacet) {
      w.blocked = true;
      w.face = leave;
      return w;
    }
    entered = face_of(t.nb[leave]);
    w.at = mesh_.neighbour(w.at, leave);
    x = points(w.at);
  }
  w.lost = true;
  return w;
}

CavityFace Editor::face_of_copy(TetCopy c, std::uint32_t i) const {
  CavityFace f;
  for (std::size_t j = 0; j < 3; ++j) {
    f.corners[j] = mesh_.corner(c, kFaceCorners[i][j]);
    f.points[j] = mesh_.lift(f.corners[j]);
  }
  f.facet = mesh_.tet(c.t).facet[i];
  f.region = mesh_.tet(c.t).region;
  return f;
}

bool Editor::contains(const Cavity& cavity, TetCopy c) const {
  const Tet& t = mesh_.tet(c.t);
  if (t.stamp != epoch_ || t.scratch < 0) return false;
  return point_on_axis_ || cavity.tets[static_cast<std::size_t>(t.scratch)].e == c.e;
}

void Editor::seed_cavity(Cavity& cavity) const {
  cavity.tets.clear();
  const Location& w = cavity.where;
  switch (w.kind) {
    case Location::Kind::kInside: cavity.tets.push_back(w.at); break;
    case Location::Kind::kOnSubfacet:
      cavity.tets.push_back(w.at);
      if (mesh_.tet(w.at.t).nb[w.face] != kNoHalfFace) {
        cavity.tets.push_back(mesh_.neighbour(w.at, w.face));
      }
      break;
    case Location::Kind::kOnEdge: mesh_.round_edge(w.at, w.edge[0], w.edge[1], cavity.tets); break;
  }
  cavity.seeds = cavity.tets.size();
}

void Editor::find_own_facets(const Cavity& cavity) {
  own_facets_.clear();
  const Location& w = cavity.where;
  if (w.kind == Location::Kind::kInside) return;
  if (w.kind == Location::Kind::kOnSubfacet) {
    own_facets_.push_back(mesh_.tet(w.at.t).facet[w.face]);
    return;
  }
  for (const TetCopy& c : cavity.tets) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      // Faces at the edge are those opposite the corners off it.
      const OrbitVertex x = mesh_.corner(c, i);
      const std::int32_t facet = mesh_.tet(c.t).facet[i];
      if (facet != kNoFacet && !(x == w.edge[0]) && !(x == w.edge[1])) own_facets_.push_back(facet);
    }
  }
}

// Whether the face lies in a facet that the point lies on, at the point's own copy of it.
bool Editor::in_own_plane(const Cavity& cavity, const CavityFace& face) const {
  if (std::find(own_facets_.begin(), own_facets_.end(), face.facet) == own_facets_.end()) {
    return false;
  }
  const Point3 p = cavity.point - face.points[0];
  const Point3 u = face.points[1] - face.points[0], v = face.points[2] - face.points[0];
  const Point3 n = cross(u, v);
  const double reach2 = std::max({dot(p, p), dot(u, u), dot(v, v)});
  const double height = dot(n, p);
  return height * height <= kCoplanarRelativeHeight * kCoplanarRelativeHeight * reach2 * dot(n, n);
}

bool Editor::turns_away(const Cavity& cavity, TetCopy c, std::uint32_t i) const {
  const auto& f = kFaceCorners[i];
  return is_flat(cavity.point, mesh_.lift(mesh_.corner(c, f[0])), mesh_.lift(mesh_.corner(c, f[1])),
                 mesh_.lift(mesh_.corner(c, f[2])), kMinRelativeVolume);
}

bool Editor::grow_cavity(Cavity& cavity, std::size_t most_hidden) {
  // Of a point on a facet or edge some that see it not may yet be divided with their facet, and where a
  // seed is hidden nothing but seeds will be left.
  bool counts = most_hidden != kAny && cavity.where.kind == Location::Kind::kInside;
  std::size_t hidden = 0;
  epoch_ = mesh_.new_epoch();
  for (std::size_t i = 0; i < cavity.tets.size(); ++i) {
    Tet& t = mesh_.tet(cavity.tets[i].t);
    t.stamp = epoch_;
    t.scratch = static_cast<std::int32_t>(i);
  }
  for (std::size_t at = 0; at < cavity.tets.size() && cavity.tets.size() < kMaxCavity; ++at) {
    const TetCopy c = cavity.tets[at];
    bool is_hidden = false;
    for (std::uint32_t i = 0; i < 4; ++i) {
      const Tet& t = mesh_.tet(c.t);
      if (t.nb[i] == kNoHalfFace) {
        is_hidden = is_hidden || (counts && turns_away(cavity, c, i));
        continue;
      }
      Tet& g = mesh_.tet(tet_of(t.nb[i]));
      if (g.stamp == epoch_) continue;
      const TetCopy n = mesh_.neighbour(c, i);
      const bool joins = t.facet[i] == kNoFacet
                             ? in_sphere(n, cavity.point)
                             : !own_facets_.empty() && in_own_plane(cavity, face_of_copy(c, i));
      if (!joins) {
        is_hidden = is_hidden || (counts && turns_away(cavity, c, i));
        continue;
      }
      g.stamp = epoch_;
      g.scratch = static_cast<std::int32_t>(cavity.tets.size());
      cavity.tets.push_back(n);
    }
    if (!is_hidden) continue;
    if (at < cavity.seeds) {
      counts = false;
    } else if (++hidden > most_hidden) {
      return false;
    }
  }
  return true;
}

std::int64_t Editor::gather_boundary(Cavity& cavity) {
  cavity.faces.clear();
  cavity.outline.clear();
  hidden_.clear();
  for (std::size_t at = 0; at < cavity.tets.size(); ++at) {
    const TetCopy c = cavity.tets[at];
    for (std::uint32_t i = 0; i < 4; ++i) {
      const Tet& t = mesh_.tet(c.t);
      const bool hull = t.nb[i] == kNoHalfFace;
      const bool inside = !hull && contains(cavity, mesh_.neighbour(c, i));
      if (inside && t.facet[i] == kNoFacet) continue;
      CavityFace face = face_of_copy(c, i);
      face.owner = static_cast<std::uint32_t>(at);
      if (t.facet[i] != kNoFacet && in_own_plane(cavity, face)) {
        // Divided anew; needs both sides where there are two.
        if (!hull && !inside) return static_cast<std::int64_t>(at);
        if (!hull) {
          const TetCopy g = mesh_.neighbour(c, i);
          const auto other = static_cast<std::size_t>(mesh_.tet(g.t).scratch);
          // A face between two members is met twice, or once where a member meets itself.
          if (other < at || (other == at && face_of(t.nb[i]) < i)) continue;
        }
        for (std::size_t j = 0; j < 3; ++j) {
          cavity.outline.push_back({face.corners[j], face.corners[(j + 1) % 3], face.facet,
                                    face.owner, face.points[(j + 2) % 3]});
        }
        continue;
      }
      if (inside) return static_cast<std::int64_t>(at);  // a subfacet with both sides inside
      if (is_flat(cavity.point, face.points[0], face.points[1], face.points[2],
                  kMinRelativeVolume)) {
        if (at < cavity.seeds) {
          flat_face_ = i;
          return static_cast<std::int64_t>(at);
        }
        // Whatever else goes, it has to: its face stays on the boundary.
        hidden_.push_back(at);
        continue;
      }
      cavity.faces.push_back(face);
    }
  }
  const std::int64_t unseen = reduce_outline(cavity);
  if (unseen != kFits) return unseen;
  return hidden_.empty() ? kFits : static_cast<std::int64_t>(hidden_.front());
}

// Copies of an edge round a point on the axis are one: the point is in all of their frames.
EdgeKey Editor::outline_name(OrbitVertex a, OrbitVertex b) const {
  if (point_on_axis_) return mesh_.edge_key(a, b);
  const bool ordered = a.orbit < b.orbit || (a.orbit == b.orbit && a.exponent < b.exponent);
  return ordered ? EdgeKey{a.orbit, b.orbit, a.exponent * mesh_.fold() + b.exponent}
                 : EdgeKey{b.orbit, a.orbit, b.exponent * mesh_.fold() + a.exponent};
}

// Edges between two of the subfacets go; those of the outline must be seen from the point's side,
// as the subfacet beside it sees them. Else a new subfacet would be laid across a gap, or outside.
// Subsegments bound, even between two subfacets; the edge that the point splits is bound to go.
std::int64_t Editor::reduce_outline(Cavity& cavity) {
  auto& outline = cavity.outline;
  if (outline.empty()) return kFits;
  const auto name = [&](const OutlineEdge& e) {
    const EdgeKey key = outline_name(e.a, e.b);
    return std::tuple(e.facet, key.a, key.b, key.exponent);
  };
  std::stable_sort(outline.begin(), outline.end(),
                   [&](const OutlineEdge& x, const OutlineEdge& y) { return name(x) < name(y); });
  const auto& split = cavity.where.edge;
  const bool splits = cavity.where.kind == Location::Kind::kOnEdge;
  const EdgeKey goes = splits ? outline_name(split[0], split[1]) : EdgeKey{};
  std::size_t kept = 0;
  for (std::size_t i = 0, next = 0; i < outline.size(); i = next) {
    while (next < outline.size() && name(outline[next]) == name(outline[i])) ++next;
    if (splits && outline_name(outline[i].a, outline[i].b) == goes) continue;
    const bool bounds = next - i == 1 || mesh_.segment_of(outline[i].a, outline[i].b) != kNoSegment;
    for (std::size_t j = i; bounds && j < next; ++j) outline[kept++] = outline[j];
  }
  outline.resize(kept);
  for (const OutlineEdge& e : outline) {
    if (is_seen(cavity.point, mesh_.lift(e.a), mesh_.lift(e.b), e.inner)) continue;
    if (e.owner < cavity.seeds) return e.owner;
    hidden_.push_back(e.owner);
  }
  return kFits;
}

// A vertex or subsegment of the cavity that its boundary lacks would vanish: names a tetrahedron
// that has it.
std::int64_t Editor::find_lost(Cavity& cavity) {
  marks_.resize(mesh_.vertex_slots());
  const std::uint32_t mark = ++mark_epoch_;
  for (const CavityFace& f : cavity.faces) {
    for (const OrbitVertex& x : f.corners)
      marks_[static_cast<std::size_t>(x.orbit)] = {mark, x.exponent};
  }
  const auto on_boundary = [&](OrbitVertex x) {
    const VertexMark& m = marks_[static_cast<std::size_t>(x.orbit)];
    if (m.epoch != mark) return false;
    if (m.k == x.exponent) return true;
    // The last copy to be marked hides the others.
    for (const CavityFace& f : cavity.faces) {
      if (f.corners[0] == x || f.corners[1] == x || f.corners[2] == x) return true;
    }
    return false;
  };
  const auto has_edge = [&](OrbitVertex x, OrbitVertex y) {
    for (const CavityFace& f : cavity.faces) {
      const auto has = [&](OrbitVertex z) {
        return f.corners[0] == z || f.corners[1] == z || f.corners[2] == z;
      };
      if (has(x) && has(y)) return true;
    }
    return false;
  };
  const bool split = cavity.where.kind == Location::Kind::kOnEdge;
  const EdgeKey splits =
      split ? mesh_.edge_key(cavity.where.edge[0], cavity.where.edge[1]) : EdgeKey{};
  // From the far end: the seeds come first and must stay.
  for (std::size_t at = cavity.tets.size(); at-- > 0;) {
    const TetCopy c = cavity.tets[at];
    std::array<OrbitVertex, 4> x;
    bool all_on_boundary = true;
    int constrained = 0;
    for (std::uint32_t i = 0; i < 4; ++i) {
      x[i] = mesh_.corner(c, i);
      constrained += mesh_.kind(x[i].orbit) <= VertexKind::kSegment ? 1 : 0;
      all_on_boundary = all_on_boundary && on_boundary(x[i]);
    }
    if (!all_on_boundary) {
      // On the axis the copies of one period stand for all.
      if (!point_on_axis_) return static_cast<std::int64_t>(at);
    }
    if (constrained < 2) continue;
    for (const auto& e : kEdgeCorners) {
      if (mesh_.segment_of(x[e[0]], x[e[1]]) == kNoSegment) continue;
      if (split && mesh_.edge_key(x[e[0]], x[e[1]]) == splits) continue;
      if (!has_edge(x[e[0]], x[e[1]]) && !point_on_axis_) return static_cast<std::int64_t>(at);
    }
  }
  return kFits;
}

void Editor::drop(Cavity& cavity, std::span<const std::size_t> indices) {
  // Those that are no longer connected to the seeds go with them.
  for (const std::size_t i : indices) mesh_.tet(cavity.tets[i].t).scratch = -1;
  keep_.assign(cavity.tets.size(), 0);
  todo_.clear();
  for (std::size_t i = 0; i < cavity.seeds; ++i) {
    keep_[i] = 1;
    todo_.push_back(i);
  }
  while (!todo_.empty()) {
    const TetCopy c = cavity.tets[todo_.back()];
    todo_.pop_back();
    for (std::uint32_t i = 0; i < 4; ++i) {
      if (mesh_.tet(c.t).nb[i] == kNoHalfFace) continue;
      const TetCopy n = mesh_.neighbour(c, i);
      if (!contains(cavity, n)) continue;
      const auto j = static_cast<std::size_t>(mesh_.tet(n.t).scratch);
      if (keep_[j] != 0) continue;
      keep_[j] = 1;
      todo_.push_back(j);
    }
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < cavity.tets.size(); ++i) {
    Tet& t = mesh_.tet(cavity.tets[i].t);
    if (keep_[i] == 0) {
      t.scratch = -1;
      continue;
    }
    t.scratch = static_cast<std::int32_t>(kept);
    cavity.tets[kept++] = cavity.tets[i];
  }
  cavity.tets.resize(kept);
}

// A point on a face of a seed needs the tetrahedron on the other side as well.
bool Editor::add_seed(Cavity& cavity, std::size_t index) {
  const TetCopy c = cavity.tets[index];
  if (flat_face_ == 4 || cavity.seeds >= kMaxSeeds) return false;
  const Tet& t = mesh_.tet(c.t);
  if (t.facet[flat_face_] != kNoFacet || t.nb[flat_face_] == kNoHalfFace) return false;
  const TetCopy n = mesh_.neighbour(c, flat_face_);
  Tet& g = mesh_.tet(n.t);
  if (g.stamp == epoch_ && g.scratch >= 0) return false;  // in the cavity as another copy
  g.stamp = epoch_;
  g.scratch = static_cast<std::int32_t>(cavity.tets.size());
  cavity.tets.push_back(n);
  ++cavity.seeds;
  return true;
}

bool Editor::find_cavity(Point3 p, const Location& where, Cavity& cavity, std::size_t most_hidden) {
  cavity.point = p;
  cavity.where = where;
  point_on_axis_ = where.kind == Location::Kind::kOnEdge && mesh_.on_axis(where.edge[0].orbit) &&
                   mesh_.on_axis(where.edge[1].orbit);
  seed_cavity(cavity);
  find_own_facets(cavity);
  if (!grow_cavity(cavity, most_hidden)) return false;
  std::size_t hidden = 0;
  while (true) {
    flat_face_ = 4;
    std::int64_t bad = gather_boundary(cavity);
    if (bad == kFits) bad = find_lost(cavity);
    if (bad == kFits) break;
    if (static_cast<std::size_t>(bad) < cavity.seeds) {
      // A seed cannot go: start again with nothing but seeds.
      if (cavity.tets.size() == cavity.seeds) {
        if (!add_seed(cavity, static_cast<std::size_t>(bad))) return false;
        continue;
      }
      while (cavity.tets.size() > cavity.seeds) {
        mesh_.tet(cavity.tets.back().t).scratch = -1;
        cavity.tets.pop_back();
      }
      continue;
    }
    if (hidden_.empty()) hidden_.push_back(static_cast<std::size_t>(bad));
    hidden += hidden_.size();
    if (hidden > most_hidden) return false;
    drop(cavity, hidden_);
  }
  double nearest2 = std::numeric_limits<double>::infinity();
  for (const CavityFace& f : cavity.faces) {
    for (const Point3& x : f.points) nearest2 = std::min(nearest2, squared_distance(x, p));
  }
  cavity.nearest2 = nearest2;
  return true;
}

VertexId Editor::insert(const Cavity& cavity, VertexKind kind, std::int32_t parent, bool on_axis) {
  const VertexId p = mesh_.add_vertex(cavity.point, kind, on_axis, parent);
  const bool split = cavity.where.kind == Location::Kind::kOnEdge;
  const auto& edge = cavity.where.edge;
  const std::int32_t segment = split ? mesh_.segment_of(edge[0], edge[1]) : kNoSegment;
  if (segment != kNoSegment && mesh_.pinched(edge[0].orbit) && mesh_.pinched(edge[1].orbit)) {
    mesh_.set_pinched(p);
  }
  const auto facet_at = [&](OrbitVertex a, OrbitVertex b) {
    const EdgeKey name = outline_name(a, b);
    for (const OutlineEdge& e : cavity.outline) {
      if (outline_name(e.a, e.b) == name) return e.facet;
    }
    return kNoFacet;
  };
  new_tets_.clear();
  for (const CavityFace& f : cavity.faces) {
    NewTet t;
    t.c[0] = {p, 0};
    for (std::size_t j = 0; j < 3; ++j) t.c[j + 1] = f.corners[j];
    t.region = f.region;
    t.facet[0] = f.facet;
    if (!cavity.outline.empty()) {
      // Face i is opposite corner i: it holds p and the two other corners.
      t.facet[1] = facet_at(f.corners[1], f.corners[2]);
      t.facet[2] = facet_at(f.corners[0], f.corners[2]);
      t.facet[3] = facet_at(f.corners[0], f.corners[1]);
    }
    new_tets_.push_back(t);
  }
  std::array<EdgeKey, 3> halves;
  if (segment != kNoSegment) {
    halves = {mesh_.edge_key(edge[0], edge[1]), mesh_.edge_key(edge[0], {p, 0}),
              mesh_.edge_key({p, 0}, edge[1])};
  }
  const std::size_t changed = segment != kNoSegment ? halves.size() : 0;
  if (!replace(cavity.tets, new_tets_, {halves.data(), changed})) {
    mesh_.release_vertex(p);
    return kNoVertex;
  }
  if (segment != kNoSegment) {
    mesh_.set_segment(halves[0], kNoSegment);
    mesh_.set_segment(halves[1], segment);
    mesh_.set_segment(halves[2], segment);
  }
  ++counters_.insertions;
  return p;
}

}  // namespace symcell::solid
