// Models of the benchmarks: flanges by rule, and the area bound that gives them a wanted size.
#pragma once

#include <cstdint>

#include "core/plane/mesh_pslg.hpp"

namespace symcell::bench {

// A disc with a bore and `fold` round holes.
[[nodiscard]] Pslg flange_of(std::int32_t fold);

// Options under which the full mesh has about `triangles` triangles; the mesh shows how many it is.
// `plain`: as MeshOptions::plain, which takes more triangles for the same bound.
[[nodiscard]] MeshOptions sized_options(const Pslg& model,
                                        std::int32_t fold,
                                        double triangles,
                                        bool plain);

// mesh_pslg that must succeed: aborts with the error's message.
[[nodiscard]] MeshOutcome mesh(const Pslg& model, const MeshOptions& options);

}  // namespace symcell::bench
