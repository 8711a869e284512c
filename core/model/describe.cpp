#include "core/model/describe.hpp"

#include <array>
#include <charconv>

namespace symcell {
namespace {

template <class... Format>
std::string to_text(double value, Format... format) {
  std::array<char, 40> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, format...);
  return {buffer.data(), end.ptr};
}

// A coordinate: as it was given where that is short, else to as many digits as find the place.
// STL files have 9 significant digits at most; more are of computed points.
std::string coordinate(double value) {
  const std::string given = to_text(value), rounded = to_text(value, std::chars_format::general, 9);
  return given.size() <= rounded.size() ? given : rounded;
}

std::string two_vertices(std::int64_t first, std::int64_t second) {
  return "vertices " + std::to_string(first) + " and " + std::to_string(second);
}

std::string advice(const char* users) {
  return std::string("; keep one and let the ") + users + " refer to it";
}

}  // namespace

std::string describe_number(double value) {
  return to_text(value);
}

std::string describe_rounded(double value) {
  return to_text(value, std::chars_format::general, 6);
}

std::string describe_point(Point2 p) {
  return "(" + coordinate(p.x) + ", " + coordinate(p.y) + ")";
}

std::string describe_point(Point3 p) {
  return "(" + coordinate(p.x) + ", " + coordinate(p.y) + ", " + coordinate(p.z) + ")";
}

std::string describe_vertex(std::span<const Point2> vertices, std::int64_t vertex) {
  return "vertex " + std::to_string(vertex) + " at " +
         describe_point(vertices[static_cast<std::size_t>(vertex)]);
}

std::string describe_segment(std::span<const Point2> vertices,
                             std::span<const PslgSegment> segments,
                             std::int64_t segment) {
  const PslgSegment& s = segments[static_cast<std::size_t>(segment)];
  const auto end = [&](std::int32_t v) {
    return std::to_string(v) + " " + describe_point(vertices[static_cast<std::size_t>(v)]);
  };
  return "segment " + std::to_string(segment) + " (vertices " + end(s.a) + " to " + end(s.b) + ")";
}

std::string describe_duplicates(std::int64_t first,
                                std::int64_t second,
                                const std::string& place,
                                const char* users) {
  return two_vertices(first, second) + " are both at " + place + advice(users);
}

std::string describe_near_duplicates(std::int64_t first,
                                     std::int64_t second,
                                     const std::string& place,
                                     double distance,
                                     const char* users) {
  return two_vertices(first, second) + " at " + place + " are only " + describe_rounded(distance) +
         " apart, which is rounding in a model of this size" + advice(users);
}

}  // namespace symcell
