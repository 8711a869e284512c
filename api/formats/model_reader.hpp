// Models from bytes: PSLG JSON and Triangle `.poly`. Every parser bears hostile input: no
// allocation by a header's word, no recursion by nesting depth, errors name the line or byte.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "core/base/error.hpp"
#include "core/model/pslg.hpp"

namespace symcell {

// Larger models are refused (kTooLarge), also as the result of unpacking.
inline constexpr std::size_t kMaxModelBytes = std::size_t{512} << 20;

enum class ModelFormat : std::uint8_t { kPslgJson, kPoly };

// From a file name's ending (also before .gz) or a media type; nullopt: tell from the content.
[[nodiscard]] std::optional<ModelFormat> model_format_from_name(std::string_view file_name);
[[nodiscard]] std::optional<ModelFormat> model_format_from_media_type(std::string_view media_type);

// `format` nullopt: guessed from the first bytes.  gzip'd bytes are unpacked.  Errors: the parsing
// codes (100-110), kNonFinite (with pointer), kUnsupportedModel (STL, OFF, PLC JSON, ...: a solid);
// kIndexOutOfRange is left to validate_pslg unless the index does not fit 32 bits.
[[nodiscard]] Result<Pslg> read_model(std::string_view bytes, std::optional<ModelFormat> format);

}  // namespace symcell
