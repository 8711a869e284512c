// How error messages name numbers, points and the entities of a PSLG.
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
// "(1.5, 2)", to at most nine significant digits.
[[nodiscard]] std::string describe_point(Point2 p);
[[nodiscard]] std::string describe_point(Point3 p);
// "vertex 3 at (1.5, 2)"
[[nodiscard]] std::string describe_vertex(std::span<const Point2> vertices, std::int64_t vertex);
// "segment 7 (vertices 3-4)"
[[nodiscard]] std::string describe_segment(std::span<const Point2> vertices,
                                           std::span<const PslgSegment> segments,
                                           std::int64_t segment);
// "vertices 3 and 4 are both at (1.5, 2); keep one and let the segments refer to it"; the second
// for vertices that are nearer to each other than the model's coordinates resolve.
// `place`: of the second vertex.  `users`: "segments" or "facets".
[[nodiscard]] std::string describe_duplicates(std::int64_t first,
                                              std::int64_t second,
                                              const std::string& place,
                                              const char* users);
[[nodiscard]] std::string describe_near_duplicates(std::int64_t first,
                                                   std::int64_t second,
                                                   const std::string& place,
                                                   double distance,
                                                   const char* users);

}  // namespace symcell
