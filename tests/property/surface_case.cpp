#include "tests/property/surface_case.hpp"

#include <cmath>
#include <utility>

#include "api/formats/vtu_reader.hpp"
#include "core/base/random.hpp"
#include "core/geometry/indexed_surface.hpp"
#include "core/solid/mesh_solid.hpp"
#include "core/solid/sector/symmetrise.hpp"
#include "core/verify/verify_mesh.hpp"
#include "tests/property/link_laws.hpp"
#include "tests/support/written_mesh.hpp"

namespace symcell {
namespace {

// Of the tetrahedra, over the ratio and not exempt: coarse surfaces of long triangles that a narrow
// tolerance does not let be changed have corners that no good tetrahedron fits into.
constexpr double kMeasureTolerance = 1e-9;  // relative
constexpr double kMostBadShare = 0.03;
// An error of this share of the tolerance fills it.
constexpr double kFilling = 2;

}  // namespace

SurfaceCase make_surface_case(std::uint64_t seed, test::RandomSurface model) {
  SurfaceCase c;
  c.seed = seed;
  c.model = std::move(model);
  Random random(seed + 0x5eed);
  constexpr double kTolerances[] = {1e-3, 5e-3, 2e-2};
  constexpr double kFlatTolerances[] = {1e-3, 1e-3, 1e-4};
  c.options.symmetry_tolerance_rel =
      (c.model.flat ? kFlatTolerances : kTolerances)[random.next() % 3];
  if (random.uniform() < 0.6) c.options.fold = c.model.fold;
  constexpr double kShares[] = {0, 500, 5000};
  const double share = kShares[random.next() % 3];
  if (share > 0) c.options.max_volume = c.model.volume / share;
  return c;
}

std::ostream& operator<<(std::ostream& out, const SurfaceCase& c) {
  out << "seed " << c.seed << ": " << c.model.description << ", tolerance "
      << *c.options.symmetry_tolerance_rel;
  if (c.options.fold) out << ", fold given";
  if (c.options.max_volume < kInfinity) out << ", max_volume " << c.options.max_volume;
  return out << " (SYMCELL_PROPERTY_RUNS=1 SYMCELL_PROPERTY_SEED=" << c.seed << ")";
}

Result<MeshedSurface> mesh(const SurfaceCase& c) {
  ExecutionContext context;
  context.set_max_elements(1'000'000);
  context.set_time_limit(120);
  auto source = solid::symmetrise_surface(c.model.surface, c.options, context);
  if (!source) return error_of(source);
  auto outcome = solid::mesh_solid(**source, c.options, context);
  if (!outcome) return error_of(outcome);
  return MeshedSurface{std::move(*outcome), (*source)->symmetry().error_rel};
}

std::vector<std::string> broken_surface_laws(const SurfaceCase& c, const MeshedSurface& meshed) {
  std::vector<std::string> broken;
  const MeshOutcome& outcome = meshed.outcome;
  const MeshData cell =
      read_vtu(test::written(outcome.mesh, MeshPart::kCell, MeshFormat::kVtu)).value();
  const Model model = c.model.surface;
  VerifyOptions options;
  options.model_tolerance_rel = *c.options.symmetry_tolerance_rel;
  for (const Check& check : verify_mesh(cell, nullptr, &model, options).checks) {
    if (check.status == Check::Status::kFail) broken.push_back(check.name + ": " + check.detail);
  }
  ModelTopology topology;
  topology.diameter = bounding_box(c.model.surface.vertices).diagonal();
  topology.boundary =
      c.model.boundary ? *c.model.boundary : test::boundary_topology(c.model.surface);
  for (std::string& law : broken_link_laws(outcome.mesh, topology)) {
    broken.push_back(std::move(law));
  }
  const double volume = outcome.statistics.cell.measure * outcome.mesh.fold;
  const double moved = c.model.flat
                           ? kMeasureTolerance * c.model.volume
                           : *c.options.symmetry_tolerance_rel * topology.diameter * c.model.area;
  if (std::abs(volume - c.model.volume) > moved) {
    broken.push_back("volume: " + std::to_string(volume / c.model.volume) + " of the model's");
  }
  // What two sectors differ by becomes needles at the cut, where it fills the tolerance.
  if (kFilling * meshed.error_rel > *c.options.symmetry_tolerance_rel) return broken;
  std::uint64_t bad = 0;
  for (const auto& exempt : outcome.statistics.exempt) {
    if (exempt.reason == "near_small_feature") bad += exempt.elements;
  }
  const auto count = static_cast<double>(outcome.statistics.cell.elements);
  if (!c.model.flat && static_cast<double>(bad) > 10 + kMostBadShare * count) {
    broken.push_back("quality: " + std::to_string(bad) + " elements of " +
                     std::to_string(outcome.statistics.cell.elements) + " near small features");
  }
  return broken;
}

}  // namespace symcell
