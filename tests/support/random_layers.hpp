// Random solids of stacked prisms (layered_cells.hpp), made from a seed alone, on any axis, of
// any size: facets with several holes, islands in holes, facets that are not convex with material
// beyond the gap, coplanar neighbours with and without a segment between them, edges that end
// inside others, thin webs, tabs, ribs, spokes, pockets, cavities, partitions.
#pragma once

#include <cstdint>
#include <optional>

#include "core/base/random.hpp"
#include "tests/support/random_plc.hpp"
#include "tests/support/random_surface.hpp"

namespace symcell::test {

struct RandomLayersOptions {
  std::int32_t max_fold = 24;
  std::optional<std::int32_t> fold;  // nullopt: random, 1 among them
  bool pinches = true;               // of PLCs: a few models touch themselves in edges or corners
  bool loose = true;                 // partitions and seams that may end anywhere within material
  bool touching = true;              // edges that end inside others: corners not given twice
  bool tabs = false;                 // bodies with tabs and pockets on their sides; folds up to 12
};

// 1 to 8 as a rule, more at times.
[[nodiscard]] std::int32_t random_fold(Random& random, const RandomLayersOptions& options);

// As facets: groups of faces by chance, some of the corners on straight outlines left out.
[[nodiscard]] RandomPlc make_random_layers(std::uint64_t seed,
                                           const RandomLayersOptions& options = {});

// As triangles: the outlines' corners on straight lines by chance, other diagonals in each copy.
// One material, no pinches.
[[nodiscard]] RandomSurface make_random_layer_surface(std::uint64_t seed,
                                                      const RandomLayersOptions& options = {});

}  // namespace symcell::test
