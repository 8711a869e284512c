// Edits of the quotient mesh of a solid that keep it a mesh: every edit is proposed as a set of
// tetrahedra to go and a set to come, looked at, and only then done.
//
// Insertion is constrained Bowyer-Watson in the universal cover: the cavity of a point grows from
// the tetrahedra that contain it over faces that are no subfacets (and across the subfacets of the
// point's own facet), each tetrahedron of the quotient at one exponent only; it shrinks again until
// the point sees all of its boundary, and of the subfacets to be divided all of their outline, and
// no vertex or subsegment is lost. The smallest cavity, the tetrahedra that contain the point,
// always does. Source: [paper] sec. 5; [Si15] sec. 4.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/geometry/tet_measures.hpp"
#include "core/solid/quotient/quotient_tetrahedralization.hpp"

namespace symcell::solid {

// Smallest 6 V / longest edge^3 of a tetrahedron that an edit may make: far above the rounding of
// lifted coordinates (1e-15), far below any sliver worth keeping.
inline constexpr double kMinRelativeVolume = 1e-8;
// A point of a facet is in the plane of another subfacet of that facet if it is off by no more than
// this share of the distances: flat patches of STL files are flat to single precision only.
inline constexpr double kCoplanarRelativeHeight = 1e-5;

struct EditCounters {
  std::uint64_t insertions = 0;
  std::uint64_t flips = 0;
  std::uint64_t collapses = 0;
  std::uint64_t moves = 0;
  std::uint64_t crossings = 0;  // edits of tetrahedra whose frames differ by a rotation
};

// Where a point lies, in the frame of the tetrahedron copy `at`.
struct Location {
  enum class Kind : std::uint8_t { kInside, kOnSubfacet, kOnEdge };
  Kind kind = Kind::kInside;
  TetCopy at;
  std::uint32_t face = 0;             // kOnSubfacet: face of `at`
  std::array<OrbitVertex, 2> edge{};  // kOnEdge: corners of `at`
};

// A face of the cavity's boundary, outward, in the frame of the cavity.
struct CavityFace {
  std::array<OrbitVertex, 3> corners;
  std::array<Point3, 3> points;
  std::int32_t facet = kNoFacet;
  std::int32_t region = 0;
  std::uint32_t owner = 0;  // index in Cavity::tets
};

// An edge of a subfacet that the point divides anew, in the frame of the cavity.
struct OutlineEdge {
  OrbitVertex a, b;
  std::int32_t facet = kNoFacet;
  std::uint32_t owner = 0;  // index in Cavity::tets
  Point3 inner;             // the subfacet's third corner
};

struct Cavity {
  Location where;
  Point3 point;
  std::vector<TetCopy> tets;
  std::vector<CavityFace> faces;
  // Edges that bound the subfacets which the point divides anew. The point sees each of them within
  // the facet, so that the new subfacets cover what the old ones did: a facet need not be convex,
  // and the cavity may reach round a gap in it.
  std::vector<OutlineEdge> outline;
  std::size_t seeds = 0;  // the first ones contain the point
  double nearest2 = 0;    // squared distance of the point to the nearest vertex
};

class Editor {
 public:
  explicit Editor(QuotientTetrahedralization& mesh);

  [[nodiscard]] QuotientTetrahedralization& mesh() { return mesh_; }
  [[nodiscard]] const QuotientTetrahedralization& mesh() const { return mesh_; }
  [[nodiscard]] const TetMeasures& measures(TetId t) const { return measures_[t]; }
  [[nodiscard]] const EditCounters& counters() const { return counters_; }
  [[nodiscard]] TetMeasures measure(TetId t) const {
    return measure_tet(mesh_.corner_point(t, 0), mesh_.corner_point(t, 1), mesh_.corner_point(t, 2),
                       mesh_.corner_point(t, 3));
  }
  [[nodiscard]] std::array<Point3, 4> points(TetCopy c) const {
    return {mesh_.lift(mesh_.corner(c, 0)), mesh_.lift(mesh_.corner(c, 1)),
            mesh_.lift(mesh_.corner(c, 2)), mesh_.lift(mesh_.corner(c, 3))};
  }

