// The quotient mesh: one triangle per orbit under C_n, flat arrays, neighbours with exponents.
//
// A vertex id names an orbit; its representative is `point(v)`, relative to the centre. A corner is
// (orbit, exponent k) and lies at rotation^k(point). A triangle is stored in one frame (its gauge);
// "the triangle at exponent e" is the stored one rotated by e.
//
//                 v[0]                 Edge j is opposite corner j and runs from corner j+1 to j+2,
//                /    \                counter-clockwise. Half-edge id: 3 * triangle + j.
//        edge 2 /      \ edge 1        nb[j]: the half-edge on the other side, kNone outside.
//              /        \              off[j]: the neighbour at exponent off[j] touches this
//           v[1] ------ v[2]           triangle at exponent 0.
//                edge 0
//
// Invariants (validate.hpp checks them):
// - nb is an involution and off[g] = -off[h] for g = nb[h];
// - corners agree across an edge: orbit, and exponent up to off; the centre has exponent 0 always;
// - an edge without neighbour is a subsegment; a triangle that is its own neighbour is (o, a, Ra).
//
// A bound of the paper is wherever two neighbours' stored frames differ (off != 0): nothing here
// treats such an edge specially, exponents are composed. Source: [paper] sec. 3-4.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "core/base/assert.hpp"
#include "core/geometry/orbit_vertex.hpp"
#include "core/geometry/point.hpp"
#include "core/geometry/rotation.hpp"

namespace symcell::plane {

using TriangleId = std::uint32_t;
using HalfEdge = std::uint32_t;
using SubsegmentId = std::int32_t;

inline constexpr HalfEdge kNoHalfEdge = std::numeric_limits<HalfEdge>::max();  // no neighbour
inline constexpr SubsegmentId kNoSubsegment = -1;                              // on no segment

[[nodiscard]] constexpr std::uint32_t next3(std::uint32_t i) {
  return i == 2 ? 0 : i + 1;
}
[[nodiscard]] constexpr std::uint32_t prev3(std::uint32_t i) {
  return i == 0 ? 2 : i - 1;
}
[[nodiscard]] constexpr TriangleId triangle_of(HalfEdge h) {
  return h / 3;
}
[[nodiscard]] constexpr std::uint32_t local_of(HalfEdge h) {
  return h % 3;
}

// One cache line.
struct alignas(64) Triangle {
  VertexId v[3];
  HalfEdge nb[3];
  SubsegmentId seg[3];   // subsegment on edge j, kNoSubsegment: none
  std::int16_t k[3];     // exponents of the corners, [0, n)
  std::int16_t off[3];   // exponents of the neighbours, [0, n)
  std::int32_t face;     // orbit of subdomains that holds the triangle; < 0: free slot
  std::uint32_t stamp;   // scratch: last epoch that visited this slot
  std::int32_t scratch;  // meaningful only together with stamp
  std::uint32_t queued;  // bits of the refinement queue
};
static_assert(sizeof(Triangle) == 64);

enum class VertexKind : std::uint8_t {
  kInput,    // of the PSLG, the centre included: never moved
  kSegment,  // Steiner point on a segment: slides along it
  kFree,     // Steiner point inside a face
  kDeleted
};

struct Subsegment {
  HalfEdge half_edge = kNoHalfEdge;  // one side, kept up to date
  std::int32_t parent = -1;          // index of the segment orbit of the PSLG
  std::uint8_t queued = 0;
  bool alive = true;
};

class QuotientTriangulation {
 public:
  QuotientTriangulation(std::int32_t fold, VertexId centre) : rotations_(fold), centre_(centre) {}

  [[nodiscard]] std::int32_t fold() const { return rotations_.fold(); }
  [[nodiscard]] const RotationTable& rotations() const { return rotations_; }
  // The vertex at the centre, -1 if the mesh has none.
  [[nodiscard]] VertexId centre() const { return centre_; }
  void set_centre(VertexId v) { centre_ = v; }

  // Vertices.
  VertexId add_vertex(Point2 p, VertexKind kind);
  void release_vertex(VertexId v);
  [[nodiscard]] std::size_t vertex_slots() const { return points_.size(); }
  [[nodiscard]] Point2 point(VertexId v) const { return points_[static_cast<std::size_t>(v)]; }
  [[nodiscard]] VertexKind kind(VertexId v) const { return kinds_[static_cast<std::size_t>(v)]; }
  void move_vertex(VertexId v, Point2 p) { points_[static_cast<std::size_t>(v)] = p; }
  // A corner (half-edge opposite it) at the vertex, kNoHalfEdge if it has no triangle.
  [[nodiscard]] HalfEdge corner_of(VertexId v) const {
    return corners_[static_cast<std::size_t>(v)];
  }
  void set_corner(VertexId v, HalfEdge corner) { corners_[static_cast<std::size_t>(v)] = corner; }

  // Triangles.
  TriangleId add_triangle();
  void release_triangle(TriangleId t);
  [[nodiscard]] Triangle& triangle(TriangleId t) { return triangles_[t]; }
  [[nodiscard]] const Triangle& triangle(TriangleId t) const { return triangles_[t]; }
  [[nodiscard]] std::size_t triangle_slots() const { return triangles_.size(); }
  [[nodiscard]] std::size_t triangle_count() const { return live_triangles_; }
  [[nodiscard]] bool alive(TriangleId t) const { return triangles_[t].face >= 0; }

