#include "api/formats/mesh_writer.hpp"

#include <array>

#include "api/formats/decks/ansys.hpp"
#include "api/formats/decks/inp.hpp"
#include "api/formats/decks/nastran.hpp"
#include "api/formats/mesh_formats.hpp"

namespace symcell {
namespace {

// Of names in Nastran, which stand in comments, and of components in ANSYS.
constexpr std::size_t kLongestName = 32;
constexpr std::array<std::string_view, 3> kReserved{"CYCLIC_M01L", "CYCLIC_M01H", "SYMCELL_PAIRS"};

// Of bdf and cdb.
Result<internal::DeckPlan> plan_plain(MeshStream& mesh,
                                      MeshFormat format,
                                      const DeckOptions& options) {
  auto plan = internal::plan_deck(mesh, options, kLongestName, kReserved);
  if (!plan) return plan;
  SYMCELL_TRY(format == MeshFormat::kBdf ? internal::check_nastran(mesh, *plan)
                                         : internal::check_ansys(mesh, *plan));
  return plan;
}

Result<void> write_deck(MeshStream& mesh,
                        MeshFormat format,
                        const DeckOptions& options,
                        ByteWriter& out) {
  if (format == MeshFormat::kInp) {
    auto deck = internal::InpDeck::plan(mesh, options);
    if (!deck) return error_of(deck);
    deck->write(out);
    return {};
  }
  auto plan = plan_plain(mesh, format, options);
  if (!plan) return error_of(plan);
  if (format == MeshFormat::kBdf) {
    internal::write_nastran(mesh, *plan, out);
  } else {
    internal::write_ansys(mesh, *plan, options.plane_strain, out);
  }
  return {};
}

void write_json(MeshStream& mesh, PackedReals packed, ByteWriter& out) {
  if (packed == PackedReals::kNone) return internal::write_json_mesh(mesh, out);
  internal::write_packed_json(mesh, packed, out);
}

}  // namespace

std::optional<VtuEncoding> vtu_encoding_from_name(std::string_view name) {
  if (name == "raw") return VtuEncoding::kAppendedRaw;
  if (name == "zlib") return VtuEncoding::kAppendedZlib;
  if (name == "ascii") return VtuEncoding::kAscii;
  return std::nullopt;
}

std::optional<PackedReals> packed_reals_from_name(std::string_view name) {
  if (name == "false") return PackedReals::kNone;
  if (name == "true") return PackedReals::kFloat32;
  if (name == "exact") return PackedReals::kFloat64;
  return std::nullopt;
}

bool takes_deck_options(MeshFormat format) {
  return format == MeshFormat::kInp || format == MeshFormat::kBdf || format == MeshFormat::kCdb;
}

Result<void> check_write_options(MeshFormat format, const WriteOptions& options) {
  const DeckOptions& deck = options.deck;
  if (format == MeshFormat::kInp || deck == DeckOptions{}) return {};
  const std::string name(mesh_format_name(format));
  if (!takes_deck_options(format)) {
    return fail(
        ErrorCode::kBadOption,
        "analysis, material, support, load and plane are for decks (inp; material and plane "
        "for bdf and cdb, too), not for " +
            name);
  }
  if (deck.analysis == Analysis::kNone && deck.support.empty() && deck.loads.empty()) return {};
  return fail(ErrorCode::kBadOption, "analysis, support and load go with inp, not with " + name);
}

Result<void> check_mesh_output(const SymmetryCellMesh& cell,
                               MeshPart part,
                               MeshFormat format,
                               const WriteOptions& options) {
  SYMCELL_TRY(check_write_options(format, options));
  SYMCELL_TRY(check_mesh_format(format, cell.dimension));
  if (!takes_deck_options(format)) return {};
  MeshStream mesh(cell, part);
  if (format == MeshFormat::kInp) {
    const auto deck = internal::InpDeck::plan(mesh, options.deck);
    if (!deck) return error_of(deck);
    return {};
  }
  const auto plan = plan_plain(mesh, format, options.deck);
  if (!plan) return error_of(plan);
  return {};
}

Result<void> write_mesh(const SymmetryCellMesh& cell,
                        MeshPart part,
                        MeshFormat format,
                        const WriteOptions& options,
                        const Sink& sink) {
  auto done = check_mesh_format(format, cell.dimension);
  if (done) done = check_write_options(format, options);
  if (!done) return done;
  ByteWriter out(sink);
  MeshStream mesh(cell, part);
  mesh.stop_when([&out] { return !out.ok(); });
  switch (format) {
    case MeshFormat::kJson: write_json(mesh, options.packed, out); break;
    case MeshFormat::kVtu: internal::write_vtu(mesh, options.vtu_encoding, out); break;
    case MeshFormat::kMsh: internal::write_msh(mesh, out); break;
    case MeshFormat::kMsh2: internal::write_msh2(mesh, out); break;
    case MeshFormat::kInp:
    case MeshFormat::kBdf:
    case MeshFormat::kCdb: done = write_deck(mesh, format, options.deck, out); break;
    case MeshFormat::kVtp: done = internal::write_vtp(mesh, options.vtu_encoding, out); break;
    case MeshFormat::kGlb: done = internal::write_glb(mesh, out); break;
    case MeshFormat::kSvg: internal::write_svg(mesh, out); break;
    case MeshFormat::kStl:
      done = internal::write_stl(mesh, options.vtu_encoding == VtuEncoding::kAscii, out);
      break;
  }
  if (!done) return done;
  return out.finish();
}

}  // namespace symcell