  // The cavity of `p`, false if not even the smallest one would do (p too near a vertex or a face),
  // or if more than `most_hidden` of the tetrahedra whose spheres hold p cannot be seen from it.
  static constexpr std::size_t kAny = std::numeric_limits<std::size_t>::max();
  [[nodiscard]] bool find_cavity(Point3 p,
                                 const Location& where,
                                 Cavity& cavity,
                                 std::size_t most_hidden = kAny);
  // Inserts the cavity's point; kNoVertex if the mesh refuses. New tetrahedra: mesh().added_ids().
  // `parent`: segment or facet of a point on one.
  static constexpr VertexId kNoVertex = -1;
  [[nodiscard]] VertexId insert(const Cavity& cavity,
                                VertexKind kind,
                                std::int32_t parent,
                                bool on_axis);

  // As QuotientTetrahedralization::replace, with the measures kept up to date.
  [[nodiscard]] bool replace(std::span<const TetCopy> removed,
                             std::span<const NewTet> added,
                             std::span<const EdgeKey> segment_edges = {});
  // After a vertex moved.
  void remeasure(TetId t) {
    measures_[t] = measure(t);
    mesh_.bump_version(t);
  }
  // As of the mesh; returns the tetrahedra that are as they were again.
  void begin();
  void commit() { mesh_.commit(); }
  std::vector<TetId> roll_back();
  // Tetrahedra near one another come to lie near one another in memory; vertices keep their ids.
  void compact();

  void count_flip() { ++counters_.flips; }
  void count_collapse() { ++counters_.collapses; }
  void count_move() { ++counters_.moves; }

  // Walks from the inside of `from` towards p, in the frame of `from`. Stops in the tetrahedron
  // that contains p, or at the first subfacet in the way: then `blocked` and `face` say which.
  struct Walk {
    TetCopy at;
    std::uint32_t face = 0;
    bool blocked = false;
    bool lost = false;  // too many steps
  };
  [[nodiscard]] Walk walk(TetCopy from, Point3 p) const;

  [[nodiscard]] CavityFace face_of_copy(TetCopy c, std::uint32_t i) const;

 private:
  void remeasure_all();
  [[nodiscard]] bool in_sphere(TetCopy c, Point3 p) const;
  void seed_cavity(Cavity& cavity) const;
  void find_own_facets(const Cavity& cavity);
  // False as soon as more than `most_hidden` tetrahedra are known to have a face that the point, inside
  // the first one, does not see.
  [[nodiscard]] bool grow_cavity(Cavity& cavity, std::size_t most_hidden);
  // Whether the cavity's point does not see face i of c, a face of its boundary.
  [[nodiscard]] bool turns_away(const Cavity& cavity, TetCopy c, std::uint32_t i) const;
  // Fills faces and outline; kFits, or the index of a tetrahedron that must leave, with all of its
  // kind in hidden_.
  static constexpr std::int64_t kFits = -1;
  [[nodiscard]] std::int64_t gather_boundary(Cavity& cavity);
  // Leaves the edges of the outline proper; as gather_boundary for those that the point does not
  // see.
  [[nodiscard]] std::int64_t reduce_outline(Cavity& cavity);
  [[nodiscard]] EdgeKey outline_name(OrbitVertex a, OrbitVertex b) const;
  [[nodiscard]] std::int64_t find_lost(Cavity& cavity);
  void drop(Cavity& cavity, std::span<const std::size_t> indices);
  [[nodiscard]] bool add_seed(Cavity& cavity, std::size_t index);
  [[nodiscard]] bool in_own_plane(const Cavity& cavity, const CavityFace& face) const;
  [[nodiscard]] bool contains(const Cavity& cavity, TetCopy c) const;

  QuotientTetrahedralization& mesh_;
  std::vector<TetMeasures> measures_;
  EditCounters counters_;
  EditCounters counters_before_;  // the trial

  // Scratch.
  std::uint32_t epoch_ = 0;
  std::uint32_t flat_face_ = 4;  // of the tetrahedron that gather_boundary named, 4: not for that
  bool point_on_axis_ = false;
  std::vector<std::int32_t> own_facets_;  // on which the point of the cavity lies
  std::vector<NewTet> new_tets_;
  std::vector<std::uint8_t> keep_;
  std::vector<std::size_t> todo_;
  // Tetrahedra with faces, or edges of an outline, that the cavity's point does not see.
  std::vector<std::size_t> hidden_;
  struct VertexMark {
    std::uint32_t epoch = 0;
    std::int32_t k = 0;
  };
  std::vector<VertexMark> marks_;
  std::uint32_t mark_epoch_ = 0;
};

}  // namespace symcell::solid
