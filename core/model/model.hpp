// What a user may ask to have meshed.
#pragma once

#include <cstdint>
#include <variant>

#include "core/model/plc.hpp"
#include "core/model/pslg.hpp"
#include "core/model/triangle_surface.hpp"

namespace symcell {

using Model = std::variant<Pslg, Plc, TriangleSurface>;

// In the order of Model's alternatives.
enum class ModelKind : std::uint8_t { kPslg, kPlc, kSurface };

[[nodiscard]] inline ModelKind kind_of(const Model& model) {
  return static_cast<ModelKind>(model.index());
}

[[nodiscard]] inline bool is_planar(ModelKind kind) {
  return kind == ModelKind::kPslg;
}

}  // namespace symcell
