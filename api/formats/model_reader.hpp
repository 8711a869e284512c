// Models from bytes: PSLG JSON and Triangle `.poly`. Every parser bears hostile input: no allocation
// by a header's word, no recursion by nesting depth, errors name the line or byte.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "core/base/error.hpp"
#include "core/model/pslg.hpp"

namespace symcell {

enum class ModelFormat : std::uint8_t { kPslgJson, kPoly };

// From a file name's ending or a media type; nullopt: tell from the content.
[[nodiscard]] std::optional<ModelFormat> model_format_from_name(std::string_view file_name);
[[nodiscard]] std::optional<ModelFormat> model_format_from_media_type(std::string_view media_type);

// `format` nullopt: guessed from the first bytes.  Errors: the parsing codes (100-110),
// kNonFinite (with pointer), kIndexOutOfRange is left to validate_pslg.
[[nodiscard]] Result<Pslg> read_model(std::string_view bytes, std::optional<ModelFormat> format);

}  // namespace symcell
