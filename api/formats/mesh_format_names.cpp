#include <algorithm>
#include <array>
#include <cctype>
#include <string>

#include "api/formats/mesh_writer.hpp"
#include "api/formats/text_numbers.hpp"

namespace symcell {
namespace {

struct FormatName {
  MeshFormat format;
  std::string_view name;
  std::string_view media_type;
  std::int32_t dimension;  // of the meshes it shows; 0: any
};

// In the order of preference where a client accepts several alike.
constexpr std::array<FormatName, 11> kFormats{{
    {MeshFormat::kVtu, "vtu", "application/vnd.vtk.vtu+xml", 0},
    {MeshFormat::kJson, "json", "application/json", 0},
    {MeshFormat::kMsh, "msh", "model/x-gmsh", 0},
    {MeshFormat::kMsh2, "msh2", "model/x-gmsh", 0},
    {MeshFormat::kInp, "inp", "model/x-abaqus", 0},
    {MeshFormat::kBdf, "bdf", "model/x-nastran", 0},
    {MeshFormat::kCdb, "cdb", "model/x-ansys", 0},
    {MeshFormat::kVtp, "vtp", "application/vnd.vtk.vtp+xml", 0},
    {MeshFormat::kGlb, "glb", "model/gltf-binary", 0},
    {MeshFormat::kSvg, "svg", "image/svg+xml", 2},
    {MeshFormat::kStl, "stl", "model/stl", 3},
}};

const FormatName& row(MeshFormat format) {
  return *std::ranges::find(kFormats, format, &FormatName::format);
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

std::string_view trim(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

// Takes what stands before `separator` off the front of `rest`.
std::string_view next_part(std::string_view& rest, char separator) {
  const std::size_t end = std::min(rest.find(separator), rest.size());
  const std::string_view part = trim(rest.substr(0, end));
  rest.remove_prefix(std::min(end + 1, rest.size()));
  return part;
}

// One media range of an Accept header.
struct Range {
  std::string type;
  double q = 1;
};

Range parse_range(std::string_view text) {
  Range range{lower(next_part(text, ';')), 1};
  while (!text.empty()) {
    const std::string parameter = lower(next_part(text, ';'));
    if (!parameter.starts_with("q=")) continue;
    const ParsedNumber q = parse_number(std::string_view(parameter).substr(2));
    range.q = q.kind == NumberKind::kFinite ? std::clamp(q.value, 0.0, 1.0) : 0;
  }
  return range;
}

// How closely a range names a type: 3 exactly, 2 by "model/*", 1 by "*/*", 0 not at all.
int closeness(const std::string& range, std::string_view type) {
  if (range == type) return 3;
  if (range == "*/*") return 1;
  return range.ends_with("/*") && type.starts_with(range.substr(0, range.size() - 1)) ? 2 : 0;
}

}  // namespace

std::string mesh_format_list() {
  std::string list;
  for (const FormatName& format : kFormats) {
    if (!list.empty()) list += format.format == kFormats.back().format ? " or " : ", ";
    list += format.name;
  }
  return list;
}

std::optional<MeshFormat> mesh_format_from_name(std::string_view name) {
  if (name.starts_with('.')) name.remove_prefix(1);
  const std::string wanted = lower(name);
  const auto* found = std::ranges::find(kFormats, wanted, &FormatName::name);
  if (found == kFormats.end()) return std::nullopt;
  return found->format;
}

std::string_view mesh_format_name(MeshFormat format) {
  return row(format).name;
}

std::string_view mesh_format_media_type(MeshFormat format) {
  return row(format).media_type;
}

Result<void> check_mesh_format(MeshFormat format, std::int32_t dimension) {
  const std::int32_t shown = row(format).dimension;
  if (shown == 0 || shown == dimension) return {};
  return fail(ErrorCode::kUnsupportedModel, shown == 2
                                                ? "svg shows planar meshes only; take vtu or stl"
                                                : "stl shows solids only; take vtu or svg");
}

std::optional<MeshFormat> mesh_format_from_accept(std::string_view accept, std::int32_t dimension) {
  if (trim(accept).empty()) return MeshFormat::kVtu;
  std::array<int, kFormats.size()> closest{};
  std::array<double, kFormats.size()> quality{};
  while (!accept.empty()) {
    const Range range = parse_range(next_part(accept, ','));
    for (std::size_t i = 0; i < kFormats.size(); ++i) {
      if (kFormats[i].dimension != 0 && kFormats[i].dimension != dimension) continue;
      const int close = closeness(range.type, kFormats[i].media_type);
      if (close <= closest[i]) continue;
      closest[i] = close;
      quality[i] = range.q;
    }
  }
  const auto* best = std::ranges::max_element(quality);
  if (!(*best > 0)) return std::nullopt;
  return kFormats[static_cast<std::size_t>(best - quality.begin())].format;
}

}  // namespace symcell
