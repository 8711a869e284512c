#include "api/formats/surface_reading.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "api/printable.hpp"
#include "core/model/polygon_triangles.hpp"

namespace symcell::internal {
namespace {

constexpr std::size_t kLongestName = 100;  // characters

}  // namespace

Result<void> append_face(std::span<const std::int64_t> corners,
                         std::size_t face,
                         const std::string& place,
                         TriangleSurface& surface) {
  const auto complain = [&](ErrorCode code, const std::string& what) {
    return fail(code, place + "face " + std::to_string(face) + " " + what,
                {static_cast<std::int64_t>(face)}, "/faces/" + std::to_string(face));
  };
  if (corners.size() < 3) {
    return complain(ErrorCode::kDegenerateFacet,
                    "has " + std::to_string(corners.size()) + " corners; it needs three");
  }
  if (surface.triangles.size() + corners.size() > kMaxSurfaceTriangles) {
    return complain(ErrorCode::kTooLarge,
                    "is beyond " + std::to_string(kMaxSurfaceTriangles) + " triangles");
  }
  std::vector<std::int32_t> polygon;
  polygon.reserve(corners.size());
  for (const std::int64_t corner : corners) {
    if (corner < 0 || corner >= static_cast<std::int64_t>(surface.vertices.size())) {
      return complain(ErrorCode::kIndexOutOfRange,
                      "has the vertex " + std::to_string(corner) + "; there are " +
                          std::to_string(surface.vertices.size()) + " vertices, counted from 0");
    }
    polygon.push_back(static_cast<std::int32_t>(corner));
  }
  auto done = append_polygon(polygon, static_cast<std::int32_t>(face), surface);
  if (!done) done.error().message.insert(0, place);
  return done;
}

void PartNames::begin(std::string_view name) {
  const std::size_t first = name.find_first_not_of(" \t\r\v\f");
  const std::size_t last = name.find_last_not_of(" \t\r\v\f");
  const std::string shown = first == std::string_view::npos
                                ? std::string("unnamed")
                                : printable(name.substr(first, last - first + 1), kLongestName);
  const auto [place, fresh] = numbers_.try_emplace(shown, static_cast<std::int32_t>(names_.size()));
  if (fresh) names_.push_back(shown);
  now_ = place->second;
}

bool PartNames::several() const {
  return std::ranges::any_of(of_triangle_,
                             [this](std::int32_t part) { return part != of_triangle_.front(); });
}

void PartNames::give_to(TriangleSurface& surface) const {
  if (!several()) return;
  // Only those with triangles, in the order of the file.
  std::vector<std::int32_t> renumbered(names_.size(), -1);
  for (const std::int32_t part : of_triangle_) {
    std::int32_t& number = renumbered[static_cast<std::size_t>(part)];
    if (number < 0) {
      number = static_cast<std::int32_t>(surface.group_names.size());
      surface.group_names.push_back(names_[static_cast<std::size_t>(part)]);
    }
    surface.groups.push_back(number);
  }
}

Result<TriangleSurface> finished(TriangleSurface surface, const char* format) {
  if (surface.triangles.empty()) {
    return fail(ErrorCode::kDegenerateGeometry,
                std::string("the ") + format + " file has no faces: it describes no solid");
  }
  // Where all faces are triangles their own indices say the same.
  bool polygons = false;
  for (std::size_t t = 0; t < surface.source_face.size() && !polygons; ++t) {
    polygons = surface.source_face[t] != static_cast<std::int32_t>(t);
  }
  if (!polygons) surface.source_face.clear();
  return surface;
}

}  // namespace symcell::internal
