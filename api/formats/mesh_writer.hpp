// Meshes as bytes, streamed to a sink in pieces of bounded size: memory is O(cell) for a full mesh
// too, whatever the fold.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "api/sink.hpp"
#include "core/base/error.hpp"
#include "core/cells/symmetry_cell_mesh.hpp"

namespace symcell {

enum class MeshFormat : std::uint8_t { kJson, kVtu, kMsh, kSvg };
enum class MeshPart : std::uint8_t { kCell, kFull };

enum class VtuEncoding : std::uint8_t { kAppendedRaw, kAppendedZlib, kAscii };

struct WriteOptions {
  VtuEncoding vtu_encoding = VtuEncoding::kAppendedRaw;
};

// "json", "vtu", "msh", "svg", with or without a leading dot; any case.
[[nodiscard]] std::optional<MeshFormat> mesh_format_from_name(std::string_view name);
[[nodiscard]] std::string_view mesh_format_name(MeshFormat format);  // "vtu"
[[nodiscard]] std::string_view mesh_format_media_type(MeshFormat format);
// From an Accept header with q-values; nullopt: nothing acceptable; "*/*" or empty: VTU.
[[nodiscard]] std::optional<MeshFormat> mesh_format_from_accept(std::string_view accept);

// Errors: kWriteFailed if the sink stops.
[[nodiscard]] Result<void> write_mesh(const SymmetryCellMesh& cell,
                                      MeshPart part,
                                      MeshFormat format,
                                      const WriteOptions& options,
                                      const Sink& sink);

}  // namespace symcell
