// A quotient surface whose triangles are changed one by one: stars of vertices, collapses and flips
// as plans that are looked at before they are done.
//
// Sides carry marks: creases of the shape and the curves of the cut stay edges.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/solid/surface/quotient_surface.hpp"

namespace symcell::solid {

// Edges with a larger angle between the normals (35 degrees) are creases, and so are corners where
// a crease turns by more; elsewhere the surface goes on smoothly.
inline constexpr double kCreaseCosine = 0.82;
inline constexpr std::uint8_t kCreaseSide = 1;  // bits of a mark
inline constexpr std::uint8_t kCutSide = 2;     // on a side at the cut

// One triangle as it will be.
struct PlannedTriangle {
  std::int32_t id = 0;
  QuotientTriangle corners;
  std::array<Point3, 3> points;
};

struct CollapsePlan {
  std::int32_t from = 0;  // the vertex that goes
  std::int32_t to = 0;
  std::array<std::int32_t, 2> removed{};  // triangles at the edge
  std::vector<PlannedTriangle> changed;   // the other triangles of `from`
};

struct FlipPlan {
  std::array<PlannedTriangle, 2> changed;
  std::array<std::array<std::uint8_t, 3>, 2> marks{};
};

class EditableSurface {
 public:
  // `surface` is changed in place; removed triangles stay until `compact`.
  // Errors: kInternal (not closed).
  static Result<EditableSurface> create(QuotientSurface& surface);
  // The same with the marks of an editing before.
  static Result<EditableSurface> create(QuotientSurface& surface,
                                        std::vector<std::array<std::uint8_t, 3>> marks);

  [[nodiscard]] const QuotientSurface& surface() const { return *s_; }
  [[nodiscard]] bool alive(std::int32_t t) const { return s_->triangles[t][0].orbit >= 0; }
  [[nodiscard]] const std::vector<std::int32_t>& star(std::int32_t v) const { return stars_[v]; }
  [[nodiscard]] std::uint8_t mark(std::int32_t t, std::int32_t side) const {
    return marks_[t][side];
  }
  [[nodiscard]] std::array<Point3, 3> points(std::int32_t t) const;
  [[nodiscard]] Point3 point(OrbitVertex corner) const {
    return corner_point(*s_, rotations_, corner);
  }
  [[nodiscard]] Plane plane(std::int32_t t) const {
    return rotated(s_->planes[s_->patch[t]], rotations_, s_->frame[t]);
  }

  // A direction at triangle t in the frame in which its corner v has exponent 0.
  [[nodiscard]] Point3 in_frame_of(std::int32_t v, std::int32_t t, Point3 direction) const;

  // The triangle across a side.
  [[nodiscard]] QuotientNeighbour across(std::int32_t t, std::int32_t side) const;

  // Whether the vertex may leave along the side: creases and cuts are left along themselves only,
  // and their corners and ends, and the axis, not at all.
  [[nodiscard]] bool may_leave(std::int32_t t, std::int32_t side, bool from_start) const;

  // Side `side` of triangle t shrinks to its end (or to its start).  Nothing if the topology
  // forbids it.
  [[nodiscard]] std::optional<CollapsePlan> plan_collapse(std::int32_t t,
                                                          std::int32_t side,
                                                          bool to_start) const;
  void collapse(const CollapsePlan& plan);

  // The other diagonal.  Nothing for marked sides and where an edge would be doubled.
  [[nodiscard]] std::optional<FlipPlan> plan_flip(std::int32_t t, std::int32_t side) const;
  void flip(const FlipPlan& plan);

  // Puts a vertex into the middle of a side; the surface stays. The triangles at it as they are
  // then, empty if an edge on the axis or a self-adjacent triangle forbids it.
  [[nodiscard]] std::vector<PlannedTriangle> split(std::int32_t t, std::int32_t side);

  // A vertex at a new place.
  [[nodiscard]] std::vector<PlannedTriangle> plan_move(std::int32_t v, Point3 place) const;
  void move(std::int32_t v, Point3 place) { s_->points[v] = place; }

  // Removes what is dead. Returns what the triangles' numbers were; the object is not to be used
  // afterwards.
  std::vector<std::int32_t> compact();
  [[nodiscard]] const std::vector<std::array<std::uint8_t, 3>>& marks() const { return marks_; }

 private:
  explicit EditableSurface(QuotientSurface& surface) : s_(&surface), rotations_(surface.fold) {}

  struct Neighbour {
    std::int32_t orbit, exponent;
    friend auto operator<=>(const Neighbour&, const Neighbour&) = default;
  };

  void mark_sides(const std::vector<std::array<QuotientNeighbour, 3>>& neighbours);
  [[nodiscard]] std::int32_t exponent_between(OrbitVertex from, OrbitVertex to) const;
  [[nodiscard]] std::vector<Neighbour> ring(std::int32_t v) const;
  // Both corners on one of the two cuts: an edge that is none of the cut's would lie in its plane.
  [[nodiscard]] bool along_one_cut(OrbitVertex a, OrbitVertex b) const;
  [[nodiscard]] bool keeps_cut_clear(const PlannedTriangle& planned,
                                     std::size_t at,
                                     const CollapsePlan& plan) const;
  [[nodiscard]] bool is_joint(std::int32_t v, std::uint8_t mark) const;
  void remove_from_star(std::int32_t v, std::int32_t t);

  QuotientSurface* s_;
  RotationTable rotations_;
  std::vector<std::vector<std::int32_t>> stars_;
  std::vector<std::array<std::uint8_t, 3>> marks_;
};

}  // namespace symcell::solid
