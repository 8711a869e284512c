// Models from bytes, planar and solid, of any format. Every parser bears hostile input: no
// allocation by a header's word, no recursion by nesting depth, errors name the line or byte.
#pragma once

#include <optional>
#include <string_view>

#include "api/formats/model_format.hpp"
#include "core/base/error.hpp"
#include "core/model/mesh_options.hpp"
#include "core/model/model.hpp"

namespace symcell {

// Larger models are refused (kTooLarge), also as the result of unpacking.
inline constexpr std::size_t kMaxModelBytes = std::size_t{512} << 20;

// What a reader is told of how the model is used.
struct ReadOptions {
  // STEP and IGES: of the triangles from curved faces, as a share of their radius.
  double cad_chord_error_rel = 1e-3;
};

// `format`: what name or media type promise; the content decides where it is plain. gzip'd bytes
// are unpacked.  `recognised`: where not null, what the bytes turned out to be.
// Errors: the parsing codes (100-110), kNonFinite (with pointer); kIndexOutOfRange and all else
// about the shape is left to the model's validation unless the index does not fit 32 bits.
[[nodiscard]] Result<Model> read_model(std::string_view bytes,
                                       std::optional<ModelFormat> format,
                                       ModelFormat* recognised = nullptr,
                                       const ReadOptions& options = {});

// As a mesh of these options needs it.
[[nodiscard]] ReadOptions reading_for(const MeshOptions& options);

}  // namespace symcell
