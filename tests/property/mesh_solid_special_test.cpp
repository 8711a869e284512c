// Laws of the solid pipeline on models that are special by design: what lies on or crosses the
// axis, walls that lean on others, parts in voids.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/solid/mesh_solid.hpp"
#include "core/solid/sector/symmetrise.hpp"
#include "tests/property/solid_laws.hpp"
#include "tests/support/plc_builders.hpp"

namespace symcell {
namespace {

using test::add_box;
using test::box;
using test::prism;

PlcFacet facet(std::vector<std::vector<std::int32_t>> polygons, std::int32_t marker = 0) {
  PlcFacet f;
  f.polygons = std::move(polygons);
  f.marker = marker;
  return f;
}

std::int32_t add(Plc& plc, Point3 p) {
  plc.vertices.push_back(p);
  return static_cast<std::int32_t>(plc.vertices.size()) - 1;
}

// With and without bounds on the size, and with the fold as found and 1.
void expect_lawful(const Plc& plc, std::int32_t fold, double volume) {
  test::RandomPlc model;
  model.plc = plc;
  model.volume = volume;
  model.acute = true;
  Point3 low = plc.vertices.front(), high = low;
  for (const Point3 p : plc.vertices) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  model.diameter = distance(low, high);
  for (const std::int32_t n : {fold, 1}) {
    for (const double share : {0.0, 400.0}) {
      SCOPED_TRACE("fold " + std::to_string(n) + ", volume / " + std::to_string(share));
      ExecutionContext context;
      context.set_time_limit(30);
      MeshOptions options;
      options.fold = n;
      if (share > 0) options.max_volume = volume / share;
      const auto source = solid::symmetrise_plc(plc, options, context);
      ASSERT_TRUE(source) << source.error().message;
      const auto outcome = solid::mesh_solid(**source, options, context);
      ASSERT_TRUE(outcome) << outcome.error().message;
      for (const std::string& law : broken_solid_laws(model, options, *outcome)) {
        ADD_FAILURE() << law;
      }
    }
  }
}

double polygon_area(std::int32_t n) {
  return 0.5 * n * std::sin(2 * std::numbers::pi / n);
}

TEST(MeshSolidSpecial, AxisThroughCornersOfACube) {
  expect_lawful(box({0, 0, 0}, {1, 1, 1}), 3, 1);
}

TEST(MeshSolidSpecial, WallThroughTheAxis) {
  Plc plc = box({-1, -2, 0}, {1, 2, 3});
  const std::int32_t a = add(plc, {0, -2, 0}), b = add(plc, {0, 2, 0});
  const std::int32_t c = add(plc, {0, 2, 3}), d = add(plc, {0, -2, 3});
  plc.facets.push_back(facet({{a, b, c, d}}, 6));
  plc.regions.push_back({{0.5, 0, 1}, 1});
  plc.regions.push_back({{-0.5, 0, 1}, 1});
  expect_lawful(plc, 2, 24);
}

TEST(MeshSolidSpecial, WallsThatMeetOnTheAxis) {
  for (const std::int32_t n : {3, 4, 7}) {
    Plc plc = prism(n, 1, 1);
    const std::int32_t low = add(plc, {0, 0, 0}), high = add(plc, {0, 0, 1});
    for (std::int32_t i = 0; i < n; ++i) plc.facets.push_back(facet({{low, i, n + i, high}}, 9));
    expect_lawful(plc, n, polygon_area(n));
  }
}

TEST(MeshSolidSpecial, DanglingThingsOnTheAxis) {
  Plc plc = prism(3, 2, 4);
  const std::int32_t a = add(plc, {0, 0, 0.5}), b = add(plc, {0, 0, 1.5});
  plc.segments.push_back({a, b, 4});
  std::vector<std::int32_t> plate;
  for (int i = 0; i < 3; ++i) {
    const double angle = 2 * std::numbers::pi * i / 3 + 0.2;
    plate.push_back(add(plc, {0.4 * std::cos(angle), 0.4 * std::sin(angle), 2.5}));
  }
  plc.facets.push_back(facet({plate}, 7));
  expect_lawful(plc, 3, 4 * 4 * polygon_area(3));
}

TEST(MeshSolidSpecial, PartitionsThatLeanOnTheWalls) {
  // Half turns: a wall across the box that has none of the edges it stands on.
  Plc plc = box({-1, -1, 0}, {1, 1, 1});
  const std::int32_t a = add(plc, {0.3, -1, 0}), b = add(plc, {-0.3, 1, 0});
  const std::int32_t c = add(plc, {-0.3, 1, 1}), d = add(plc, {0.3, -1, 1});
  plc.facets.push_back(facet({{a, b, c, d}}, 6));
  expect_lawful(plc, 2, 4);
}

TEST(MeshSolidSpecial, CavitiesWithLooseEnds) {
  // A void box in a box, on the axis, with a plate and a needle in the void and a plate outside.
  Plc plc = box({-2, -2, -2}, {2, 2, 2});
  add_box(plc, {-1, -1, -1}, {1, 1, 1});
  plc.holes.push_back({0.4, 0.1, 0.2});
  expect_lawful(plc, 4, 64 - 8);
  const std::int32_t a = add(plc, {0, 0, -0.5}), b = add(plc, {0, 0, 0.5});
  plc.segments.push_back({a, b, 3});
  std::vector<std::int32_t> inside, outside;
  for (int i = 0; i < 4; ++i) {
    const double angle = 2 * std::numbers::pi * i / 4 + 0.3;
    inside.push_back(add(plc, {0.4 * std::cos(angle), 0.4 * std::sin(angle), 0.75}));
    outside.push_back(add(plc, {0.9 * std::cos(angle), 0.9 * std::sin(angle), 3}));
  }
  plc.facets.push_back(facet({inside}, 7));
  plc.facets.push_back(facet({outside}, 8));
  ExecutionContext context;
  MeshOptions options;
  options.fold = 4;
  const auto source = solid::symmetrise_plc(plc, options, context);
  ASSERT_TRUE(source) << source.error().message;
  const auto outcome = solid::mesh_solid(**source, options, context);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_NEAR(4 * outcome->statistics.cell.measure, 56, 1e-9);
}

TEST(MeshSolidSpecial, FacetWithinAFacet) {
  // A square of another marker in the top of a prism, which leaves it out.
  Plc plc = prism(4, 2, 1);
  std::vector<std::int32_t> patch;
  for (int i = 0; i < 4; ++i) {
    const double angle = 2 * std::numbers::pi * i / 4 + 0.4;
    patch.push_back(add(plc, {0.7 * std::cos(angle), 0.7 * std::sin(angle), 1}));
  }
  plc.facets[1].polygons.push_back(patch);
  plc.facets[1].holes.push_back({0, 0, 1});
  plc.facets.push_back(facet({patch}, 12));
  expect_lawful(plc, 4, 8);
}

}  // namespace
}  // namespace symcell
