// What the bounds of planar meshes mean: none where none is asked for, more triangles for more angle.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/base/execution_context.hpp"
#include "core/mesh_model.hpp"
#include "tests/property/mesh_laws.hpp"
#include "tests/property/random_case.hpp"
#include "tests/support/pslg_builders.hpp"

namespace symcell {
namespace {

Result<MeshOutcome> mesh(const Pslg& model, const MeshOptions& options) {
  ExecutionContext context;
  context.set_max_elements(options.max_elements);
  return mesh_model(model, options, context);
}

// A square plate whose square hole leaves a gap of `gap` to one side.
Pslg plate_with_gap(double gap) {
  Pslg model;
  model.vertices = {{-10, -10}, {10, -10}, {10, 10},      {-10, 10},
                    {-1, 8},    {1, 8},    {1, 10 - gap}, {-1, 10 - gap}};
  for (std::int32_t i = 0; i < 4; ++i) {
    model.segments.push_back({i, (i + 1) % 4, 0});
    model.segments.push_back({4 + i, 4 + (i + 1) % 4, 0});
  }
  model.holes.push_back({0, 8.5});
  return model;
}

TEST(MeshBoundsProperty, NoAngleAskedForNoPointAdded) {
  for (const double gap : {1.0, 1e-3, 1e-6, 1e-7}) {
    for (const bool plain : {false, true}) {
      MeshOptions options;
      options.min_angle_deg = 0;
      options.plain = plain;
      const auto outcome = mesh(plate_with_gap(gap), options);
      ASSERT_TRUE(outcome) << gap << ": " << outcome.error().message;
      EXPECT_EQ(outcome->statistics.cell.elements, 8U) << gap;
      EXPECT_EQ(outcome->statistics.refinement.steiner_points, 0U) << gap;
      for (const auto& law : broken_laws(plate_with_gap(gap), 396 + 2 * gap, options, *outcome)) {
        ADD_FAILURE() << gap << ": " << law;
      }
    }
  }
}

// A gap that no edge is as short as is no cascade.
TEST(MeshBoundsProperty, NarrowGapsAreMeshedAtAnyBound) {
  for (const double angle : {5.0, 20.0, 30.0}) {
    MeshOptions options;
    options.min_angle_deg = angle;
    options.max_elements = 1'000'000;
    const auto outcome = mesh(plate_with_gap(1e-4), options);
    ASSERT_TRUE(outcome) << angle << ": " << outcome.error().message;
    EXPECT_GE(outcome->statistics.cell.min_angle_deg, angle);
  }
}

TEST(MeshBoundsProperty, RandomModelsWithoutBoundGetNoPoints) {
  const SeedRange seeds = property_seeds(60);
  for (std::uint64_t seed = seeds.begin; seed < seeds.end; ++seed) {
    RandomCase c = make_random_case(seed);
    c.options = {};
    c.options.min_angle_deg = 0;
    for (PslgRegion& r : c.model.regions) r.max_area = kInfinity;
    const auto outcome = mesh(c.model, c.options);
    ASSERT_TRUE(outcome) << c << "\n" << outcome.error().message;
    // A centre with material that is no vertex becomes one.
    EXPECT_LE(outcome->statistics.refinement.steiner_points, 1U) << c;
  }
}

// Within what greedy coarsening leaves to chance: a twentieth, and a handful in small cells.
TEST(MeshBoundsProperty, CountsGrowWithTheAngle) {
  struct Named {
    std::string name;
    Pslg model;
  };
  std::vector<Named> models = {
      {"ring", regular_ring(7, 1, 0.5)}, {"star", star(9, 1, 0.6)},
      {"gear", gear(12, 1, 0.8, 0.3)},   {"flange", flange(6, 1, 0.7, 0.1, 0.2)},
      {"wheel", spoked_wheel(5, 1)},     {"plate", plate_with_gap(0.1)}};
  const SeedRange seeds = property_seeds(8);
  for (std::uint64_t seed = seeds.begin; seed < seeds.end; ++seed) {
    models.push_back({"seed " + std::to_string(seed), make_random_case(seed).model});
  }
  for (const Named& m : models) {
    double low = kInfinity, high = -kInfinity;
    for (const Point2 p : m.model.vertices) {
      low = std::min({low, p.x, p.y});
      high = std::max({high, p.x, p.y});
    }
    for (const double size : {0.0, 0.1, 0.02}) {
      double last = 0;
      for (const double angle : {0, 5, 10, 15, 20, 25, 30}) {
        MeshOptions options;
        options.min_angle_deg = angle;
        if (size > 0) options.max_edge = size * (high - low);
        const auto outcome = mesh(m.model, options);
        ASSERT_TRUE(outcome) << m.name << ", " << angle << ": " << outcome.error().message;
        const auto count = static_cast<double>(outcome->statistics.cell.elements);
        EXPECT_GE(1.05 * count + 4, last) << m.name << " at " << angle << ", edges " << size;
        last = count;
      }
    }
  }
}

}  // namespace
}  // namespace symcell
