#include "core/solid/quotient/edge_turns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/base/index.hpp"

namespace symcell::solid {
namespace {

// Angles that are summed up make a multiple of the full turn, up to rounding; only the multiple is
// asked for.
constexpr double kTurnSlack = 0.01;
// Signs this near to zero, relative to the lengths they are made of, are left to the sum of the
// angles: the rounding of such a product is smaller by some powers of ten.
constexpr double kNearPlane = 1e-10;

// Rounding of products of two differences of coordinates and of their sums, relative to the largest
// coordinate and the largest difference: some tens of them, to 2^-53 each.
constexpr double kProductRounding = 256 * 0x1p-53;
// Any direction will do that lies in no face; of faces of models this one does hardly ever.
constexpr Point3 kDirection{0.37170815, 0.58231963, 0.72305917};

constexpr std::uint32_t kEdgeOf[4][4] = {{0, 0, 1, 2}, {0, 0, 3, 4}, {1, 3, 0, 5}, {2, 4, 5, 0}};

// The other two corners of edge e of a tetrahedron.
constexpr std::uint32_t kOffEdge[6][2] = {{2, 3}, {1, 3}, {1, 2}, {0, 3}, {0, 2}, {0, 1}};

// Corners a, b, c, d of a positive tetrahedron in their order: whether they are positive too.
constexpr bool is_even(const std::array<std::uint32_t, 4>& order) {
  bool even = true;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j) even = even == (order[i] < order[j]);
  }
  return even;
}

class TurnChecker {
 public:
  explicit TurnChecker(const QuotientTetrahedralization& mesh)
      : mesh_(mesh), done_(mesh.tet_slots(), 0), times_(mesh.vertex_slots(), 0) {}

  std::optional<LocalEdge> run() {
    cover_directions();
    for (TetId t = 0; t < mesh_.tet_slots(); ++t) {
      if (!mesh_.alive(t)) continue;
      const Tet& tet = mesh_.tet(t);
      for (std::uint32_t e = 0; e < 6; ++e) {
        if ((done_[t] >> e & 1) != 0) continue;
        // One end that is covered once is enough.
        if (times_[at(tet.v[kEdgeCorners[e][0]])] == 1) continue;
        if (times_[at(tet.v[kEdgeCorners[e][1]])] == 1) continue;
        if (!turns_once(t, e)) return LocalEdge{t, e};
      }
    }
    return std::nullopt;
  }

 private:
  static constexpr std::uint8_t kUnknown = 255;

  // The tetrahedra at a vertex inside, seen from it, are triangles on the sphere of directions, all
  // turned the same way, and each side has a triangle on both sides: they cover all directions
  // equally often. Where one direction is covered once, all are, and each edge at the vertex has
  // one turn. Round the others (of the hull, on the axis, with the direction in a face but for
  // rounding) the edges are walked.
  void cover_directions() {
    for (std::size_t v = 0; v < times_.size(); ++v) {
      const Point3 p = mesh_.point(static_cast<VertexId>(v));
      reach_ = std::max({reach_, std::abs(p.x) + std::abs(p.y), std::abs(p.z)});
      if (mesh_.on_axis(static_cast<VertexId>(v))) times_[v] = kUnknown;
    }
    for (TetId t = 0; t < mesh_.tet_slots(); ++t) {
      if (!mesh_.alive(t)) continue;
      const Tet& tet = mesh_.tet(t);
      for (std::uint32_t i = 0; i < 4; ++i) {
        if (tet.nb[i] != kNoHalfFace) continue;
        for (const std::uint32_t c : kFaceCorners[i]) times_[at(tet.v[c])] = kUnknown;
      }
    }
    for (TetId t = 0; t < mesh_.tet_slots(); ++t) {
      if (mesh_.alive(t)) cover_directions_of(t);
    }
  }

