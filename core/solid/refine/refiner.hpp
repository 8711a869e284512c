// Delaunay refinement of solids in the quotient.
//
// A bad tetrahedron asks for a point at its circumcentre. A subfacet in the way, or one that the
// point would encroach on, is divided at its own circumcentre instead; a subsegment in the way of
// that, or encroached on, at its middle. Only what stands against a bad tetrahedron is divided:
// encroachment alone, with good tetrahedra all round, is left. Source: [paper] sec. 5;
// [Shewchuk98].
//
// Termination: a point for the sake of shape is refused where it would come nearer to a vertex than
// a share of the bad tetrahedron's shortest edge, and where a chain of points, each nearer than the
// edge that caused it, gets longer than a given depth: below that edges cannot shrink any further.
// Points for the sake of size are bounded by the volume and the edge length asked for. No point at all
// comes nearer to a vertex than `min_edge`. Beside that,
// a run has a budget of points for the sake of shape, in proportion to the bad tetrahedra it finds
// and to the points that size asks for: where acute facets or narrow gaps make every point cause
// others, it ends long before edges reach their lower bound, and what is bad then is reported.
#pragma once

#include <cstdint>
#include <limits>
#include <queue>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/solid/delaunay/editor.hpp"
#include "core/solid/refine/criteria.hpp"

namespace symcell::solid {

struct RefineCounters {
  std::uint64_t segment_splits = 0;
  std::uint64_t facet_splits = 0;
  std::uint64_t interior_points = 0;
  std::uint64_t refused = 0;  // bad tetrahedra that no point was allowed for

  RefineCounters& operator+=(const RefineCounters& o) {
    segment_splits += o.segment_splits;
    facet_splits += o.facet_splits;
    interior_points += o.interior_points;
    refused += o.refused;
    return *this;
  }
};

class Refiner {
 public:
  static constexpr int kMaxChain = 8;  // points: the deepest that any run asks for

  Refiner(Editor& editor, const Criteria& criteria, ExecutionContext& context);

  // Longest chain of points each nearer to its neighbours than the edge that caused it. Short
  // chains leave some bad tetrahedra to the improvement, which mends most of them with far fewer
  // points.
  void set_max_depth(int depth) { max_depth_ = depth; }

  // Tetrahedra with faces that are not locally Delaunay, where no flip helps, are given a point as
  // well, after all others.
  void treat_illegal() { illegal_too_ = true; }

  // Exempt tetrahedra that are bad are given a point as well, where no edge gets shorter by it.
  void treat_exempt() { exempt_too_ = true; }

  // No points for the sake of shape are added to meshes larger than this.
  void set_most_shaped(std::uint64_t most) { most_shaped_ = most; }
  // For the sake of shape no point comes nearer to a vertex than this.
  void set_least_distance(double least) { least_distance_ = least; }
  // The run ends with kElementLimit where the mesh gets larger than this.
  void set_most_tets(std::uint64_t most) { most_tets_ = most; }

  // A point for the sake of shape is refused where it does not see more tetrahedra than this of
  // those whose spheres hold it: in a mesh so far from Delaunay it would be in the wrong place.
  void set_most_hidden(std::size_t most) { most_hidden_ = most; }

  // Until no tetrahedron is bad but the exempt and those whose points were refused.
  // Errors: kElementLimit, kTimeLimit, kCancelled.
  [[nodiscard]] Result<void> run();

  [[nodiscard]] const RefineCounters& counters() const { return counters_; }

 private:
  enum class Outcome : std::uint8_t { kInserted, kRefused };
  // What asks for a point.
  struct Cause {
    double shortest = 0;  // edge of the bad tetrahedron
    double least = 0;     // no vertex may be nearer to the new point than this, size aside
    bool size = false;    // because of volume or edge length
    bool spare = false;   // exempt by the input: no edge may get shorter for its sake
    std::uint8_t depth = 0;
  };
  struct Entry {
    std::int32_t key;
    TetId t;
    std::uint32_t version;
    friend bool operator<(const Entry& a, const Entry& b) {
      return a.key != b.key ? a.key < b.key : a.t > b.t;
    }
  };
  // A subfacet as seen from one side.
  struct Subfacet {
    TetCopy at;
    std::uint32_t face = 0;
  };

  void enqueue(TetId t);
  void enqueue_added();
  void enqueue_all();
  [[nodiscard]] bool still_bad(const Entry& e) const;
  [[nodiscard]] Cause cause_of(TetId t) const;
  [[nodiscard]] Outcome treat(TetId t);
  [[nodiscard]] Outcome split_subfacet(Subfacet s, const Cause& cause);
  [[nodiscard]] Outcome split_segment(TetCopy at, OrbitVertex a, OrbitVertex b, const Cause& cause);
  [[nodiscard]] Outcome split_too_large(TetId t);
  Outcome split_edge(TetId t, OrbitVertex a, OrbitVertex b, const Cause& cause);
  [[nodiscard]] bool find_cavity(Point3 p, const Location& where, const Cause& cause);
  // From the point to the nearest vertex, its own copies included.
  [[nodiscard]] double nearest_to(const Cavity& cavity) const;
  [[nodiscard]] bool allowed(const Cavity& cavity, const Cause& cause, double share) const;
  // Whether this run's budget and the mesh's size leave room for a point for the sake of shape.
  [[nodiscard]] bool may_add_for_shape() const;
  [[nodiscard]] Outcome insert(
      const Cavity& cavity, VertexKind kind, std::int32_t parent, bool on_axis, const Cause& cause);
  // Counts the point against the budget or, where size asks for it, towards it.
  void account(const Cause& cause);
  // The subfacet of the same facet across an edge of `s`; false at a subsegment or the facet's rim.
  [[nodiscard]] bool cross_edge(Subfacet& s, OrbitVertex a, OrbitVertex b) const;

  struct Encroached {
    enum class What : std::uint8_t { kNothing, kSubfacet, kSubsegment };
    double worst = 1;  // share of the squared radius at which the point stands, the least so far
    What what = What::kNothing;
    Subfacet subfacet;
    TetCopy at;
    OrbitVertex a, b;

    void look_at_segments(const QuotientTetrahedralization& mesh,
                          Point3 p,
                          const CavityFace& face,
                          TetCopy owner);
    void look_at_facet(Point3 p, const CavityFace& face, Subfacet s);
  };
  [[nodiscard]] Encroached encroached_by(const Cavity& cavity, bool facets) const;
  // By a point for which there is no cavity: of its seeds.
  [[nodiscard]] Encroached encroached_beside(const Cavity& cavity, bool facets) const;
  // The face of `at` with these corners.
  [[nodiscard]] std::uint32_t face_with(TetCopy at,
                                        const std::array<OrbitVertex, 3>& corners) const;

  Editor& editor_;
  QuotientTetrahedralization& mesh_;
  const Criteria& criteria_;
  ExecutionContext& context_;
  std::priority_queue<Entry> queue_;
  int max_depth_ = kMaxChain;
  bool illegal_too_ = false;
  bool exempt_too_ = false;
  std::uint64_t shape_budget_ = 0;
  std::uint64_t most_shaped_ = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t most_tets_ = std::numeric_limits<std::uint64_t>::max();
  double least_distance_ = 0;
  std::size_t most_hidden_ = Editor::kAny;
  std::vector<std::uint8_t> depth_;  // per vertex
  Cavity cavity_;
  RefineCounters counters_;
};

}  // namespace symcell::solid
