// Local operations that improve a solid's mesh: edge removal, face removal (2-3 flips), moves of
// single vertices, edge collapses. Each looks at what it would make first and is done only if the
// bounds stay kept (where they are broken: are broken less) and the worst of the tetrahedra
// concerned gets better, or, for collapses, stays good enough. All work across symmetry bounds as
// anywhere else. Sources: [KlingnerShewchuk07]; edge removal by dynamic programming after
// [Klincsek80].
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/solid/delaunay/editor.hpp"
#include "core/solid/improve/insertion_cavity.hpp"
#include "core/solid/refine/criteria.hpp"

namespace symcell::solid {

// An operation must better the worst shape by this share, lest two undo each other for ever.
inline constexpr double kGain = 1e-3;
// Where a bound is broken, the excess must shrink by this share.
inline constexpr double kExcessGain = 0.02;

class Surgery {
 public:
  Surgery(Editor& editor, const Criteria& criteria);

  // Smallest sine of a dihedral angle, kept up to date.
  [[nodiscard]] double shape(TetId t) const { return shapes_[t]; }
  [[nodiscard]] Editor& editor() { return editor_; }

  // Excess (Criteria::excess) that collapses may leave for moves and refinement to mend.
  void allow_excess(double excess) { allowed_excess_ = excess; }
  // From now on no bound on size is broken for the sake of the ratio: no refinement follows.
  void keep_size() { size_kept_ = true; }

  // Operations as parts of a trial: begin(), some of them, and then they stay or everything
  // is as it was.
  void begin() { editor_.begin(); }
  void commit() { editor_.commit(); }
  void roll_back();
  // Flips, merges and insertions may then make shapes worse, down to tetrahedra of some degrees,
  // and break bounds: as the first operation of a trial, for others to mend.
  void set_lenient(bool lenient) { lenient_ = lenient; }

  // Of the tetrahedra that an operation made or changed.
  [[nodiscard]] std::span<const TetId> touched() const { return touched_; }
  // Operations that changed something so far.
  [[nodiscard]] std::uint64_t edits() const { return edits_; }

  // Removes the edge between corners i and j of t.
  [[nodiscard]] bool remove_edge(TetId t, std::uint32_t i, std::uint32_t j);
  // 2-3 flip of face i of t.
  [[nodiscard]] bool remove_face(TetId t, std::uint32_t i);
  // Moves a vertex where its star gets better; vertices of segments and facets stay on them.
  [[nodiscard]] bool smooth(VertexId v);
  // Inserts a vertex for the sake of t's shape where its star's worst is above that of all it
  // replaces.
  [[nodiscard]] bool insert_point(TetId t);
  // Merges a vertex into a neighbour, there or half-way. `stays`: the neighbour's copy next to copy
  // 0 of the vertex. `floor`: least shape that will do where the star's own worst is better; a star
  // worse than that must not get worse. Bounds::kFree: the bounds may be broken (before refinement,
  // when they are broken anyway).
  enum class Bounds : std::uint8_t { kKept, kFree };
  [[nodiscard]] bool merge(VertexId goes,
                           OrbitVertex stays,
                           double floor,
                           Bounds bounds = Bounds::kKept);
  // Corner `from` of t into corner `to`.
  [[nodiscard]] bool collapse(
      TetId t, std::uint32_t from, std::uint32_t to, double floor, Bounds bounds = Bounds::kKept) {
    const OrbitVertex u = mesh_.corner(t, from);
    return merge(u.orbit, mesh_.shift(mesh_.corner(t, to), mesh_.subtract(0, u.exponent)), floor,
                 bounds);
  }
  // Copies of other vertices next to copy 0 of a vertex, the nearest first; empty where merging is
  // out of the question.
  struct Neighbour {
    double squared = 0;
    OrbitVertex corner;
  };
  [[nodiscard]] std::span<const Neighbour> neighbours(VertexId v);

 private:
  static constexpr double kFar = std::numeric_limits<double>::infinity();  // no limit
  // Beyond any excess of a radius-edge ratio that is not of a flat tetrahedron.
  static constexpr double kOversized = 1e12;
  // Edges shorter than the least allowed come before all else.
  static constexpr double kTooShort = 1e24;
  // Stars this large are at hubs of the input; working there is slow and seldom helps. Below 256.
  static constexpr std::size_t kMaxStar = 120;
  // Least sine that a lenient operation may leave: 3 degrees.
  static constexpr double kOpeningShape = 0.05;

  struct Worth {
    double shape = 2;   // the smallest
    double excess = 0;  // the largest, of bounds that must be kept
    double exempt = 0;  // the largest of the ratio where the input exempts from it
  };
  [[nodiscard]] double excess_of(const TetMeasures& m, std::int32_t region, Exemption exempt) const;
  void include(
      Worth& w, double shape, const TetMeasures& m, std::int32_t region, Exemption exempt) const;
  [[nodiscard]] Worth worth_of(std::span<const TetCopy> tets) const;
  // A corner and where it is to be.
  struct Moved {
    OrbitVertex corner;
    Point3 place;
  };
  [[nodiscard]] Worth worth_of(std::span<const NewTet> tets) const;
  // Whether all have a shape above the limits' and no more excess; gives up at the first that has
  // not.
  [[nodiscard]] bool all_within(std::span<const NewTet> tets,
                                const Moved& moved,
                                const Worth& limits) const;
  [[nodiscard]] bool within(const LinkTet& t,
                            std::int32_t region,
                            Exemption exempt,
                            const Worth& limits) const;
  [[nodiscard]] Exemption exemption_of(std::span<const OrbitVertex> corners) const;
  [[nodiscard]] static bool better(const Worth& now, const Worth& before);
  [[nodiscard]] bool accepts(const Worth& now, const Worth& before) const {
    if (!lenient_) return better(now, before);
    return now.shape > kOpeningShape && now.excess <= std::max(lenient_excess(), before.excess);
  }
  // Of operations that may break bounds, but make no edge too short.
  [[nodiscard]] double lenient_excess() const {
    return criteria_.min_edge() > 0 ? kTooShort : kFar;
  }
  // While a bound is broken, shapes may get worse, but not below this sine.
  static constexpr double kPoorShape = 0.3;
  // That what betters a star must exceed in any case.
  [[nodiscard]] static double floor_of(const Worth& before) {
    return is_broken(before) ? std::clamp(before.shape, 0.0, kPoorShape) : before.shape;
  }
  // That edge and face removals must exceed.
  [[nodiscard]] double least_shape(const Worth& before) const {
    return lenient_ ? kOpeningShape : floor_of(before);
  }
  [[nodiscard]] static bool is_broken(const Worth& w) { return w.excess > 1 || w.exempt > 1; }
  [[nodiscard]] bool apply(std::span<const TetCopy> removed,
                           std::span<const NewTet> added,
                           std::span<const EdgeKey> segment_edges = {});

