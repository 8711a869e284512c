// Laws of the whole way of random tessellated surfaces: a lawful mesh within the tolerance, or an
// error that a user can do something about. Seeds as in mesh_solid_property_test.cpp.
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <set>
#include <utility>

#include "api/formats/vtu_reader.hpp"
#include "core/base/random.hpp"
#include "core/cells/verify_mesh.hpp"
#include "core/mesh_solid.hpp"
#include "core/symmetry/symmetrise_solid.hpp"
#include "tests/property/random_case.hpp"
#include "tests/support/random_surface.hpp"
#include "tests/support/written_mesh.hpp"

namespace symcell {
namespace {

// Of the tetrahedra, over the ratio with no excuse: coarse surfaces of long triangles that a narrow
// tolerance does not let be changed have corners that no good tetrahedron fits into.
constexpr double kMostBadShare = 0.03;
// An error of this share of the tolerance fills it.
constexpr double kFilling = 2;

struct SurfaceCase {
  std::uint64_t seed = 0;
  test::RandomSurface model;
  MeshOptions options;
};

SurfaceCase make_case(std::uint64_t seed) {
  SurfaceCase c;
  c.seed = seed;
  c.model = test::make_random_surface(seed);
  Random random(seed + 0x5eed);
  constexpr double kTolerances[] = {1e-3, 5e-3, 2e-2};
  c.options.symmetry_tolerance_rel = kTolerances[random.next() % 3];
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

struct Meshed {
  MeshOutcome outcome;
  double error_rel = 0;  // of the symmetry
};

Result<Meshed> mesh(const SurfaceCase& c) {
  ExecutionContext context;
  context.set_max_elements(1'000'000);
  context.set_time_limit(120);
  auto source = symmetrise_surface(c.model.surface, c.options, context);
  if (!source) return tl::unexpected(source.error());
  auto outcome = mesh_solid(**source, c.options, context);
  if (!outcome) return tl::unexpected(outcome.error());
  return Meshed{std::move(*outcome), (*source)->symmetry().error_rel};
}

void expect_lawful(const SurfaceCase& c, const Meshed& meshed) {
  const MeshOutcome& outcome = meshed.outcome;
  const MeshData cell =
      read_vtu(test::written(outcome.mesh, MeshPart::kCell, MeshFormat::kVtu)).value();
  const Model model = c.model.surface;
  VerifyOptions options;
  options.model_tolerance_rel = *c.options.symmetry_tolerance_rel;
  for (const Check& check : verify_mesh(cell, nullptr, &model, options).checks) {
    EXPECT_NE(check.status, Check::Status::kFail) << c << "\n"
                                                  << check.name << ": " << check.detail;
  }
  // What two sectors differ by becomes needles at the cut, where it fills the tolerance.
  if (kFilling * meshed.error_rel > *c.options.symmetry_tolerance_rel) return;
  std::uint64_t bad = 0;
  for (const auto& exempt : outcome.statistics.exempt) {
    if (exempt.reason == "near_small_feature") bad += exempt.elements;
  }
  const auto count = static_cast<double>(outcome.statistics.cell.elements);
  EXPECT_LE(static_cast<double>(bad), 10 + kMostBadShare * count) << c << "\nof " << count;
}

TEST(MeshSurfaceProperty, MeshesOrErrorsThatTell) {
  const std::set<ErrorCode> told = {ErrorCode::kNotSymmetric, ErrorCode::kAmbiguousSymmetry,
                                    ErrorCode::kTetrahedralizationFailed,
                                    ErrorCode::kSelfIntersection};
  const SeedRange seeds = property_seeds(12);
  std::uint64_t meshed = 0, failed = 0;
  for (std::uint64_t seed = seeds.begin; seed < seeds.end; ++seed) {
    const SurfaceCase c = make_case(seed);
    const auto outcome = mesh(c);
    if (outcome) {
      ++meshed;
      expect_lawful(c, *outcome);
      continue;
    }
    EXPECT_TRUE(told.contains(outcome.error().code))
        << c << "\n"
        << error_code_name(outcome.error().code) << ": " << outcome.error().message;
    failed += outcome.error().code == ErrorCode::kTetrahedralizationFailed ? 1 : 0;
  }
  RecordProperty("meshed", static_cast<int>(meshed));
  // What is symmetric within the tolerance can be meshed, but for a rare wide one.
  EXPECT_LE(failed, 1 + meshed / 20);
}

}  // namespace
}  // namespace symcell
