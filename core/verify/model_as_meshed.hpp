// The planar model that a mesh is to be compared with: joined, mended and completed as asked for,
// its arcs as chords between the nodes that the mesh has on them.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/model/pslg.hpp"
#include "core/verify/verify_mesh.hpp"

namespace symcell::internal {

struct ModelAsMeshed {
  Pslg pslg;                        // straight
  std::vector<Point3> arc_middles;  // of the chords' arcs: where mid-side nodes may be
  std::string coarse;               // names an arc that has too few nodes; empty: none
};

// Nothing where the model is taken as it is.
// `corners`: of all elements of the full mesh.  `rotate`: by one step of the cell's fold; null: that is 1.
// Errors: those of plane::prepare_input.
[[nodiscard]] Result<std::optional<ModelAsMeshed>> model_as_meshed(
    const Pslg& model,
    std::span<const Point3> corners,
    const std::function<Point3(const Point3&)>& rotate,
    const VerifyOptions& options);

}  // namespace symcell::internal
