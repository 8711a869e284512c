#include "core/solid/groups/curve_boundary.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <utility>

#include "core/base/index.hpp"
#include "core/cell/edge_orbit.hpp"
#include "core/geometry/quadratic_tet.hpp"
#include "core/geometry/tet_measures.hpp"
#include "core/guard/check_curved.hpp"

namespace symcell::solid {
namespace {

// Where a facet is looked up, in shares of its corners, until its group is met.
constexpr std::array<std::array<double, 3>, 4> kPlaces = {
    {{1.0 / 3, 1.0 / 3, 1.0 / 3}, {0.6, 0.2, 0.2}, {0.2, 0.6, 0.2}, {0.2, 0.2, 0.6}}};
// Projections onto several surfaces in turn converge by the square of the cosine of their angle.
constexpr int kMostProjections = 60;
// Of the length that is looked at: two surfaces are both met.
constexpr double kMet = 1e-9;
// Where surfaces touch, as a plane and the fillet beside it, they are not met as one; that they are a
// tenth as far as they were is enough.
constexpr double kNearer = 0.1;
// Of how far vertices may be moved, which is a thousandth of the diameter as a rule: what is so near is on it.
constexpr double kRounding = 1e-6;
// A star may lose so much of its worst dihedral's sine, and all that is above that of 20 degrees.
constexpr double kKeptSine = 0.7;
constexpr double kGoodSine = 0.34;
// Vertices that a neighbour was in the way of are tried again.
constexpr int kPasses = 4;
// The last passes may exceed the bound on the ratio by so much, squared: better a few tetrahedra a little over
// it than vertices beside their faces.
constexpr int kKindPasses = 2;
constexpr double kRatioExcess2 = 1.2 * 1.2;
// A mid-side node on an arc of 60 degrees lies beside its chord by 0.13 of its length.
constexpr double kMostBeside = 0.15;
// Of six volumes: no Jacobian is less, so that solvers do well with what is curved.
constexpr double kLeastJacobian = 0.1;
// Cosine: copies of a face look the same way to 5 degrees.
constexpr double kSameWay = 0.996;
// Limits are looked at every so many entities.
constexpr std::size_t kCheckedEach = 1024;

bool is_finite(Point3 p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

// Elements that have a copy of each orbit.
class Stars {
 public:
  explicit Stars(const SymmetryCellMesh& cell) : first_(cell.orbit_points.size() + 1, 0) {
    for (const std::int32_t n : cell.elements) ++first_[at(cell.nodes[at(n)].orbit) + 1];
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    elements_.resize(cell.elements.size());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i < cell.elements.size(); ++i) {
      elements_[next[at(cell.nodes[at(cell.elements[i])].orbit)]++] = i / 4;
    }
  }
  [[nodiscard]] std::span<const std::size_t> of(std::int32_t orbit) const {
    return std::span(elements_).subspan(first_[at(orbit)],
                                        first_[at(orbit) + 1] - first_[at(orbit)]);
  }

 private:
  std::vector<std::size_t> first_;
  std::vector<std::size_t> elements_;
};

std::array<Point3, 4> corners_of(const SymmetryCellMesh& cell,
                                 const RotationTable& rotations,
                                 std::size_t element) {
  std::array<Point3, 4> p;
  for (std::size_t i = 0; i < 4; ++i) {
    const OrbitVertex v = cell.nodes[at(cell.elements[4 * element + i])];
    p[i] = rotations.rotate(cell.orbit_points[at(v.orbit)], v.exponent);
  }
  return p;
}

}  // namespace

CurvedBoundary::CurvedBoundary(const FaceGroups& groups,
                               const TriangleTree& tree,
                               const SymmetryCellMesh& cell,
                               const CurvingBounds& bounds)
    : groups_(groups), tree_(tree), bounds_(bounds), rotations_(cell.fold) {
  piece_.reserve(cell.facet_count());
  for (std::size_t b = 0; b < cell.facet_count(); ++b) piece_.push_back(piece_of_facet(cell, b));
}

void CurvedBoundary::count_faces(const SymmetryCellMesh& cell, Curving& counts) const {
  std::map<std::int32_t, bool> known;
  for (std::size_t b = 0; b < cell.facet_count(); ++b) {
    bool& one = known[cell.boundary_markers[b]];
    one = one || piece_[b] >= 0;
  }
  for (const auto& [marker, one] : known) ++(one ? counts.faces : counts.other_faces);
}

std::int32_t CurvedBoundary::piece_of_facet(const SymmetryCellMesh& cell, std::size_t facet) const {
  const std::int32_t marker = cell.boundary_markers[facet];
  if (marker == 0) return -1;
  std::array<Point3, 3> p;
  for (std::size_t i = 0; i < 3; ++i) {
    const OrbitVertex v = cell.nodes[at(cell.boundary[3 * facet + i])];
    p[i] = rotations_.rotate(cell.orbit_points[at(v.orbit)], v.exponent);
  }
  std::int32_t last = -1;
  for (const auto& w : kPlaces) {
    const Point3 place = w[0] * p[0] + w[1] * p[1] + w[2] * p[2];
    last = tree_.nearest(place, std::numeric_limits<double>::max(), last).triangle;
    if (last < 0 || groups_.of_triangle[at(last)] != marker) continue;
    const std::int32_t piece = groups_.piece_of_triangle[at(last)];
    return groups_.piece_fits[at(piece)].kind == FaceKind::kSurface ? -1 : piece;
  }
  return -1;
}

// p stands where the copy 0 of an orbit does.
Point3 CurvedBoundary::onto(const Constraint& c, Point3 p) const {
  const Point3 there =
      project_onto(groups_.piece_fits[at(c.piece)], rotations_.rotate(p, c.exponent));
  return rotations_.rotate(there, rotations_.subtract(0, c.exponent));
}

Point3 CurvedBoundary::normal(const Constraint& c, Point3 p) const {
  const Point3 there = normal_at(groups_.piece_fits[at(c.piece)], rotations_.rotate(p, c.exponent));
  return rotations_.rotate(there, rotations_.subtract(0, c.exponent));
}

// Copies of one face on both sides of a bound count once: their fits are the same but for rounding and
// the tolerance. Copies that meet, as the sides of a nut, look different ways.
void CurvedBoundary::add(std::vector<Constraint>& constraints, Constraint c, Point3 p) const {
  const bool known = std::any_of(constraints.begin(), constraints.end(), [&](const Constraint& o) {
    return o == c || (groups_.class_of_piece[at(o.piece)] == groups_.class_of_piece[at(c.piece)] &&
                      dot(normal(o, p), normal(c, p)) >= kSameWay);
  });
  if (!known) constraints.push_back(c);
}

bool CurvedBoundary::is_curved(const std::vector<Constraint>& constraints) const {
  return std::any_of(constraints.begin(), constraints.end(), [&](const Constraint& c) {
    return groups_.piece_fits[at(c.piece)].kind != FaceKind::kPlane;
  });
}

CurvedBoundary::Projected CurvedBoundary::project(const std::vector<Constraint>& constraints,
                                                  Point3 p) const {
  const auto worst = [&](Point3 q) {
    double off = 0;
    for (const Constraint& c : constraints) off = std::max(off, distance(q, onto(c, q)));
    return off;
  };
  const double before = worst(p);
  Point3 q = p;
  for (int i = 0; i < kMostProjections; ++i) {
    const Point3 last = q;
    for (const Constraint& c : constraints) q = onto(c, q);
    if (!is_finite(q)) return {p, false};
    if (constraints.size() == 1 || distance(last, q) <= kMet * before) break;
  }
  return {q, worst(q) <= std::max(kNearer * before, kRounding * bounds_.farthest)};
}

Result<void> CurvedBoundary::move_vertices(SymmetryCellMesh& cell,
                                           Curving& counts,
                                           ExecutionContext& context) const {
  std::vector<std::vector<Constraint>> of_orbit(cell.orbit_points.size());
  for (std::size_t b = 0; b < cell.facet_count(); ++b) {
    if (piece_[b] < 0) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const OrbitVertex v = cell.nodes[at(cell.boundary[3 * b + i])];
      add(of_orbit[at(v.orbit)], {piece_[b], v.exponent}, cell.orbit_points[at(v.orbit)]);
    }
  }
  const Stars stars(cell);
  const auto is_kept = [&](const std::array<Point3, 4>& old, std::size_t element, bool kind) {
    const std::array<Point3, 4> p = corners_of(cell, rotations_, element);
    const double sine = min_dihedral_sine(p[0], p[1], p[2], p[3]);
    const double sine_before = min_dihedral_sine(old[0], old[1], old[2], old[3]);
    if (!(sine >= std::min(kGoodSine, kKeptSine * sine_before))) return false;
    const TetMeasures m = measure_tet(p[0], p[1], p[2], p[3]);
    const TetMeasures before = measure_tet(old[0], old[1], old[2], old[3]);
    const double most_ratio2 =
        (kind ? kRatioExcess2 : 1) * bounds_.radius_edge * bounds_.radius_edge;
    if (m.ratio2() > std::max(most_ratio2, before.ratio2())) return false;
    if (m.volume > std::max(bounds_.max_volume, before.volume)) return false;
    double longest = bounds_.max_edge;
    if (bounds_.sizes != nullptr) longest = std::min(longest, bounds_.sizes->max_edge(m.middle));
    return m.longest2 <= std::max(longest * longest, before.longest2);
  };
  std::vector<std::int32_t> open;
  for (std::size_t v = 0; v < of_orbit.size(); ++v) {
    if (is_curved(of_orbit[v])) open.push_back(static_cast<std::int32_t>(v));
  }
  std::vector<std::array<Point3, 4>> old;
  for (int pass = 0; pass < kPasses && !open.empty(); ++pass) {
    std::vector<std::int32_t> left;
    for (std::size_t i = 0; i < open.size(); ++i) {
      if (i % kCheckedEach == 0) {
        SYMCELL_TRY(context.check());
      }
      const std::int32_t v = open[i];
      const Point3 from = cell.orbit_points[at(v)];
      Projected to = project(of_orbit[at(v)], from);
      const bool axis = cell.on_axis[at(v)] != 0;
      if (axis) to.place.x = to.place.y = 0;
      const double way = distance(from, to.place);
      if (!to.valid || way > bounds_.farthest) {
        left.push_back(v);
        continue;
      }
      if (way == 0) continue;
      old.clear();
      for (const std::size_t e : stars.of(v)) old.push_back(corners_of(cell, rotations_, e));
      cell.orbit_points[at(v)] = to.place;
      const auto star = stars.of(v);
      bool kept = true;
      for (std::size_t j = 0; j < star.size() && kept; ++j) {
        kept = is_kept(old[j], star[j], pass >= kPasses - kKindPasses);
      }
      if (kept) {
        ++counts.vertices;
        counts.farthest = std::max(counts.farthest, way);
      } else {
        cell.orbit_points[at(v)] = from;
        left.push_back(v);
      }
    }
    open = std::move(left);
  }
  counts.left += open.size();
  return {};
}

