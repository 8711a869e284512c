#include "api/formats/model_format.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>

namespace symcell {
namespace {

constexpr std::array<ModelFormatInfo, 13> kFormats{{
    {ModelFormat::kPslgJson, ModelKind::kPslg, "pslg_json", ".json", "application/json"},
    {ModelFormat::kPlcJson, ModelKind::kPlc, "plc_json", ".json", "application/json"},
    {ModelFormat::kPoly, ModelKind::kPslg, "poly", ".poly", "text/plain"},
    {ModelFormat::kTetgenPoly, ModelKind::kPlc, "tetgen_poly", ".poly", "text/plain"},
    {ModelFormat::kSmesh, ModelKind::kPlc, "smesh", ".smesh", "text/plain"},
    {ModelFormat::kStl, ModelKind::kSurface, "stl", ".stl", "model/stl"},
    {ModelFormat::kOff, ModelKind::kSurface, "off", ".off", "model/vnd.off"},
    {ModelFormat::kPly, ModelKind::kSurface, "ply", ".ply", "model/ply"},
    {ModelFormat::kObj, ModelKind::kSurface, "obj", ".obj", "model/obj"},
    {ModelFormat::kDxf, ModelKind::kPslg, "dxf", ".dxf", "image/vnd.dxf"},
    {ModelFormat::kFem, ModelKind::kPslg, "fem", ".fem", "text/plain"},
    {ModelFormat::kStep, ModelKind::kSurface, "step", ".step", "model/step"},
    {ModelFormat::kIges, ModelKind::kSurface, "iges", ".iges", "model/iges"},
}};

// What else a format may be called by those who send it.
constexpr std::array kMediaTypes{
    std::pair{"application/json", ModelFormat::kPslgJson},
    std::pair{"model/x-triangle-poly", ModelFormat::kPoly},
    std::pair{"application/x-poly", ModelFormat::kPoly},
    std::pair{"text/x-poly", ModelFormat::kPoly},
    std::pair{"model/x-tetgen-poly", ModelFormat::kTetgenPoly},
    std::pair{"model/x-smesh", ModelFormat::kSmesh},
    std::pair{"model/stl", ModelFormat::kStl},
    std::pair{"model/x.stl-ascii", ModelFormat::kStl},
    std::pair{"model/x.stl-binary", ModelFormat::kStl},
    std::pair{"application/sla", ModelFormat::kStl},
    std::pair{"application/vnd.ms-pki.stl", ModelFormat::kStl},
    std::pair{"model/vnd.off", ModelFormat::kOff},
    std::pair{"model/off", ModelFormat::kOff},
    std::pair{"application/x-off", ModelFormat::kOff},
    std::pair{"model/ply", ModelFormat::kPly},
    std::pair{"application/ply", ModelFormat::kPly},
    std::pair{"application/x-ply", ModelFormat::kPly},
    std::pair{"model/obj", ModelFormat::kObj},
    std::pair{"application/x-tgif", ModelFormat::kObj},  // what some systems take .obj for
    std::pair{"image/vnd.dxf", ModelFormat::kDxf},
    std::pair{"image/x-dxf", ModelFormat::kDxf},
    std::pair{"application/dxf", ModelFormat::kDxf},
    std::pair{"application/x-dxf", ModelFormat::kDxf},
    std::pair{"model/x-femm", ModelFormat::kFem},
    std::pair{"model/step", ModelFormat::kStep},
    std::pair{"application/step", ModelFormat::kStep},
    std::pair{"application/x-step", ModelFormat::kStep},
    std::pair{"application/p21", ModelFormat::kStep},
    std::pair{"application/iso-10303-21", ModelFormat::kStep},
    std::pair{"model/iges", ModelFormat::kIges},
    std::pair{"application/iges", ModelFormat::kIges},
};

// Endings that are in use beside the first.
constexpr std::array kOtherEndings{
    std::pair{".stp", ModelFormat::kStep},
    std::pair{".p21", ModelFormat::kStep},
    std::pair{".igs", ModelFormat::kIges},
};

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

}  // namespace

const ModelFormatInfo& model_format_info(ModelFormat format) {
  return kFormats[static_cast<std::size_t>(format)];
}

std::optional<ModelFormat> model_format_of_name(std::string_view name) {
  const auto* found = std::ranges::find(kFormats, name, &ModelFormatInfo::name);
  if (found == kFormats.end()) return std::nullopt;
  return found->format;
}

std::optional<ModelFormat> model_format_from_name(std::string_view file_name) {
  std::string name = lower(file_name);
  if (name.ends_with(".gz")) name.resize(name.size() - 3);
  // The first of the two that share an ending stands for both.
  const auto* found = std::ranges::find_if(
      kFormats, [&](const ModelFormatInfo& f) { return name.ends_with(f.ending); });
  if (found != kFormats.end()) return found->format;
  const auto* other = std::ranges::find_if(
      kOtherEndings, [&](const auto& ending) { return name.ends_with(ending.first); });
  if (other == kOtherEndings.end()) return std::nullopt;
  return other->second;
}

std::optional<ModelFormat> model_format_from_media_type(std::string_view media_type) {
  std::string type = lower(media_type.substr(0, media_type.find(';')));
  while (!type.empty() && type.back() == ' ') type.pop_back();
  if (type.ends_with("+json")) return ModelFormat::kPslgJson;
  const auto* found =
      std::ranges::find_if(kMediaTypes, [&](const auto& known) { return type == known.first; });
  if (found == kMediaTypes.end()) return std::nullopt;
  return found->second;
}

}  // namespace symcell
