// Why a surface is refused: counts, triangles and places, and what would help.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/geometry/indexed_surface.hpp"
#include "core/model/mesh_options.hpp"

namespace symcell::solid {

struct OddEdge {
  std::int32_t a, b;
  std::int32_t triangle;
  std::size_t uses;
};

// Edges with one triangle, three, and so on.
[[nodiscard]] std::vector<OddEdge> odd_edges(const IndexedSurface& surface);
// Edges with four triangles, six, and so on.
[[nodiscard]] std::vector<OddEdge> branching_edges(const IndexedSurface& surface);

// "1 hole", "2 holes".
[[nodiscard]] std::string plural(std::size_t count, const std::string& noun);
// ", such as at (0, 0, 0); (1, 2, 3)": the first few places; nothing if there are none.
[[nodiscard]] std::string such_as_at(std::span<const Point3> places);
// " near (1, 2, 3)" of the middle of a triangle.
[[nodiscard]] std::string near_triangle(const IndexedSurface& surface, std::int32_t triangle);
// Elements of an error: sorted, each once, at most a hundred or so.
[[nodiscard]] std::vector<std::int64_t> listed(std::vector<std::int64_t> triangles);

// kNotWatertight; `edges` of `surface`, not empty.
[[nodiscard]] Error refuse_open(const IndexedSurface& surface,
                                const std::vector<OddEdge>& edges,
                                const std::string& help);
// The same of edges with four and more triangles, if there are any, else kSelfIntersection at the `places`.
[[nodiscard]] Error refuse_touching(const IndexedSurface& surface,
                                    std::span<const Point3> places,
                                    const std::string& help);
// kSelfIntersection; `more`: there are more pairs than these. `reason`: why they were not mended,
// or nothing.
[[nodiscard]] Error refuse_intersecting(
    const IndexedSurface& surface,
    std::span<const std::pair<std::int32_t, std::int32_t>> pairs,
    bool more,
    const std::string& reason,
    const std::string& help);

}  // namespace symcell::solid
