// How long edges may be from place to place, alike in every copy: a size on each of many triangles,
// segments and points, and away from them the smallest of what each allows, growing linearly with
// the distance (gradient limiting: [Persson06], in closed form).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/geometry/point.hpp"
#include "core/geometry/rotation.hpp"

namespace symcell::solid {

// Where none is given but sizes are.
inline constexpr double kStandardGradation = 1.5;

struct SizeSource {
  std::array<Point3, 3> place{};  // of segments and points some corners are equal
  double size = 0;                // input units
};

// What a source of that size allows at a distance.
[[nodiscard]] double allowed_at(double size, double distance, double slope);

// What a source reaches over about the axis, counted in sectors from the x axis; `first` may be below 0.
// All of them if it meets the axis.
struct SectorRange {
  double first = 0;
  double last = 0;
};
[[nodiscard]] SectorRange sectors_of(const SizeSource& source, std::int32_t fold);

class SizeField {
 public:
  // `sources`: in the local frame, of one copy each or of several.  `gradation`: by how much an edge may be
  // longer than the next, > 1.  Cost: O(N log N).
  SizeField(const std::vector<SizeSource>& sources, double gradation, std::int32_t fold);

  // The longest edge of a tetrahedron with its centroid at p. Up to half a source's size from it that is
  // the size itself: there the centroids of what lies on it are.
  // Cost: O(log N) where sizes vary slowly.
  [[nodiscard]] double max_edge(Point3 p) const { return max_edge(p, kNone); }
  // The same, or `enough` if it is no less: most questions are whether a length is allowed, and end at once
  // where it is.
  [[nodiscard]] double max_edge(Point3 p, double enough) const;
  [[nodiscard]] double least() const { return nodes_.empty() ? kNone : nodes_.front().least; }

  // For those who ask about many places, in the first sector:
  [[nodiscard]] Point3 in_first_sector(Point3 p) const;
  // max_edge, of a p that is there.
  [[nodiscard]] double max_edge_there(Point3 p, double enough) const;
  // And of all places within `reach` of c at once.
  // No place there allows more, or less.
  [[nodiscard]] double most_within(Point3 c, double reach) const { return smallest(c, reach); }
  [[nodiscard]] double least_within(Point3 c, double reach) const { return smallest(c, -reach); }
  // Appends the sources that allow less than `most` at some place there. False, with some of them: there
  // are more than `limit`.
  [[nodiscard]] bool list_within(Point3 c,
                                 double reach,
                                 double most,
                                 std::size_t limit,
                                 std::vector<std::int32_t>& list) const;
  [[nodiscard]] double allowed_by(std::int32_t source, Point3 p) const;

 private:
  static constexpr double kNone = std::numeric_limits<double>::infinity();

  struct Node {
    Point3 low;
    Point3 high;
    double least = kNone;
    std::int32_t first = 0;  // sources
    std::int32_t last = 0;
    std::int32_t right = 0;  // the left child follows its parent; 0: a leaf
  };

  [[nodiscard]] std::int32_t sector_of(Point3 p) const;
  std::int32_t build(std::int32_t first, std::int32_t last);
  [[nodiscard]] double distance_to(std::int32_t source, Point3 p) const;
  // No source of the node allows less at a place whose distance to it is `farther` than that of p.
  [[nodiscard]] double bound_of(const Node& node, Point3 p, double farther) const;
  // Smallest of what the sources would allow if they were `farther` from p, or nearer.
  [[nodiscard]] double smallest(Point3 p, double farther) const;
  void look_at(std::int32_t id, Point3 p, double farther, double& best) const;

  RotationTable rotations_;
  double slope_;
  std::vector<SizeSource> sources_;
  std::vector<Node> nodes_;
};

}  // namespace symcell::solid