  // Edge removal.
  struct Ring {
    OrbitVertex a, b;
    Point3 pa, pb;
    std::vector<TetCopy> tets;
    std::vector<OrbitVertex> corners;
    std::vector<Point3> points;
    bool closed = false;
  };
  [[nodiscard]] bool load_ring(TetId t, std::uint32_t i, std::uint32_t j);
  // Triangulates the chain of ring corners, adds the two tetrahedra of every triangle.
  [[nodiscard]] bool fill_chain(std::span<const std::uint32_t> chain,
                                std::int32_t region,
                                std::int32_t facet,
                                double least);
  [[nodiscard]] double triangle_worth(std::uint32_t i, std::uint32_t j, std::uint32_t k) const;

  // Stars: what moves and merges look at.
  struct StarTet {
    std::array<OrbitVertex, 4> c;
    std::array<Point3, 4> p;
    LinkFace link;  // opposite the vertex
    std::int32_t region;
    Exemption exempt;       // from the ratio
    Exemption exempt_link;  // whatever vertex stands on the link
    std::uint8_t own;       // bits of the corners that are copies of the vertex
    std::uint8_t apex;      // one of them: copy 0

    [[nodiscard]] bool has(OrbitVertex x) const {
      return c[0] == x || c[1] == x || c[2] == x || c[3] == x;
    }
  };
  [[nodiscard]] bool load_star(VertexId v);
  void load_star_tet(TetCopy c, VertexId v, StarTet& s) const;
  [[nodiscard]] std::span<const StarTet> star_tets() const {
    return {star_tets_.data(), star_.size()};
  }
  [[nodiscard]] Worth star_worth_at(Point3 p, const Worth& limits);
  [[nodiscard]] const Worth& star_worth();
  // A tetrahedron of the star that would not do is looked at earlier next time.
  void blame(std::size_t at) { std::swap(star_order_[at], star_order_[at / 2]); }

  // Merges.
  struct Collapse {
    OrbitVertex goes, stays;
    VertexKind kind = VertexKind::kFree;
    std::int32_t segment = kNoSegment;
    OrbitVertex behind{-1, 0};  // the segment's other neighbour of `goes`
    std::size_t shared = 0;     // tetrahedra with both
  };
  [[nodiscard]] bool plan_collapse(OrbitVertex goes, OrbitVertex stays, Collapse& plan);
  [[nodiscard]] bool may_shrink(double volume, double limit, std::size_t left) const;
  [[nodiscard]] bool link_within(const Collapse& plan, Point3 place, const Worth& limits);
  [[nodiscard]] bool merge_in_the_middle(const Collapse& plan, double floor);
  [[nodiscard]] Worth merge_limits(double floor, const Worth& before) const;
  [[nodiscard]] bool do_collapse(const Collapse& plan);
  void refresh(TetId t);
  void note_added();
  [[nodiscard]] static bool is_flat(const TetMeasures& m) {
    return 6 * m.volume <= kMinRelativeVolume * m.longest2 * std::sqrt(m.longest2);
  }

  // Moves.
  // Sets direction_, of the vertex whose star is loaded. The shortest edge at it; none: nothing tells the
  // direction.
  [[nodiscard]] std::optional<double> find_hold(VertexId v);
  [[nodiscard]] Point3 constrain(VertexId v, Point3 p) const;

  Editor& editor_;
  QuotientTetrahedralization& mesh_;
  const Criteria& criteria_;
  double allowed_excess_ = 1;
  bool size_kept_ = false;
  bool lenient_ = false;
  std::vector<double> shapes_;
  std::vector<TetId> touched_;

  Ring ring_;
  std::vector<NewTet> new_tets_;
  // The star of copy 0 of star_vertex_, as of edit number star_edits_.
  std::vector<TetCopy> star_;
  std::vector<StarTet> star_tets_;        // beside star_; may be longer
  std::vector<std::uint8_t> star_order_;  // in which it is looked through
  VertexId star_vertex_ = -1;
  std::uint64_t star_edits_ = 0;
  std::uint64_t edits_ = 0;
  bool star_simple_ = false;  // no tetrahedron twice, none with two copies of the vertex
  bool star_judged_ = false;
  Worth star_worth_;
  double star_volume_ = 0;
  double star_limit_ = 0;  // the largest volume bound there
  std::vector<Neighbour> neighbours_;
  std::vector<TetCopy> other_star_;
  std::vector<NewTet> stretched_;  // tetrahedra that a merge in the middle moves a corner of
  InsertionCavity insertion_;
  Point3 direction_;  // of the segment, or normal of the facet, that holds the vertex
};

}  // namespace symcell::solid
