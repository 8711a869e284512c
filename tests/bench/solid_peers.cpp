// Tetrahedra of TetGen's full mesh and of the predefined planar sector (M1 of [paper]) for solid
// models: `symcell_solid_peers [--histograms] MODEL...` writes a table; "dih" is the
// smallest dihedral angle in degrees. Bounds: radius-edge 1.414 and maximum
// volumes of none, volume/2000 and volume/40000, as in the targets for the cell. "~": the cuts'
// meshes do not match, see tetgen_peer.hpp.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <variant>

#include "api/formats/model_reader.hpp"
#include "core/solid/initial/initial_tetrahedralization.hpp"
#include "core/solid/quotient/validate.hpp"
#include "core/solid/sector/symmetrise.hpp"
#include "tests/bench/tetgen_peer.hpp"

namespace symcell::bench {
namespace {

// A predefined sector may be cut well or badly: the best of a few counts.
constexpr std::int32_t kSectorsTried = 3;

struct Sectors {
  std::vector<solid::Sector> sectors;
  double volume = 0;  // of the full model
};

Result<Sectors> cut(const Model& model) {
  ExecutionContext context;
  const MeshOptions options;
  auto source = std::holds_alternative<Plc>(model)
                    ? solid::symmetrise_plc(std::get<Plc>(model), options, context)
                    : solid::symmetrise_surface(std::get<TriangleSurface>(model), options, context);
  if (!source) return error_of(source);
  Sectors result;
  for (std::int32_t c = 0; c < (*source)->candidates(); ++c) {
    auto sector = (*source)->sector(c, context);
    if (!sector) continue;
    if (result.sectors.empty()) {
      const auto initial = solid::tetrahedralize_sector(*sector, context);
      if (!initial) continue;
      const auto report = solid::validate(initial->mesh, ValidationLevel::kEmbedding);
      if (!report) return error_of(report);
      result.volume = report->volume * sector->fold;
    }
    result.sectors.push_back(std::move(*sector));
    if (result.sectors.size() == kSectorsTried) break;
  }
  if (result.sectors.empty()) return fail(ErrorCode::kTetrahedralizationFailed, "no sector");
  return result;
}

Result<PeerCount> whole(const Model& model, PeerBounds bounds) {
  return std::holds_alternative<Plc>(model) ? mesh_whole(std::get<Plc>(model), bounds)
                                            : mesh_whole(std::get<TriangleSurface>(model), bounds);
}

Result<PeerCount> best_sector(const Sectors& sectors, PeerBounds bounds) {
  Result<PeerCount> best = fail(ErrorCode::kTetrahedralizationFailed, "none");
  for (const solid::Sector& sector : sectors.sectors) {
    const auto matched = mesh_matched_sector(sector, bounds);
    if (!matched) continue;
    const bool better = !best || (matched->matched && !best->matched) ||
                        (matched->matched == best->matched && matched->tets < best->tets);
    if (better) best = *matched;
  }
  return best;
}

void print(const Result<PeerCount>& count) {
  if (count) {
    std::printf(" %9llu%c %7.2f %5.1f", static_cast<unsigned long long>(count->tets),
                count->matched ? ' ' : '~', count->seconds, count->figures.min_dihedral_deg);
  } else {
    std::printf(" %9s  %7s %5s", "-", "-", "-");
  }
}

// Longest edge / smallest height of a sector's tetrahedra, as in the statistics.
void print_histogram(const Statistics::Cell& figures) {
  std::printf("    aspect ratios <1.5 -2 -2.5 -3 -4 -6 -10 -15 >15:");
  for (const std::uint64_t count : figures.aspect_ratio_histogram) {
    std::printf(" %llu", static_cast<unsigned long long>(count));
  }
  std::printf("\n");
}

bool compare(const std::string& path, bool histograms) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), {});
  const auto model = read_model(bytes, std::nullopt);
  if (!model || std::holds_alternative<Pslg>(*model)) {
    std::fprintf(stderr, "%s: %s\n", path.c_str(),
                 model ? "not a solid" : model.error().message.c_str());
    return false;
  }
  const auto sectors = cut(*model);
  if (!sectors) {
    std::fprintf(stderr, "%s: %s\n", path.c_str(), sectors.error().message.c_str());
    return false;
  }
  const std::string name = path.substr(path.rfind('/') + 1);
  struct Size {
    const char* name;
    double share;
  };
  for (const auto& [size, share] : {Size{"none", 0}, Size{"coarse", 2000}, Size{"fine", 40000}}) {
    PeerBounds bounds;
    if (share > 0) bounds.max_volume = sectors->volume / share;
    std::printf("%-38s %4d %-6s %12.6g", name.c_str(), sectors->sectors[0].fold, size,
                bounds.max_volume);
    const auto full = whole(*model, bounds);
    const auto sector = best_sector(*sectors, bounds);
    print(full);
    print(sector);
    if (full && sector) {
      std::printf(" %6.3f", static_cast<double>(sector->tets) / static_cast<double>(full->tets));
    }
    std::printf("\n");
    if (histograms && sector) print_histogram(sector->figures);
    std::fflush(stdout);
  }
  return true;
}

}  // namespace
}  // namespace symcell::bench

int main(int argc, char** argv) {
  std::printf("%-38s %4s %-6s %12s %9s  %7s %5s %9s  %7s %5s %6s\n", "model", "n", "bound",
              "max_volume", "full", "s", "dih", "M1", "s", "dih", "ratio");
  bool all = true;
  bool histograms = false;
  for (int i = 1; i < argc; ++i) {
    if (std::string_view(argv[i]) == "--histograms") {
      histograms = true;
    } else {
      all = symcell::bench::compare(argv[i], histograms) && all;
    }
  }
  return all ? 0 : 1;
}
