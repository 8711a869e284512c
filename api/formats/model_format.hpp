// The formats of models: their names, endings and media types.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "core/model/model.hpp"

namespace symcell {

enum class ModelFormat : std::uint8_t {
  kPslgJson,
  kPlcJson,
  kPoly,        // planar: Triangle's
  kTetgenPoly,  // solid: TetGen's
  kSmesh,
  kStl,
  kOff,
  kPly,
  kObj,
  kDxf,
  kFem,  // FEMM's
  kStep,
  kIges
};

struct ModelFormatInfo {
  ModelFormat format;
  ModelKind kind;
  std::string_view name;        // in job documents and the job store; never changed
  std::string_view ending;      // of a file, with the dot
  std::string_view media_type;  // as which a model is sent back
};

[[nodiscard]] const ModelFormatInfo& model_format_info(ModelFormat format);
[[nodiscard]] std::optional<ModelFormat> model_format_of_name(std::string_view name);

// What a file name's ending (also before .gz) or a media type promises; nullopt: see the
// content. The two kinds of JSON and of .poly are told apart by the content only: here they are
// kPslgJson and kPoly.
[[nodiscard]] std::optional<ModelFormat> model_format_from_name(std::string_view file_name);
[[nodiscard]] std::optional<ModelFormat> model_format_from_media_type(std::string_view media_type);

}  // namespace symcell