  void cover_directions_of(TetId t) {
    const Tet& tet = mesh_.tet(t);
    std::int32_t frame = -1;  // of all corners off the axis; -2: they differ
    for (std::uint32_t i = 0; i < 4; ++i) {
      if (mesh_.on_axis(tet.v[i])) continue;
      if (frame == -1) frame = tet.k[i];
      if (frame != tet.k[i]) frame = -2;
    }
    const auto count = [&](std::uint32_t i, bool certain) {
      std::uint8_t& times = times_[at(tet.v[i])];
      if (!certain || times >= kUnknown - 1) {
        times = kUnknown;
      } else {
        ++times;
      }
    };
    std::array<Point3, 4> p;
    if (frame != -2) {
      for (std::uint32_t i = 0; i < 4; ++i) p[i] = mesh_.point(tet.v[i]);
      bool certain = true;
      const std::uint32_t corner = corner_towards(p, certain);
      for (std::uint32_t i = 0; i < 4; ++i) {
        if (i == corner || !certain) count(i, certain);
      }
      return;
    }
    // In the frame of each corner in turn.
    for (std::uint32_t i = 0; i < 4; ++i) {
      if (times_[at(tet.v[i])] == kUnknown) continue;
      for (std::uint32_t j = 0; j < 4; ++j) {
        p[j] = mesh_.lift(tet.v[j], mesh_.shift(tet.v[j], tet.k[j], mesh_.subtract(0, tet.k[i])));
      }
      bool certain = true;
      const std::uint32_t corner = corner_towards(p, certain);
      if (i == corner || !certain) count(i, certain);
    }
  }

  // The corner from which the direction goes into the tetrahedron, 4: none.
  [[nodiscard]] std::uint32_t corner_towards(const std::array<Point3, 4>& p, bool& certain) const {
    const Point3 x = p[1] - p[0], y = p[2] - p[0], z = p[3] - p[0];
    // How steeply it goes inwards through each face, times twice its area.
    std::array<double, 4> in{0, dot(cross(y, z), kDirection), dot(cross(z, x), kDirection),
                             dot(cross(x, y), kDirection)};
    in[0] = -(in[1] + in[2] + in[3]);
    const auto size = [](Point3 a) { return std::abs(a.x) + std::abs(a.y) + std::abs(a.z); };
    const double doubt = kProductRounding * reach_ * std::max({size(x), size(y), size(z)});
    std::uint32_t corner = 4, outwards = 0;
    for (std::uint32_t i = 0; i < 4; ++i) {
      certain = certain && std::abs(in[i]) > doubt;
      if (in[i] > 0) continue;
      corner = i;
      ++outwards;
    }
    return outwards == 1 ? corner : 4;
  }

  // A tetrahedron at the edge. It is left through the face opposite `behind`, which has the edge's
  // ends and `ahead`.
  struct Place {
    TetCopy copy;
    std::uint32_t a, b, behind, ahead;
  };

  [[nodiscard]] bool is(TetCopy c, std::uint32_t i, OrbitVertex v) const {
    const Tet& t = mesh_.tet(c.t);
    return t.v[i] == v.orbit && mesh_.shift(v.orbit, t.k[i], c.e) == v.exponent;
  }
  // From the edge's first end.
  [[nodiscard]] Point3 way_to(TetCopy c, std::uint32_t i) const {
    return mesh_.lift(mesh_.corner(c, i)) - from_;
  }
  void mark(const Place& at) {
    std::uint8_t& done = done_[at.copy.t];
    done = static_cast<std::uint8_t>(done | 1U << kEdgeOf[at.a][at.b]);
  }

  // On to the next tetrahedron round the edge; false: there is none.
  [[nodiscard]] bool step(Place& at) const {
    const HalfFace g = mesh_.tet(at.copy.t).nb[at.behind];
    if (g == kNoHalfFace) return false;
    at.copy = mesh_.neighbour(at.copy, at.behind);
    at.ahead = face_of(g);
    // The other three are the ends and what was ahead.
    const std::uint32_t* rest = kFaceCorners[at.ahead];
    std::uint32_t i = 0;
    while (i < 2 && !is(at.copy, rest[i], a_)) ++i;
    at.a = rest[i];
    const std::uint32_t p = rest[(i + 1) % 3], q = rest[(i + 2) % 3];
    const bool p_is_b = is(at.copy, p, b_);
    at.b = p_is_b ? p : q;
    at.behind = p_is_b ? q : p;
    return true;
  }

