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

}  // namespace

std::string describe_number(double value) {
  return to_text(value);
}

std::string describe_rounded(double value) {
  return to_text(value, std::chars_format::general, 6);
}

std::string describe_point(Point2 p) {
  return "(" + describe_number(p.x) + ", " + describe_number(p.y) + ")";
}

std::string describe_point(Point3 p) {
  return "(" + describe_number(p.x) + ", " + describe_number(p.y) + ", " + describe_number(p.z) +
         ")";
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

}  // namespace symcell
