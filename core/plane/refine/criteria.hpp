// What makes a triangle bad: its smallest angle, its area, its longest edge; and what is exempt.
//
// The angle bound that refinement works to is kAngleMarginDeg above the one asked for, so that
// coordinates rounded on output (an offset centre costs digits) still keep the latter.
//
// Exempt are only triangles whose bound the input itself forbids: those in a corner of the input
// that is narrower than the bound, those whose shortest edge spans such a corner ("seditious",
// [Miller-Pav-Walkington03]), and, where 360/n is below the bound, the triangle (o, a, Ra) at the
// centre, whose other two angles are near 90 degrees.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/geometry/point.hpp"
#include "core/model/mesh_options.hpp"
#include "core/plane/initial/initial_triangulation.hpp"
#include "core/plane/quotient/quotient_triangulation.hpp"
#include "core/plane/refine/local_sizes.hpp"

namespace symcell::plane {

inline constexpr double kAngleMarginDeg = 1e-7;  // see above: for the rounding of output
// Segments meeting below this angle are split on concentric shells [Ruppert95 sec. 7].
inline constexpr double kShellAngleDeg = 60.0;
// For bounds below this, lenses are those of this bound: a flatter lens would let points lie next
// to segments, and edges shrink, although no angle asks for it.
inline constexpr double kLeastLensDeg = 20.0;
// Points are moved for stars of at least this angle.
inline constexpr double kLeastStarDeg = 1.0;
// So are corners below this many angle bounds: they take two triangles, whose angles leave their
// sides hardly any freedom to differ in length (measured: without, an 87 degree corner cascades at
// 40).
inline constexpr double kShellFactor = 2.5;

enum class Verdict : std::uint8_t { kGood, kAngle, kSize };
enum class Exemption : std::uint8_t {
  kNone,
  kSmallInputAngle,
  kSeditious,
  kFoldAngleAtCentre,  // (o, a, Ra) where 360/n is below the bound
  kKeptBoundary,       // would need a point on a segment that `keep_boundary` keeps
  kMinEdge,            // would need an edge shorter than `min_edge`
  kMet  // (o, a, Ra) where 360/n is the bound itself: keeps it, though not the margin
};

// A triangle bad in angle and size is kAngle and `too_large`: an exemption from the one is none for the
// other.
struct Assessment {
  Verdict verdict = Verdict::kGood;
  bool too_large = false;
  double shortest2 = 0;        // squared length of the shortest edge
  std::uint32_t shortest = 0;  // that edge
};

class Criteria {
 public:
  Criteria(const QuotientTriangulation& mesh,
           const std::vector<SubdomainOrbit>& subdomains,
           const MeshOptions& options,
           const LocalSizes& sizes = {});

  // Angle and size of a stored triangle, exemptions not looked at.
  [[nodiscard]] Assessment assess(const QuotientTriangulation& mesh, const Triangle& t) const;
  // Of the triangle (a, b, c), counter-clockwise, in subdomain `face`.
  [[nodiscard]] Assessment assess(Point2 a, Point2 b, Point2 c, std::int32_t face) const;
  // Why a triangle with kAngle is exempt, kNone if it is not.
  [[nodiscard]] Exemption exemption(const QuotientTriangulation& mesh,
                                    TriangleId t,
                                    const Assessment& assessment) const;
  // Whether the input or an option has places where a triangle may be exempt.
  [[nodiscard]] bool exempts_any() const {
    return !narrow_.empty() || centre_is_narrow_ || centre_is_exact_ || may_leave_bad();
  }
  // Bad and not exempt, or with an edge that refinement must not make. A triangle left as it is because
  // its improvement would take too short an edge counts as bad: nothing may make another one like it.
  [[nodiscard]] bool is_bad(const QuotientTriangulation& mesh, TriangleId t) const {
    const Assessment a = assess(mesh, mesh.triangle(t));
    return a.too_large || has_short_edge(mesh, mesh.triangle(t)) ||
           (a.verdict == Verdict::kAngle && exemption(mesh, t, a) == Exemption::kNone);
  }

  // Whether something forbids points that the bounds would need: then what cannot be improved stays as
  // it is, and is exempt.
  [[nodiscard]] bool may_leave_bad() const { return has_least_edge() || keeps_any_segment(); }
  [[nodiscard]] bool keeps_any_segment() const {
    return keep_boundary_ || !sizes_.kept_segment.empty();
  }
  // Whether subsegments of that segment of the input, on the boundary or not, get no vertices.
  [[nodiscard]] bool keeps(std::int32_t segment, bool on_boundary) const {
    return (keep_boundary_ && on_boundary) ||
           (!sizes_.kept_segment.empty() &&
            sizes_.kept_segment[static_cast<std::size_t>(segment)] != 0);
  }
  // Whether edges have a least length. Then every change is looked at before it is kept.
  [[nodiscard]] bool has_least_edge() const { return min_edge2_ > 0; }
  [[nodiscard]] double min_edge2() const { return min_edge2_; }
  // Whether an edge at a Steiner point is shorter than that.
  [[nodiscard]] bool has_short_edge(const QuotientTriangulation& mesh, const Triangle& t) const;
  // Whether stars made anew may break a bound that the search for their places does not know.
  [[nodiscard]] bool must_look_at_stars() const { return has_size_bound_ || has_least_edge(); }

