// Insertion of Steiner points: Bowyer-Watson as a dry run on the universal cover, then the star of
// the new vertex in place of its cavity.
//
// The cavity of x is the set of triangles (t at exponent e) whose circumcircle holds x, reached
// from x's triangle without crossing a subsegment. Because it is computed on the cover it meets the
// subsegments of every copy, so the encroachment test of [paper sec. 4], "by the Steiner point or
// any symmetric point", falls out of its boundary before anything is changed. Where the cavity of x
// overlaps a copy of itself (near the centre, or in coarse meshes of large fold) the insertion
// falls back to splitting and Lawson flips, which are ordinary in the quotient.
#pragma once

#include <vector>

#include "core/geometry/point.hpp"
#include "core/plane/quotient/quotient_triangulation.hpp"

namespace symcell::plane {

// One edge a -> b of a cavity's boundary, in the frame of the point; the cavity lies to its left.
struct CavityEdge {
  OrbitVertex a;
  OrbitVertex b;
  HalfEdge mate = kNoHalfEdge;  // half-edge outside, kNoHalfEdge at the domain's boundary
  std::int32_t off = 0;         // exponent of the triangle outside
  SubsegmentId seg = kNoSubsegment;
  std::int32_t face = 0;       // of the triangle inside
  HalfEdge was = kNoHalfEdge;  // the half-edge inside, before the cavity is emptied
  std::int32_t frame = 0;      // exponent of the triangle inside
};

struct CavityTriangle {
  TriangleId t = 0;
  std::int32_t e = 0;
};

struct Cavity {
  std::vector<CavityTriangle> triangles;
  std::vector<CavityEdge> edges;    // counter-clockwise
  std::size_t right_triangles = 0;  // for a point on an edge: index of the first beyond it
  std::size_t right_edges = 0;
  bool simple = false;  // a disc without interior vertex that meets no copy of itself
};

struct EditCounters {
  std::uint64_t flips = 0;
  std::uint64_t crossings = 0;  // operations across relative exponent != 0
};

class Editor {
 public:
  explicit Editor(QuotientTriangulation& mesh) : mesh_(mesh) {}

  [[nodiscard]] QuotientTriangulation& mesh() { return mesh_; }
  [[nodiscard]] EditCounters& counters() { return counters_; }

  // Dry runs. `t` holds x, which is given in its frame; `h`: the edge on which x lies.
  void compute_cavity(TriangleId t, Point2 x, Cavity& cavity);
  void compute_edge_cavity(HalfEdge h, Point2 x, Cavity& cavity);

  // The sides of a region given as its triangles (at exponents, in one frame), counter-clockwise.
  // The region ends at subsegments: it is the part connected to its first triangle. Returns the
  // number of vertices inside it, -1 if it meets a copy of itself or is no disc.
  [[nodiscard]] std::int32_t collect_region(const std::vector<CavityTriangle>& region,
                                            Cavity& cavity);

  // Appends the side h of a cavity triangle at exponent e.
  void append_side(HalfEdge h, std::int32_t e, Cavity& cavity) const;

  // Insert x after a dry run. Returns the vertex, -1 if x cannot be placed (coincides with a vertex
  // or degenerates a triangle within rounding; nothing is changed then). `kind` as for add_vertex.
  // On success `created()` lists the triangles that are new or changed, without repeats that
  // matter.
  VertexId insert_in_cavity(TriangleId t, Point2 x, const Cavity& cavity, VertexKind kind);
  // Splits the edge h, and its subsegment if it is one, at x.
  VertexId insert_on_edge(HalfEdge h, Point2 x, const Cavity& cavity, VertexKind kind);

  // Lawson flips from the queued edges until all are locally Delaunay.
  void queue_edge(HalfEdge h) { edges_.push_back(h); }
  // The edges of the star last filled: its sides and spokes.
  void queue_star() {
    for (const TriangleId t : star_) {
      edges_.push_back(3 * t);
      edges_.push_back(3 * t + 1);
    }
  }
  void legalise();

  [[nodiscard]] std::vector<TriangleId>& created() { return created_; }

  // Replaces the cavity of triangles (all different) bounded by `edges` by the star of `apex`, a
  // corner in the frame of the edges. `closed`: the edges form a cycle; else the first and last
  // sides are left unlinked for the caller. New triangle i is star()[i] = (apex, a_i, b_i).
  // `glued`: sides may be glued to one another (a side's mate is another side's `was`).
  void fill_star(const OrbitVertex& apex,
                 const CavityTriangle* old_triangles,
                 std::size_t old_count,
                 const CavityEdge* edges,
                 std::size_t edge_count,
                 bool closed,
                 bool glued);
  [[nodiscard]] const std::vector<TriangleId>& star() const { return star_; }

 private:
  struct Walk {
    TriangleId t;
    std::int32_t e;
    std::uint32_t j;
  };

  void start(Cavity& cavity);
  void visit(TriangleId t, std::int32_t e, Cavity& cavity);
  void grow(Point2 x, Cavity& cavity);
  [[nodiscard]] bool in_conflict(TriangleId t, std::int32_t e, Point2 x) const;
  [[nodiscard]] bool star_is_positive(Point2 x, const Cavity& cavity) const;
  void check_outside(Cavity& cavity) const;
  [[nodiscard]] bool must_flip(const Triangle& tri,
                               std::uint32_t j,
                               const Triangle& other,
                               std::uint32_t i) const;
  VertexId place(Point2 x, const Cavity& cavity, VertexKind kind, bool closed);
  void split_subsegment(SubsegmentId s, VertexId x, const Cavity& cavity);
  VertexId insert_near_edge(TriangleId t, Point2 x, VertexKind kind);
  VertexId split_edge(HalfEdge h, Point2 x, VertexKind kind);
  VertexId split_self_adjacent(HalfEdge h, Point2 x, VertexKind kind);
  void queue_star_sides();

  QuotientTriangulation& mesh_;
  EditCounters counters_;
  Cavity minimal_;  // of the fallback
  std::vector<Walk> walk_;
  std::vector<HalfEdge> edges_;
  std::vector<TriangleId> created_;
  std::vector<TriangleId> star_;
  std::uint32_t epoch_ = 0;
  bool self_met_ = false;  // the cavity being grown met a copy of itself
};

}  // namespace symcell::plane
