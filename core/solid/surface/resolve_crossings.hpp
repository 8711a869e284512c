// A closed surface that crosses, touches or covers itself becomes one that does not.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/geometry/indexed_surface.hpp"
#include "core/solid/surface/sheets.hpp"

namespace symcell::solid {

struct Resolved {
  IndexedSurface surface;
  double overlap_volume = 0;   // was inside twice
  double inverted_volume = 0;  // was inside the wrong way round, and is outside now
  double cancelled_area = 0;   // of faces that lay on each other from both sides
  std::size_t voids = 0;       // between bodies, thinner than the tolerance: filled
  double void_volume = 0;
  Touching split;  // where the solid touched itself
  double gap = 0;  // the sheets there are now so far from where they were
};

// Of what the surface winds round, the boundary, with two triangles an edge and no intersections.
// Voids between united bodies that are thinner than the tolerance are filled.
// `contact`: bodies were put so deep into each other where they only touch (deepen_contacts); what is no
// wider than they overlap by it is closed again. 0: none were.
// Nothing, and `reason` says why, where the result would not be the same shape within `tolerance`
// or could not be made.
// `pairs`: all intersecting triangles, with equal points of the surface one.
// Requires: as many triangles one way as the other at every edge, outside in front.
// Errors: limits.
[[nodiscard]] Result<std::optional<Resolved>> resolve_crossings(
    const IndexedSurface& surface,
    std::span<const std::pair<std::int32_t, std::int32_t>> pairs,
    double tolerance,
    double contact,
    ExecutionContext& context,
    std::string& reason);

}  // namespace symcell::solid