  // Whether p sees segment ab under an angle of at least 180 degrees minus twice the bound, that
  // is, lies in its diametral lens [Shewchuk02].
  [[nodiscard]] bool in_lens(Point2 a, Point2 b, Point2 p) const;
  // Whether edge j is longer than the bound for all, its segment's or its ends'.
  [[nodiscard]] bool edge_too_long(const QuotientTriangulation& mesh,
                                   const Triangle& t,
                                   std::uint32_t j) const;
  // How long edges at a vertex may be, inf: no bound but that for all.
  [[nodiscard]] double max_edge_at(const QuotientTriangulation& mesh, VertexId v) const {
    const auto at = static_cast<std::size_t>(v);
    const double asked = at < sizes_.at_vertex.size() ? sizes_.at_vertex[at] : kInfinity;
    return sizes_.graded ? std::min(asked, graded_edge_at(mesh, v)) : asked;
  }

  [[nodiscard]] double goal_angle() const { return goal_angle_; }  // radians
  // What stars made anew keep: where no angle is asked for, enough to be worth a move.
  [[nodiscard]] double star_angle() const;
  // Whether anything is asked for that moving and merging points could save triangles of.
  [[nodiscard]] bool has_bound() const { return goal_angle_ > 0 || has_size_bound_; }
  [[nodiscard]] double max_area(std::int32_t face) const {
    return max_area_[static_cast<std::size_t>(face)];
  }
  [[nodiscard]] double max_edge2() const { return max_edge2_; }
  [[nodiscard]] bool has_size_bound() const { return has_size_bound_; }

  // Input vertices with a corner whose segments are split on shells.
  [[nodiscard]] bool is_acute(VertexId v) const {
    return static_cast<std::size_t>(v) < acute_.size() && acute_[static_cast<std::size_t>(v)] != 0;
  }
  // Input vertices with a corner below the angle bound.
  [[nodiscard]] bool is_narrow(VertexId v) const {
    return static_cast<std::size_t>(v) < acute_.size() &&
           (acute_[static_cast<std::size_t>(v)] & 2) != 0;
  }

  // The ends of the input segment on which a Steiner point lies, in the frame of the point.
  struct SegmentEnds {
    OrbitVertex a;
    OrbitVertex b;
  };
  void set_segment_ends(VertexId v, const SegmentEnds& ends);
  // Takes over what another object knows of the same mesh.
  void adopt_segment_ends(const Criteria& other) { ends_ = other.ends_; }
  // For any vertex of a subsegment that runs from it to `other`: the ends of its input segment in
  // the frame in which the vertices are given.
  [[nodiscard]] SegmentEnds segment_ends(const QuotientTriangulation& mesh,
                                         OrbitVertex v,
                                         OrbitVertex other) const;
  // Whether a Steiner point lies on a segment that ends in a corner narrower than the bound: those
  // stay on their shells, or edges across the corner would shorten without end.
  [[nodiscard]] bool is_shell_vertex(VertexId v) const;

 private:
  // A corner of the input below the bound: between two directions, counter-clockwise.
  struct NarrowCorner {
    VertexId v;
    Point2 from;
    Point2 to;
  };

  [[nodiscard]] double graded_edge_at(const QuotientTriangulation& mesh, VertexId v) const;
  void find_corners(const QuotientTriangulation& mesh);
  void add_corner(const QuotientTriangulation& mesh, VertexId v, Point2 from, Point2 to);
  [[nodiscard]] bool in_narrow_corner(const QuotientTriangulation& mesh,
                                      const Triangle& t,
                                      std::uint32_t i) const;
  [[nodiscard]] bool is_seditious(const QuotientTriangulation& mesh,
                                  const Triangle& t,
                                  const Assessment& assessment) const;

  double goal_angle_ = 0;
  double cos2_goal_ = 1;
  double shell_angle_ = 0;
  double cos_lens_ = 1;  // cos of twice the bound
  double max_edge2_ = 0;
  double min_edge2_ = 0;
  bool keep_boundary_ = false;
  bool has_local_sizes_ = false;
  LocalSizes sizes_;
  struct EdgeAt {
    Point2 p;
    double longest = 0;
  };
  mutable std::vector<EdgeAt> graded_edges_;  // per vertex, for where it was when last asked for
  bool has_size_bound_ = false;
  bool centre_is_narrow_ = false;
  bool centre_is_exact_ = false;
  std::vector<double> max_area_;      // per subdomain orbit
  std::vector<std::uint8_t> acute_;   // per input vertex: bit 0 acute, bit 1 narrow
  std::vector<NarrowCorner> narrow_;  // sorted by vertex
  std::vector<SegmentEnds> ends_;     // per vertex on a segment
};

}  // namespace symcell::plane
