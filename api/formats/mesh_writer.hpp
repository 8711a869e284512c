// Meshes as bytes, streamed to a sink in pieces of bounded size: memory is O(cell) for a full mesh
// too, whatever the fold.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "api/formats/decks/deck_options.hpp"
#include "api/sink.hpp"
#include "core/base/error.hpp"
#include "core/cell/symmetry_cell_mesh.hpp"

namespace symcell {

enum class MeshFormat : std::uint8_t {
  kJson,
  kVtu,
  kMsh,
  kMsh2,
  kInp,
  kBdf,
  kCdb,
  kVtp,
  kGlb,
  kSvg,
  kStl
};
enum class MeshPart : std::uint8_t { kCell, kFull };

enum class VtuEncoding : std::uint8_t { kAppendedRaw, kAppendedZlib, kAscii };
// "raw", "zlib", "ascii".
[[nodiscard]] std::optional<VtuEncoding> vtu_encoding_from_name(std::string_view name);

// Of JSON: numbers as text, or arrays in base64 whose coordinates have so many bits.
enum class PackedReals : std::uint8_t { kNone, kFloat32, kFloat64 };
// "false", "true" (32 bits), "exact" (64).
[[nodiscard]] std::optional<PackedReals> packed_reals_from_name(std::string_view name);

struct WriteOptions {
  VtuEncoding vtu_encoding = VtuEncoding::kAppendedRaw;  // of STL: ascii or not
  DeckOptions deck = {};
  PackedReals packed = PackedReals::kNone;
};

// "vtu, json, msh, ... or stl", for messages.
[[nodiscard]] std::string mesh_format_list();

// A name of that list, with or without a leading dot; any case.
[[nodiscard]] std::optional<MeshFormat> mesh_format_from_name(std::string_view name);
[[nodiscard]] std::string_view mesh_format_name(MeshFormat format);  // "vtu"
[[nodiscard]] std::string_view mesh_format_media_type(MeshFormat format);
// From an Accept header with q-values, among the formats that show meshes of `dimension`; nullopt:
// nothing acceptable; "*/*" or empty: VTU.
[[nodiscard]] std::optional<MeshFormat> mesh_format_from_accept(std::string_view accept,
                                                                std::int32_t dimension);
// Pictures are of planar meshes, STL of solids.  Errors: kUnsupportedModel.
[[nodiscard]] Result<void> check_mesh_format(MeshFormat format, std::int32_t dimension);

// A deck for a solver, which may have materials and more.
[[nodiscard]] bool takes_deck_options(MeshFormat format);
// Errors: kBadOption (deck options that the format does not take).
[[nodiscard]] Result<void> check_write_options(MeshFormat format, const WriteOptions& options);

// Whether write_mesh would begin, so that what cannot be written is told before the answer begins.
// Cost: as a small part of writing, whatever the fold.
// Errors: kBadOption (as above; groups, regions and materials of decks that do not fit the mesh);
// kUnsupportedModel (a format of the other dimension; what a solver cannot express).
[[nodiscard]] Result<void> check_mesh_output(const SymmetryCellMesh& cell,
                                             MeshPart part,
                                             MeshFormat format,
                                             const WriteOptions& options);

// Errors: as check_mesh_output; kTooLarge (STL); kWriteFailed if the sink stops.
[[nodiscard]] Result<void> write_mesh(const SymmetryCellMesh& cell,
                                      MeshPart part,
                                      MeshFormat format,
                                      const WriteOptions& options,
                                      const Sink& sink);

}  // namespace symcell
