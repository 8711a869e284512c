#include "core/plane/input/planar_input.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "core/model/describe.hpp"
#include "core/plane/input/curve_set.hpp"
#include "core/plane/input/make_whole.hpp"
#include "core/plane/input/validate_pslg.hpp"

namespace symcell::plane {
namespace {

// Share of the diameter within which ends that should meet do: what drawings with seven digits keep.
constexpr double kJoinRel = 1e-6;
// Crossings that are made vertices bend the segments by the tolerance; what that makes cross again
// is mended in further rounds.
constexpr int kRepairRounds = 4;

double diameter_of(const Pslg& pslg) {
  if (pslg.vertices.empty()) return 0;
  Point2 low = pslg.vertices.front(), high = low;
  for (const Point2 p : pslg.vertices) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  return distance(low, high);
}

std::vector<char> loose_ends(const Pslg& pslg) {
  const std::vector<std::int32_t> degrees = degrees_of(pslg);
  std::vector<char> loose(degrees.size());
  std::transform(degrees.begin(), degrees.end(), loose.begin(),
                 [](std::int32_t d) { return static_cast<char>(d == 1 ? 1 : 0); });
  return loose;
}

void join_loose_ends(Pslg& pslg, const std::vector<char>& loose, double radius) {
  CurveSet curves(pslg, radius);
  const CurveSet::Joined joined = curves.join(loose);
  if (joined.vertices == 0) return;
  curves.write(pslg);
  pslg.notes.joined += joined.vertices;
  pslg.notes.widest = std::max(pslg.notes.widest, joined.widest);
}

std::string counted(std::size_t count, const char* one, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

Result<void> repair(Pslg& pslg, double radius, ExecutionContext& context) {
  CurveSet curves(pslg, radius);
  const CurveSet::Joined joined = curves.join(std::vector<char>(pslg.vertices.size(), 1));
  std::size_t crossings = 0, cuts = 0, merged = 0;
  for (int round = 0; round < kRepairRounds; ++round) {
    const auto added = curves.add_crossings(context);
    if (!added) return error_of(added);
    const std::size_t split = curves.split();
    const std::size_t went = curves.merge();
    crossings += *added;
    cuts += split;
    merged += went;
    if (*added + split + went == 0) break;
  }
  curves.write(pslg);
  std::vector<std::string>& repairs = pslg.notes.repairs;
  if (joined.vertices > 0) {
    repairs.push_back(counted(joined.vertices, "vertex was", "vertices were") +
                      " joined with others up to " + describe_rounded(joined.widest) + " away");
  }
  if (crossings > 0) {
    repairs.push_back(counted(crossings, "crossing", "crossings") + " became vertices");
  }
  if (cuts > crossings) {
    repairs.push_back("segments were cut at vertices on them in " +
                      counted(cuts - crossings, "place", "places"));
  }
  if (merged > 0) {
    repairs.push_back(
        counted(merged, "segment that lay on another was", "segments that lay on others were") +
        " merged");
  }
  return {};
}

}  // namespace

Result<std::optional<PlanarInput>> prepare_input(const Pslg& pslg,
                                                 const MeshOptions& options,
                                                 ExecutionContext& context) {
  if (!check_entities(pslg)) return std::optional<PlanarInput>{};  // the validation says so
  // Models are large, and few have loose ends: nothing is copied without need.
  const std::vector<char> loose = loose_ends(pslg);
  const bool joins = options.repair != Repair::kNone &&
                     std::any_of(loose.begin(), loose.end(), [](char l) { return l != 0; });
  if (!joins && options.repair != Repair::kAll && !options.sector) {
    return std::optional<PlanarInput>{};
  }
  const double diameter = diameter_of(pslg);
  if (!(diameter > 0)) return std::optional<PlanarInput>{};
  PlanarInput input{pslg, options};
  const double radius = kJoinRel * diameter;
  bool changed = false;
  if (joins) {
    join_loose_ends(input.pslg, loose, radius);
    changed = input.pslg.notes.joined > 0;
  }
  if (options.repair == Repair::kAll) {
    SYMCELL_TRY(repair(input.pslg, radius, context));
    changed = true;
  }
  if (options.sector) {
    const double tolerance =
        options.symmetry_tolerance_rel.value_or(kExactSymmetryToleranceRel) * diameter;
    const Point2 centre = options.center.value_or(Point2{0, 0});
    MeshOptions of_whole = options;
    of_whole.center = centre;
    of_whole.fold = options.sector;
    auto whole = make_whole(input.pslg, *options.sector, centre, tolerance, of_whole, context);
    if (!whole) return error_of(whole);
    input.pslg = std::move(*whole);
    input.options.center = centre;
    if (!options.fold && !options.ignore_markers) input.options.fold = options.sector;
    changed = true;
  }
  if (!changed) return std::optional<PlanarInput>{};
  return std::optional<PlanarInput>{std::move(input)};
}

std::vector<Warning> warnings_of(const PslgNotes& notes) {
  std::vector<Warning> warnings;
  if (notes.joined > 0) warnings.push_back(loops_joined_warning(notes.joined, notes.widest));
  if (!notes.repairs.empty()) warnings.push_back(model_repaired_warning(notes.repairs));
  if (!notes.left_out.empty()) warnings.push_back(entities_left_out_warning(notes.left_out));
  return warnings;
}

}  // namespace symcell::plane
