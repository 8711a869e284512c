// Bodies that touch: prisms with a body at each side, in single precision as STL files have them.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/model/triangle_surface.hpp"
#include "tests/support/random_surface.hpp"

namespace symcell::test {

enum class Touch : std::uint8_t {
  kFace,       // a face within a side of the prism
  kFlush,      // a face as high as the side
  kWhole,      // a face that is the side
  kHanging,    // a face half beside the side
  kEdge,       // an edge within the side
  kEdgeFlush,  // an edge as high as the side
  kCorner,
};
inline constexpr std::array kTouches = {Touch::kFace,    Touch::kFlush, Touch::kWhole,
                                        Touch::kHanging, Touch::kEdge,  Touch::kEdgeFlush,
                                        Touch::kCorner};

// Over a convex polygon given counter-clockwise.
[[nodiscard]] TriangleSurface prism(const std::vector<std::pair<double, double>>& polygon,
                                    double low,
                                    double high);

// Whether bodies that touch so become one solid; else they stay apart.
[[nodiscard]] bool is_one_solid(Touch touch);

// A body beyond the plane x = `at` that touches it, on the side of a prism of height 1 that is `width` wide.
[[nodiscard]] TriangleSurface body(Touch touch, double at, double width);

// About the z axis, by radians.
void turn(TriangleSurface& surface, double angle);

// A prism of n sides with a body at each, turned by `phase` radians and moved to `centre`.
[[nodiscard]] TriangleSurface prism_with_bodies(std::int32_t n,
                                                Touch touch,
                                                double phase,
                                                Point3 centre);

enum class Assembly : std::uint8_t {
  kPin,       // in a ring, longer than it
  kFlushPin,  // as long as it
  kRings,     // in each other
  kStack,     // of three discs
  kTeeth,     // on a disc, each as wide as its side
  // Within a closed hollow:
  kPillars,   // from its floor to its ceiling, against its wall
  kBrackets,  // against its wall
  kWedges,    // in its wall by a hundredth
  kSpikes,    // with a corner at its wall: they stay apart
};
inline constexpr std::array kAssemblies = {
    Assembly::kPin,     Assembly::kFlushPin, Assembly::kRings,  Assembly::kStack, Assembly::kTeeth,
    Assembly::kPillars, Assembly::kBrackets, Assembly::kWedges, Assembly::kSpikes};

// What bodies that have faces in common become as one.
struct United {
  std::int64_t shells = 1;  // closed surfaces of the boundary
  std::int64_t holes = 0;   // through them
  double overlap = 0;       // volume that bodies have in common
};
[[nodiscard]] United united(std::int32_t n, Assembly kind);

// Bodies of n sides that have whole faces in common, cut into triangles otherwise; turned about all axes by
// what follows of `turns`.
[[nodiscard]] TriangleSurface assembled(std::int32_t n, Assembly kind, Point3 turns, Point3 centre);

// One of all of these.
[[nodiscard]] RandomSurface make_touching_bodies(std::uint64_t seed);

}  // namespace symcell::test
