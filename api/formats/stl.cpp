#include "api/formats/stl.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>

namespace symcell {
namespace {

constexpr std::size_t kHead = 84;      // 80 bytes of anything, the number of triangles
constexpr std::size_t kTriangle = 50;  // normal, three vertices, two bytes of attributes

std::uint32_t read_u32(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (unsigned i = 0; i < 4; ++i) {
    value |= std::uint32_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
  }
  return value;
}

float read_float(std::string_view bytes, std::size_t at) {
  return std::bit_cast<float>(read_u32(bytes, at));
}

std::uint32_t stated_count(std::string_view bytes) {
  return read_u32(bytes, 80);
}

// The triangles the header promises are there. In a text, bytes 80 to 83 would be the number of
// more triangles than any file has.
bool count_fits(std::string_view bytes) {
  return bytes.size() >= kHead && (bytes.size() - kHead) / kTriangle >= stated_count(bytes);
}

bool is_text(std::string_view bytes) {
  return std::ranges::all_of(bytes.substr(0, 512), [](char c) {
    const auto u = static_cast<unsigned char>(c);
    return u >= ' ' || u == '\t' || u == '\n' || u == '\r' || u == '\f' || u == '\v';
  });
}

Failure wrong_count(std::string_view bytes, ErrorCode code, const std::string& what) {
  return fail(code, "binary STL: the header says " + std::to_string(stated_count(bytes)) +
                        " triangles, " + what + "; was the file written completely?");
}

Result<TriangleSurface> read_binary_stl(std::string_view bytes) {
  if (bytes.size() < kHead) {
    return fail(ErrorCode::kTruncated, "the file ends in the head of a binary STL, after " +
                                           std::to_string(bytes.size()) + " of 84 bytes");
  }
  const std::uint32_t count = stated_count(bytes);
  const std::size_t whole = (bytes.size() - kHead) / kTriangle;
  const std::size_t rest = (bytes.size() - kHead) % kTriangle;
  if (whole < count && rest != 0) {
    return wrong_count(bytes, ErrorCode::kTruncated,
                       "the file ends in the middle of triangle " + std::to_string(whole));
  }
  if (whole < count) {
    return wrong_count(bytes, ErrorCode::kCountMismatch, std::to_string(whole) + " follow");
  }
  // A few bytes of padding are borne, further triangles are not passed over in silence.
  const std::string_view after = bytes.substr(kHead + std::size_t{count} * kTriangle);
  if (after.size() >= kTriangle && std::ranges::any_of(after, [](char c) { return c != 0; })) {
    return wrong_count(bytes, ErrorCode::kCountMismatch,
                       std::to_string(after.size()) + " bytes follow the last one");
  }
  if (count > kMaxSurfaceTriangles) {
    return fail(ErrorCode::kTooLarge, std::to_string(count) + " triangles; at most " +
                                          std::to_string(kMaxSurfaceTriangles) + " are taken");
  }
  TriangleSurface surface;
  surface.vertices.reserve(std::size_t{3} * count);
  surface.triangles.reserve(count);
  for (std::size_t t = 0; t < count; ++t) {
    const std::size_t at = kHead + t * kTriangle;
    for (std::size_t v = 0; v < 3; ++v) {
      const std::size_t place = at + 12 * (v + 1);
      const Point3 p{read_float(bytes, place), read_float(bytes, place + 4),
                     read_float(bytes, place + 8)};
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
        return fail(ErrorCode::kNonFinite,
                    "triangle " + std::to_string(t) + " (byte " + std::to_string(place) +
                        "): a coordinate of its vertex " + std::to_string(v) + " is not finite",
                    {static_cast<std::int64_t>(t)}, "/triangles/" + std::to_string(t));
      }
      surface.vertices.push_back(p);
    }
    const auto first = static_cast<std::int32_t>(3 * t);
    surface.triangles.push_back({first, first + 1, first + 2});
  }
  return surface;
}

// Without a fitting count: 80 bytes of text, then a triangle of sane numbers.
bool has_binary_head(std::string_view bytes) {
  if (bytes.size() < kHead + kTriangle || is_text(bytes.substr(0, kHead + kTriangle))) return false;
  const bool texty = std::ranges::all_of(bytes.substr(0, 80), [](char c) {
    return (c >= ' ' && c <= '~') || c == 0 || c == '\n' || c == '\r' || c == '\t';
  });
  constexpr float kSane = 1e30F;
  for (std::size_t i = 0; i < 12; ++i) {
    if (!(std::abs(read_float(bytes, kHead + 4 * i)) < kSane)) return false;
  }
  return texty;
}

}  // namespace

bool has_size_of_binary_stl(std::string_view bytes) {
  return bytes.size() >= kHead &&
         bytes.size() == kHead + std::size_t{stated_count(bytes)} * kTriangle;
}

bool looks_like_binary_stl(std::string_view bytes) {
  return has_size_of_binary_stl(bytes) || has_binary_head(bytes);
}

Result<TriangleSurface> read_stl(std::string_view bytes) {
  const bool text = is_text(bytes);
  auto surface =
      text && !count_fits(bytes) ? internal::read_ascii_stl(bytes) : read_binary_stl(bytes);
  if (surface && surface->triangles.empty()) {
    return fail(ErrorCode::kDegenerateGeometry, "the STL file has no triangles");
  }
  return surface;
}

}  // namespace symcell
