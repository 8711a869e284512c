// Edges between copies of vertices, grouped into orbits of segments.
#pragma once

#include <tuple>
#include <vector>

#include "core/geometry/rotation.hpp"
#include "core/plane/symmetry/orbit_closure.hpp"

namespace symcell::plane {

class EdgeOrbits {
 public:
  EdgeOrbits(const RotationTable& rotations, std::int32_t centre_orbit, bool ignore_markers)
      : rotations_(rotations), centre_orbit_(centre_orbit), ignore_markers_(ignore_markers) {}

  void reserve(std::size_t edges) { copies_.reserve(edges); }

  // `edge`: of which from -> to is a part, in its direction.
  void add(OrbitVertex from, OrbitVertex to, const PreparedEdge& edge);

  // Fills segments, markers and sides. Each orbit must be there `fold` times, with the same classes
  // of faces beside it and, unless ignored, the same marker.
  // Errors: kNotSymmetric, with the segments at fault.  Cost: O(N log N).
  [[nodiscard]] Result<void> close(ClosedOrbits& result);

 private:
  // One copy, written with the vertex of the smaller orbit first, the centre last.
  struct Copy {
    std::int32_t a = 0;  // orbits
    std::int32_t b = 0;
    std::int32_t turn = 0;      // exponent of b less that of a
    std::int32_t exponent = 0;  // of a
    std::int32_t marker = 0;
    std::int32_t left = 0;
    std::int32_t right = 0;
    ClosedOrbits::Sides labels;
    std::int32_t segment = 0;

    [[nodiscard]] auto orbit() const { return std::tie(a, b, turn); }
  };

  [[nodiscard]] std::int32_t fold() const { return rotations_.fold(); }
  [[nodiscard]] bool markers_are_uniform() const;
  [[nodiscard]] Result<void> check_orbit(std::size_t begin, std::size_t end) const;
  [[nodiscard]] Result<void> check_alike(const Copy& first, const Copy& other) const;
  void add_segment(std::size_t begin, ClosedOrbits& result) const;

  const RotationTable& rotations_;
  std::int32_t centre_orbit_;
  bool ignore_markers_;
  std::vector<Copy> copies_;
};

}  // namespace symcell::plane
