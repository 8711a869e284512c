// Random solids of every kind, from the model to the quotient mesh.
#include "core/base/random.hpp"

#include <gtest/gtest.h>

#include <string>

#include "core/solid/initial/initial_tetrahedralization.hpp"
#include "core/solid/quotient/validate.hpp"
#include "core/solid/sector/symmetrise.hpp"
#include "tests/support/random_plc.hpp"

namespace symcell::solid {
namespace {

// The first candidate that can be tetrahedralized.
Result<InitialTetrahedralization> first_success(const SectorSource& source,
                                                ExecutionContext& context) {
  Result<InitialTetrahedralization> last = fail(ErrorCode::kInternal, "no candidates");
  for (std::int32_t c = 0; c < source.candidates(); ++c) {
    const auto sector = source.sector(c, context);
    if (!sector) continue;
    last = tetrahedralize_sector(*sector, context);
    if (last || last.error().code != ErrorCode::kTetrahedralizationFailed) break;
  }
  return last;
}

TEST(InitialRandomTest, SectorsFillTheModel) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const test::RandomPlc model = test::make_random_plc(seed);
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + model.description);
    ExecutionContext context;
    const auto source = symmetrise_plc(model.plc, MeshOptions{}, context);
    ASSERT_TRUE(source) << source.error().message;
    const auto initial = first_success(**source, context);
    ASSERT_TRUE(initial) << initial.error().message;
    const auto report = validate(initial->mesh, ValidationLevel::kEmbedding);
    ASSERT_TRUE(report) << report.error().message;
    const double volume = report->volume * (*source)->symmetry().fold;
    EXPECT_NEAR(volume, model.volume, 1e-10 * model.volume);
  }
}

// Sectors that break their invariants: an answer, not a crash, and never a mesh that is none.
TEST(InitialRandomTest, BrokenSectorsEndInAnErrorOrASoundMesh) {
  Random random(1);
  const auto any = [&](const auto& list) {
    return static_cast<std::size_t>(random.next() % list.size());
  };
  for (std::uint64_t seed = 0; seed < 120; ++seed) {
    const test::RandomPlc model = test::make_random_plc(seed);
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + model.description);
    ExecutionContext context;
    const auto source = symmetrise_plc(model.plc, MeshOptions{}, context);
    ASSERT_TRUE(source) << source.error().message;
    auto sector = (*source)->sector(0, context);
    ASSERT_TRUE(sector) << sector.error().message;
    switch (seed % 6) {
      case 0: sector->faces.erase(sector->faces.begin()); break;
      case 1: sector->faces.push_back(sector->faces[any(sector->faces)]); break;
      case 2:
        sector->faces[any(sector->faces)].v[0] = static_cast<std::int32_t>(any(sector->vertices));
        break;
      case 3:
        sector->orbit_points[any(sector->orbit_points)] =
            sector->orbit_points[any(sector->orbit_points)];
        break;
      case 4:
        if (!sector->lower_cut.empty()) sector->lower_cut.pop_back();
        break;
      default:
        for (Point3& p : sector->orbit_points) {
          p.x += 0.2 * model.diameter * (random.uniform() - 0.5);
        }
    }
    const auto initial = tetrahedralize_sector(*sector, context);
    if (!initial) {
      EXPECT_NE(initial.error().code, ErrorCode::kInternal) << initial.error().message;
      continue;
    }
    const auto report = validate(initial->mesh, ValidationLevel::kEmbedding);
    EXPECT_TRUE(report) << report.error().message;
  }
}

}  // namespace
}  // namespace symcell::solid
