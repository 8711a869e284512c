// Meshes as bytes, streamed to a sink in pieces of bounded size: memory is O(cell) for a full mesh
// too, whatever the fold.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "api/sink.hpp"
#include "core/base/error.hpp"
#include "core/cell/symmetry_cell_mesh.hpp"

namespace symcell {

enum class MeshFormat : std::uint8_t { kJson, kVtu, kMsh, kSvg, kStl };
enum class MeshPart : std::uint8_t { kCell, kFull };

enum class VtuEncoding : std::uint8_t { kAppendedRaw, kAppendedZlib, kAscii };

struct WriteOptions {
  VtuEncoding vtu_encoding = VtuEncoding::kAppendedRaw;
  bool stl_ascii = false;
};

// "json", "vtu", "msh", "svg", "stl", with or without a leading dot; any case.
[[nodiscard]] std::optional<MeshFormat> mesh_format_from_name(std::string_view name);
[[nodiscard]] std::string_view mesh_format_name(MeshFormat format);  // "vtu"
[[nodiscard]] std::string_view mesh_format_media_type(MeshFormat format);
// From an Accept header with q-values, among the formats that show meshes of `dimension`; nullopt:
// nothing acceptable; "*/*" or empty: VTU.
[[nodiscard]] std::optional<MeshFormat> mesh_format_from_accept(std::string_view accept,
                                                                std::int32_t dimension);
// Pictures are of planar meshes, STL of solids.  Errors: kUnsupportedModel.
[[nodiscard]] Result<void> check_mesh_format(MeshFormat format, std::int32_t dimension);

// Errors: kUnsupportedModel as above; kTooLarge (STL); kWriteFailed if the sink stops.
[[nodiscard]] Result<void> write_mesh(const SymmetryCellMesh& cell,
                                      MeshPart part,
                                      MeshFormat format,
                                      const WriteOptions& options,
                                      const Sink& sink);

}  // namespace symcell
