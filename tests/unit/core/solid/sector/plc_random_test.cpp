// Random symmetric PLCs: their symmetry is found, and the whole surface comes back from sectors.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/random.hpp"
#include "core/solid/sector/symmetrise.hpp"
#include "tests/support/plc_sector_checks.hpp"
#include "tests/support/random_plc.hpp"

namespace symcell::solid {
namespace {

using test::make_random_plc;
using test::RandomPlc;

void expect_whole(const RandomPlc& model, const Sector& sector) {
  test::expect_sound_sector(sector);
  const test::RestoredSurface surface = test::restore_surface(sector);
  EXPECT_EQ(surface.closed, model.plain_surface);
  EXPECT_NEAR(sector.expected_volume, model.volume, 1e-10 * model.volume);
  if (model.plain_surface) {
    EXPECT_NEAR(surface.volume, model.volume, 1e-10 * model.volume);
  }
}

TEST(PlcRandom, SymmetryIsFoundAndSectorsAreWhole) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const RandomPlc model = make_random_plc(seed);
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + model.description);
    ExecutionContext context;
    const auto source = symmetrise_plc(model.plc, MeshOptions{}, context);
    ASSERT_TRUE(source) << source.error().message;
    const Symmetry& found = (*source)->symmetry();
    EXPECT_EQ(found.fold % model.fold, 0) << found.fold;
    EXPECT_LE(found.error_rel, 1e-10);
    const std::int32_t last = (*source)->candidates() - 1;
    for (const std::int32_t candidate : {0, last}) {
      const auto sector = (*source)->sector(candidate, context);
      ASSERT_TRUE(sector) << sector.error().message;
      expect_whole(model, *sector);
    }
    MeshOptions given;
    given.fold = model.fold;
    given.axis_origin = model.axis_origin;
    given.axis_direction = model.axis_direction;
    const auto declared = symmetrise_plc(model.plc, given, context);
    ASSERT_TRUE(declared) << declared.error().message;
    const auto sector = (*declared)->sector(0, context);
    ASSERT_TRUE(sector) << sector.error().message;
    expect_whole(model, *sector);
    EXPECT_EQ((*declared)->sector(0, context)->faces.size(), sector->faces.size());
    if (::testing::Test::HasFailure()) break;
  }
}

TEST(PlcRandom, SizesNearTheLimitsOfCoordinates) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    RandomPlc model = make_random_plc(seed);
    ExecutionContext context;
    const auto plain = symmetrise_plc(model.plc, MeshOptions{}, context);
    ASSERT_TRUE(plain);
    for (const double scale : {0x1p180, 0x1p-180}) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ": " + model.description);
      Plc scaled = model.plc;
      for (Point3& p : scaled.vertices) p = scale * p;
      for (Point3& p : scaled.holes) p = scale * p;
      for (PlcRegion& r : scaled.regions) r.point = scale * r.point;
      for (PlcFacet& f : scaled.facets) {
        for (Point3& p : f.holes) p = scale * p;
      }
      const auto source = symmetrise_plc(scaled, MeshOptions{}, context);
      ASSERT_TRUE(source) << source.error().message;
      EXPECT_EQ((*source)->symmetry().fold, (*plain)->symmetry().fold);
      const auto sector = (*source)->sector(0, context);
      ASSERT_TRUE(sector) << sector.error().message;
      EXPECT_EQ(sector->faces.size(), (*plain)->sector(0, context)->faces.size());
      EXPECT_EQ(sector->vertices.size(), (*plain)->sector(0, context)->vertices.size());
    }
  }
}

bool plc_is_left(const Plc& plc) {
  return !plc.vertices.empty() && !plc.facets.empty() &&
         std::all_of(plc.facets.begin(), plc.facets.end(), [](const PlcFacet& f) {
           return !f.polygons.empty() &&
                  std::all_of(f.polygons.begin(), f.polygons.end(),
                              [](const auto& polygon) { return !polygon.empty(); });
         });
}

// Breaks a model somehow.
void damage(Plc& plc, Random& random) {
  const auto pick = [&](std::size_t count) {
    return static_cast<std::size_t>(random.uniform() * static_cast<double>(count));
  };
  const auto vertex = [&] { return static_cast<std::int32_t>(pick(plc.vertices.size())); };
  PlcFacet& facet = plc.facets[pick(plc.facets.size())];
  std::vector<std::int32_t>& polygon = facet.polygons[pick(facet.polygons.size())];
  switch (pick(10)) {
    case 0: polygon[pick(polygon.size())] = vertex(); break;
    case 1: polygon.push_back(vertex()); break;
    case 2: std::swap(polygon[pick(polygon.size())], polygon[pick(polygon.size())]); break;
    case 3:
      polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(pick(polygon.size())));
      break;
    case 4:
      plc.facets.erase(plc.facets.begin() + static_cast<std::ptrdiff_t>(pick(plc.facets.size())));
      break;
    case 5: plc.facets.push_back(facet); break;
    case 6: {
      Point3& p = plc.vertices[pick(plc.vertices.size())];
      p = p + (random.uniform() < 0.5 ? 1e-9 : 0.3) * (plc.vertices[pick(plc.vertices.size())] - p);
      break;
    }
    case 7: plc.segments.push_back({vertex(), vertex(), 1}); break;
    case 8: {
      PlcFacet extra;
      extra.polygons = {{vertex(), vertex(), vertex()}};
      plc.facets.push_back(extra);
      break;
    }
    default: plc.vertices.push_back(plc.vertices[pick(plc.vertices.size())]); break;
  }
}

TEST(PlcRandom, BrokenModelsEndInAnErrorOrInSoundSectors) {
  std::size_t refused = 0, sound = 0;
  for (std::uint64_t seed = 0; seed < 1500; ++seed) {
    test::RandomPlcOptions limits;
    limits.max_fold = 9;
    RandomPlc model = make_random_plc(seed, limits);
    Random random(seed);
    const int times = 1 + static_cast<int>(3 * random.uniform());
    for (int i = 0; i < times && plc_is_left(model.plc); ++i) damage(model.plc, random);
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + model.description);
    ExecutionContext context;
    MeshOptions options;
    if (random.uniform() < 0.3) options.symmetry_tolerance_rel = 1e-2;
    if (random.uniform() < 0.3) options.ignore_markers = true;
    const auto source = symmetrise_plc(model.plc, options, context);
    if (!source) {
      ++refused;
      EXPECT_NE(source.error().code, ErrorCode::kInternal) << source.error().message;
      EXPECT_FALSE(source.error().message.empty());
      continue;
    }
    const auto sector = (*source)->sector(0, context);
    if (!sector) continue;
    ++sound;
    test::expect_sound_sector(*sector);
  }
  EXPECT_GT(refused, 300u);
  EXPECT_GT(sound, 100u);
}

}  // namespace
}  // namespace symcell::solid