Result<SymmetryCellMesh> CurvedBoundary::elevate(const SymmetryCellMesh& cell,
                                                 Curving& counts,
                                                 ExecutionContext& context) const {
  // Surfaces at each edge, as copy 0 of it sees them, and one of its places in the cell.
  struct Side {
    std::vector<Constraint> constraints;
    std::int32_t a = 0, b = 0;  // nodes
    std::int32_t turn = 0;
    bool known = true;  // all facets at it are of a known kind
  };
  std::map<EdgeOrbit, Side> edges;
  for (std::size_t f = 0; f < cell.facet_count(); ++f) {
    if (f % kCheckedEach == 0) {
      SYMCELL_TRY(context.check());
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t a = cell.boundary[3 * f + i], b = cell.boundary[3 * f + (i + 1) % 3];
      const TurnedEdge edge = turned_edge(cell, rotations_, cell.nodes[at(a)], cell.nodes[at(b)]);
      const auto [found, fresh] = edges.try_emplace(edge.key);
      Side& side = found->second;
      if (fresh) {
        side.a = a;
        side.b = b;
        side.turn = edge.turn;
      }
      if (piece_[f] < 0) {
        side.known = false;
      } else {
        const Point3 p = rotations_.rotate(cell.orbit_points[at(cell.nodes[at(a)].orbit)],
                                           cell.nodes[at(a)].exponent);
        const Point3 q = rotations_.rotate(cell.orbit_points[at(cell.nodes[at(b)].orbit)],
                                           cell.nodes[at(b)].exponent);
        add(side.constraints, {piece_[f], edge.turn},
            rotations_.rotate(0.5 * (p + q), rotations_.subtract(0, edge.turn)));
      }
    }
  }
  std::vector<CurvedSide> sides;
  for (const auto& edge : edges) {
    const auto& side = edge.second;
    if (!is_curved(side.constraints)) continue;
    const auto place = [&](std::int32_t n) {
      const OrbitVertex v = cell.nodes[at(n)];
      return rotations_.rotate(cell.orbit_points[at(v.orbit)],
                               rotations_.subtract(v.exponent, side.turn));
    };
    const Point3 p = place(side.a), q = place(side.b);
    const double size = distance(p, q);
    const Point3 middle = 0.5 * (p + q);
    // An end that had to stay beside the faces takes its side along.
    const Projected to = project(side.constraints, middle);
    const Projected to_p = project(side.constraints, p), to_q = project(side.constraints, q);
    const Point3 place_of_middle = to.place - 0.5 * ((to_p.place - p) + (to_q.place - q));
    if (!to.valid || !to_p.valid || !to_q.valid ||
        distance(place_of_middle, middle) > kMostBeside * size) {
      ++counts.straightened;
      continue;
    }
    sides.push_back({side.a, side.b, rotations_.rotate(place_of_middle, side.turn)});
  }
  for (;;) {
    SYMCELL_TRY(context.check());
    SymmetryCellMesh elevated = elevate_to_quadratic(cell, sides);
    const std::vector<std::size_t> folded = folded_tetrahedra(elevated, kLeastJacobian);
    if (folded.empty()) {
      counts.sides += sides.size();
      return elevated;
    }
    // Sides of folded elements are straight from now on: with none left nothing is folded.
    std::vector<EdgeOrbit> straight;
    for (const std::size_t e : folded) {
      for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = i + 1; j < 4; ++j) {
          straight.push_back(turned_edge(cell, rotations_, cell.nodes[at(cell.elements[4 * e + i])],
                                         cell.nodes[at(cell.elements[4 * e + j])])
                                 .key);
        }
      }
    }
    std::sort(straight.begin(), straight.end());
    const std::size_t before = sides.size();
    std::erase_if(sides, [&](const CurvedSide& s) {
      const EdgeOrbit key =
          turned_edge(cell, rotations_, cell.nodes[at(s.a)], cell.nodes[at(s.b)]).key;
      return std::binary_search(straight.begin(), straight.end(), key);
    });
    counts.straightened += before - sides.size();
    if (sides.size() == before) {
      return fail(ErrorCode::kInternal, "a quadratic tetrahedron with straight sides is folded");
    }
  }
}

}  // namespace symcell::solid
