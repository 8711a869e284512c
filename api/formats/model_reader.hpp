// Models from bytes, planar and solid, of any format. Every parser bears hostile input: no
// allocation by a header's word, no recursion by nesting depth, errors name the line or byte.
#pragma once

#include <optional>
#include <string_view>

#include "api/formats/model_format.hpp"
#include "core/base/error.hpp"
#include "core/model/model.hpp"

namespace symcell {

// Larger models are refused (kTooLarge), also as the result of unpacking.
inline constexpr std::size_t kMaxModelBytes = std::size_t{512} << 20;

// `format`: what name or media type promise; the content decides where it is plain. gzip'd bytes
// are unpacked.  `recognised`: where not null, what the bytes turned out to be.
// Errors: the parsing codes (100-110), kNonFinite (with pointer); kIndexOutOfRange and all else
// about the shape is left to the model's validation unless the index does not fit 32 bits.
[[nodiscard]] Result<Model> read_model(std::string_view bytes,
                                       std::optional<ModelFormat> format,
                                       ModelFormat* recognised = nullptr);

}  // namespace symcell
