// The laws of what the readers of surfaces hand out.
#pragma once

#include <cmath>

#include "core/base/error.hpp"
#include "core/model/triangle_surface.hpp"
#include "tests/fuzz/fuzz_support.hpp"

namespace symcell::fuzz {

inline void check_surface(const Result<TriangleSurface>& surface, std::size_t size) {
  if (!surface) return require_good_message(surface.error());
  require(!surface->triangles.empty(), "a surface has triangles");
  require(surface->vertices.size() <= size && surface->triangles.size() <= size,
          "no more entries than bytes");
  require(surface->source_face.empty() || surface->source_face.size() == surface->triangles.size(),
          "every triangle has its face, or none");
  const auto count = static_cast<std::int32_t>(surface->vertices.size());
  for (const auto& triangle : surface->triangles) {
    for (const std::int32_t v : triangle) require(v >= 0 && v < count, "corners are vertices");
  }
  for (const Point3& p : surface->vertices) {
    require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z),
            "coordinates are finite");
  }
}

}  // namespace symcell::fuzz