  [[nodiscard]] bool turns_once(TetId t, std::uint32_t e) {
    const Place start{
        {t, 0}, kEdgeCorners[e][0], kEdgeCorners[e][1], kOffEdge[e][0], kOffEdge[e][1]};
    a_ = mesh_.corner(t, start.a);
    b_ = mesh_.corner(t, start.b);
    mark(start);
    if (mesh_.on_axis(a_.orbit) && mesh_.on_axis(b_.orbit)) return adds_up(start);
    from_ = mesh_.lift(a_);
    along_ = mesh_.lift(b_) - from_;
    // Each tetrahedron turns by less than half a turn, all the same way, so a closed ring passes
    // from below to above a plane through the edge once a turn, and as often back; signs of a
    // vertex are the same in both of its tetrahedra, whatever their rounding.
    const Point3 first = way_to(start.copy, start.behind), second = way_to(start.copy, start.ahead);
    const Point3 up = cross(along_, first + second);
    bool below = dot(up, second) < 0;
    int passes = dot(up, first) < 0 && !below ? 1 : 0;
    Place at = start;
    for (;;) {
      if (!step(at)) return stays_below_a_turn(at);
      if (at.copy == start.copy) break;
      mark(at);
      const bool next_below = dot(up, way_to(at.copy, at.ahead)) < 0;
      passes += below && !next_below ? 1 : 0;
      below = next_below;
    }
    return passes == 1 || adds_up(start);
  }

  // At an end of an open ring: back to the other end, without coming to the first face again.
  [[nodiscard]] bool stays_below_a_turn(Place at) {
    const Place end = at;
    std::swap(at.behind, at.ahead);
    const Point3 first = way_to(at.copy, at.behind);
    // Positive on the first half turn.
    const bool even = is_even({at.a, at.b, at.behind, at.ahead});
    const Point3 up = even ? cross(along_, first) : cross(first, along_);
    const double near2 = kNearPlane * kNearPlane * squared_length(along_) * squared_length(first);
    bool below = false;
    mark(at);
    while (step(at)) {
      mark(at);
      const Point3 way = way_to(at.copy, at.ahead);
      const double height = dot(up, way);
      const bool near = height * height <= near2 * squared_length(way) && on_side_of(first, way);
      if (near || (below && height >= 0)) return adds_up(end);
      below = height < 0;
    }
    return true;
  }

  // Whether two directions, seen along the edge, differ by less than a quarter turn.
  [[nodiscard]] bool on_side_of(Point3 p, Point3 q) const {
    return dot(along_, along_) * dot(p, q) > dot(along_, p) * dot(along_, q);
  }

  // An open ring stays below a turn, one about the axis makes the sector's angle. Slow, and right
  // where signs are in doubt.
  [[nodiscard]] bool adds_up(const Place& place) {
    ring_.clear();
    const bool closed = mesh_.ring(place.copy, a_, b_, ring_);
    double sum = 0;
    for (const TetCopy& c : ring_) {
      for (std::uint32_t e = 0; e < 6; ++e) {
        const std::uint32_t i = kEdgeCorners[e][0], j = kEdgeCorners[e][1];
        if (!(is(c, i, a_) && is(c, j, b_)) && !(is(c, i, b_) && is(c, j, a_))) continue;
        done_[c.t] = static_cast<std::uint8_t>(done_[c.t] | 1U << e);
        sum += dihedral(c.t, e);
        break;
      }
    }
    const bool axis = mesh_.on_axis(a_.orbit) && mesh_.on_axis(b_.orbit);
    const double turn = 2 * std::numbers::pi / (axis ? static_cast<double>(mesh_.fold()) : 1.0);
    return closed ? std::abs(sum - turn) < kTurnSlack * turn : sum < (1 + kTurnSlack) * turn;
  }

  // Interior angle of the tetrahedron at its edge e.
  [[nodiscard]] double dihedral(TetId t, std::uint32_t e) const {
    const Point3 a = mesh_.corner_point(t, kEdgeCorners[e][0]);
    const Point3 axis = mesh_.corner_point(t, kEdgeCorners[e][1]) - a;
    const Point3 p = cross(axis, mesh_.corner_point(t, kOffEdge[e][0]) - a);
    const Point3 q = cross(axis, mesh_.corner_point(t, kOffEdge[e][1]) - a);
    return std::atan2(length(cross(p, q)), dot(p, q));
  }

  const QuotientTetrahedralization& mesh_;
  std::vector<std::uint8_t> done_;   // per tetrahedron a bit an edge
  std::vector<std::uint8_t> times_;  // per vertex: how often one direction is covered; kUnknown
  double reach_ = 0;                 // no coordinate is larger, in any sector
  OrbitVertex a_, b_;  // ends of the edge looked at, in the frame of the first tetrahedron
  Point3 from_, along_;
  std::vector<TetCopy> ring_;
};

}  // namespace

std::optional<LocalEdge> find_wrong_turn(const QuotientTetrahedralization& mesh) {
  return TurnChecker(mesh).run();
}

}  // namespace symcell::solid
