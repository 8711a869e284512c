// How error messages name the entities of a PSLG.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/geometry/point.hpp"
#include "core/model/pslg.hpp"

namespace symcell {

// Shortest decimal that reads back the same double, whatever the locale.
[[nodiscard]] std::string describe_number(double value);
// Six significant digits: for measured quantities.
[[nodiscard]] std::string describe_rounded(double value);
// "(1.5, 2)"
[[nodiscard]] std::string describe_point(Point2 p);
[[nodiscard]] std::string describe_point(Point3 p);
// "vertex 3 at (1.5, 2)"
[[nodiscard]] std::string describe_vertex(std::span<const Point2> vertices, std::int64_t vertex);
// "segment 7 (vertices 3-4)"
[[nodiscard]] std::string describe_segment(std::span<const Point2> vertices,
                                           std::span<const PslgSegment> segments,
                                           std::int64_t segment);

}  // namespace symcell
