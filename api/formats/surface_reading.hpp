// What the readers of surfaces with shared vertices have in common.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/model/triangle_surface.hpp"

namespace symcell::internal {

// Appends the polygon `face` (from 0) of a file; corners are vertex indices from 0. `place` begins
// messages ("line 12: ").
// Errors: kDegenerateFacet (fewer than three corners, or one twice), kIndexOutOfRange, kTooLarge.
[[nodiscard]] Result<void> append_face(std::span<const std::int64_t> corners,
                                       std::size_t face,
                                       const std::string& place,
                                       TriangleSurface& surface);

// Names of parts of a surface, given to its triangles in the order of the file.
class PartNames {
 public:
  // Triangles from now on belong to `name`, as it can be shown and written in a line.
  void begin(std::string_view name);
  // To be called after triangles were added.
  void follow(const TriangleSurface& surface) {
    of_triangle_.resize(surface.triangles.size(), now_);
  }
  // Whether there are two parts or more with triangles.
  [[nodiscard]] bool several() const;
  // Gives them to the surface, if there are several.
  void give_to(TriangleSurface& surface) const;

 private:
  std::vector<std::string> names_{"unnamed"};
  std::map<std::string, std::int32_t, std::less<>> numbers_{{"unnamed", 0}};
  std::int32_t now_ = 0;
  std::vector<std::int32_t> of_triangle_;
};

// The surface, once it is complete.  Errors: kDegenerateGeometry if it has no triangles.
[[nodiscard]] Result<TriangleSurface> finished(TriangleSurface surface, const char* format);

}  // namespace symcell::internal
