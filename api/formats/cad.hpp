// STEP and IGES, read by OpenCASCADE in a child process of its own, which loads it (cad/cad_module.hpp).
#pragma once

#include <string>
#include <string_view>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/model/triangle_surface.hpp"

namespace symcell {

enum class CadFormat : std::uint8_t { kStep, kIges };

// "OpenCASCADE 7.6.3"; empty: this build has none.
[[nodiscard]] std::string_view cad_library();

// By how a file begins.
[[nodiscard]] bool looks_like_step(std::string_view bytes);
[[nodiscard]] bool looks_like_iges(std::string_view bytes);

// The faces that bound the solids of a file, in millimetres, closed where the file's are, with chords no
// farther from curved faces than `chord_error_rel` of their radius.
// Errors: kSyntax, kDegenerateGeometry (no solid), kTooLarge, kUnsupportedModel (no OpenCASCADE, or faces
// that it cannot divide), kTimeLimit, kMemoryLimit, limits of the context.
[[nodiscard]] Result<TriangleSurface> read_cad(std::string_view bytes,
                                               CadFormat format,
                                               double chord_error_rel,
                                               ExecutionContext& context);

}  // namespace symcell