  // Subsegments.
  SubsegmentId add_subsegment(std::int32_t parent);
  void release_subsegment(SubsegmentId s);
  [[nodiscard]] Subsegment& subsegment(SubsegmentId s) {
    return subsegments_[static_cast<std::size_t>(s)];
  }
  [[nodiscard]] const Subsegment& subsegment(SubsegmentId s) const {
    return subsegments_[static_cast<std::size_t>(s)];
  }
  [[nodiscard]] std::size_t subsegment_slots() const { return subsegments_.size(); }

  // Exponents.
  [[nodiscard]] std::int32_t add(std::int32_t a, std::int32_t b) const {
    return rotations_.add(a, b);
  }
  [[nodiscard]] std::int32_t subtract(std::int32_t a, std::int32_t b) const {
    return rotations_.subtract(a, b);
  }
  // Exponent of a corner in a frame rotated by e; the centre keeps 0.
  [[nodiscard]] std::int32_t shift(VertexId v, std::int32_t k, std::int32_t e) const {
    return v == centre_ ? 0 : rotations_.add(k, e);
  }

  // Positions.
  [[nodiscard]] Point2 lift(VertexId v, std::int32_t k) const {
    return rotations_.rotate(points_[static_cast<std::size_t>(v)], k);
  }
  [[nodiscard]] Point2 corner_point(const Triangle& t, std::uint32_t i) const {
    return lift(t.v[i], t.k[i]);
  }

  // Links half-edges h and g: the neighbour behind h is at exponent `off`.
  void link(HalfEdge h, HalfEdge g, std::int32_t off) {
    Triangle& a = triangles_[triangle_of(h)];
    a.nb[local_of(h)] = g;
    a.off[local_of(h)] = static_cast<std::int16_t>(off);
    if (g == kNoHalfEdge) return;
    Triangle& b = triangles_[triangle_of(g)];
    b.nb[local_of(g)] = h;
    b.off[local_of(g)] = static_cast<std::int16_t>(rotations_.subtract(0, off));
  }

  // Replaces the two triangles at half-edge h by the other diagonal's. The triangle of h keeps its
  // frame; the other one's slot takes that frame too. Returns the half-edge of the new diagonal in
  // the slot of h's triangle.
  // Requires: no subsegment on h, two different triangles, the quadrilateral strictly convex.
  HalfEdge flip(HalfEdge h);

  // Next visit mark for Triangle::stamp.
  std::uint32_t new_epoch();

  // Rewrites triangle slots in breadth-first order, without gaps: neighbours come to lie near one
  // another in memory, and the order does not show how the mesh was made.
  void compact();

  // Transactions: between begin and commit or roll_back every change of triangles, vertices and
  // subsegments made through `touch` and the functions above can be taken back.
  void begin();
  void commit();
  void roll_back();
  [[nodiscard]] bool in_transaction() const { return journal_.active; }
  // Must be called before a triangle, vertex or subsegment slot is written in a transaction.
  void touch(TriangleId t) {
    if (journal_.active) save_triangle(t);
  }
  void touch_vertex(VertexId v) {
    if (journal_.active) save_vertex(v);
  }
  void touch_subsegment(SubsegmentId s) {
    if (journal_.active) save_subsegment(s);
  }

 private:
  [[nodiscard]] std::vector<TriangleId> breadth_first_order();

  struct SavedVertex {
    VertexId id;
    Point2 point;
    HalfEdge corner;
    VertexKind kind;
  };
  struct SavedTriangle {
    TriangleId id;
    Triangle value;
  };
  struct SavedSubsegment {
    SubsegmentId id;
    Subsegment value;
  };
  // Values are saved before each write, several times if written several times, and restored in
  // reverse. Slots released in a transaction become reusable at commit only.
  struct Journal {
    bool active = false;
    std::vector<SavedTriangle> triangles;
    std::vector<SavedVertex> vertices;
    std::vector<SavedSubsegment> subsegments;
    std::size_t triangle_slots = 0;
    std::size_t vertex_slots = 0;
    std::size_t subsegment_slots = 0;
    std::size_t live_triangles = 0;
    std::vector<TriangleId> reused_triangles, released_triangles;
    std::vector<VertexId> reused_vertices, released_vertices;
    std::vector<SubsegmentId> reused_subsegments, released_subsegments;
  };

  void save_triangle(TriangleId t) { journal_.triangles.push_back({t, triangles_[t]}); }
  void save_vertex(VertexId v);
  void save_subsegment(SubsegmentId s) {
    journal_.subsegments.push_back({s, subsegments_[static_cast<std::size_t>(s)]});
  }

  RotationTable rotations_;
  VertexId centre_;
  std::vector<Triangle> triangles_;
  std::vector<Point2> points_;
  std::vector<HalfEdge> corners_;
  std::vector<VertexKind> kinds_;
  std::vector<Subsegment> subsegments_;
  std::vector<TriangleId> free_triangles_;
  std::vector<VertexId> free_vertices_;
  std::vector<SubsegmentId> free_subsegments_;
  std::size_t live_triangles_ = 0;
  std::uint32_t epoch_ = 0;
  Journal journal_;
};

}  // namespace symcell::plane
