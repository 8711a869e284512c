#include "core/solid/initial/initial_tetrahedralization.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/solid/quotient/validate.hpp"
#include "tests/support/solid_sectors.hpp"

namespace symcell::solid {
namespace {

using test::PrismSpec;

double volume_of(const QuotientTetrahedralization& mesh, std::int32_t region = -1) {
  double volume = 0;
  for (TetId t = 0; t < mesh.tet_slots(); ++t) {
    if (!mesh.alive(t) || (region >= 0 && mesh.tet(t).region != region)) continue;
    const Point3 a = mesh.corner_point(t, 0), b = mesh.corner_point(t, 1);
    const Point3 c = mesh.corner_point(t, 2), d = mesh.corner_point(t, 3);
    volume += dot(cross(b - a, c - a), d - a) / 6;
  }
  return volume * mesh.fold();
}

std::size_t segment_edges(const InitialTetrahedralization& initial, std::int32_t segment) {
  std::size_t count = 0;
  initial.mesh.edges().for_each([&](const EdgeKey&, std::int32_t s) { count += s == segment; });
  return count;
}

InitialTetrahedralization meshed(const Sector& sector) {
  ExecutionContext context;
  auto result = tetrahedralize_sector(sector, context);
  EXPECT_TRUE(result) << result.error().message;
  if (!result) return {};
  const auto report = validate(result->mesh, ValidationLevel::kDelaunay);
  EXPECT_TRUE(report) << report.error().message;
  return std::move(*result);
}

class PrismFolds : public testing::TestWithParam<std::int32_t> {};

TEST_P(PrismFolds, PrismRoundTheAxis) {
  const std::int32_t n = GetParam();
  PrismSpec spec;
  spec.fold = n;
  spec.corners = n < 3 ? 4 : 2;
  spec.start_angle = 0.3;
  const Sector sector = test::prism_sector(spec);
  const auto initial = meshed(sector);
  EXPECT_NEAR(volume_of(initial.mesh), sector.expected_volume, 1e-12);
  const auto axis = static_cast<std::int32_t>(sector.segment_markers.size());
  EXPECT_EQ(segment_edges(initial, axis), n > 1 ? 1U : 0U);
}

TEST_P(PrismFolds, Ring) {
  PrismSpec spec;
  spec.fold = GetParam();
  spec.corners = GetParam() < 3 ? 5 : 3;
  spec.inner_radius = 0.4;
  spec.start_angle = -1.1;
  const Sector sector = test::prism_sector(spec);
  const auto initial = meshed(sector);
  EXPECT_NEAR(volume_of(initial.mesh), sector.expected_volume, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Folds, PrismFolds, testing::Values(1, 2, 3, 6, 12, 37));

// The facets with marker f + 1 that some tetrahedron has.
std::set<std::int32_t> facets_of(const QuotientTetrahedralization& mesh) {
  std::set<std::int32_t> facets;
  for (TetId t = 0; t < mesh.tet_slots(); ++t) {
    for (const std::int32_t f : mesh.tet(t).facet) {
      if (f != kNoFacet) facets.insert(f);
    }
  }
  return facets;
}

std::size_t vertices_of_kind(const QuotientTetrahedralization& mesh, VertexKind kind) {
  std::size_t count = 0;
  for (std::size_t v = 0; v < mesh.vertex_slots(); ++v) {
    count += mesh.kind(static_cast<VertexId>(v)) == kind ? 1 : 0;
  }
  return count;
}

Error error_of(const Sector& sector) {
  ExecutionContext context;
  auto result = tetrahedralize_sector(sector, context);
  EXPECT_FALSE(result);
  return result ? Error{} : result.error();
}

// All copies of a seed given in one.
void add_hole(Sector& sector, Point3 p) {
  const RotationTable rotations(sector.fold);
  for (std::int32_t k = 0; k < sector.fold; ++k) sector.holes.push_back(rotations.rotate(p, k));
}
void add_region(Sector& sector, Point3 p, std::int32_t attribute, double max_volume = 1) {
  const RotationTable rotations(sector.fold);
  for (std::int32_t k = 0; k < sector.fold; ++k) {
    sector.regions.push_back({rotations.rotate(p, k), attribute, max_volume});
  }
}

PrismSpec six_fold() {
  PrismSpec spec;
  spec.corners = 2;
  spec.start_angle = 0.2;
  return spec;
}

// A smaller prism in the middle of the one of six_fold(), not touching it.
Sector inner_prism(bool inward) {
  PrismSpec spec = six_fold();
  spec.corners = 1;
  spec.outer_radius = 0.5;
  spec.levels = {0.3, 0.7};
  spec.inward = inward;
  return test::prism_sector(spec);
}

TEST(InitialTetrahedralizationTest, VerticesAndSegmentsKeepTheirPlacesInTheModel) {
  const Sector sector = test::prism_sector(six_fold());
  const auto initial = meshed(sector);
  const QuotientTetrahedralization& mesh = initial.mesh;
  // Two corners at two levels, and the axis vertices, which cannot move; one cut vertex a level.
  EXPECT_EQ(vertices_of_kind(mesh, VertexKind::kInput), 6U);
  EXPECT_EQ(vertices_of_kind(mesh, VertexKind::kSegment), 2U);
  EXPECT_EQ(vertices_of_kind(mesh, VertexKind::kFacet), 0U);
  for (std::size_t o = 0; o < sector.orbit_points.size(); ++o) {
    EXPECT_EQ(mesh.point(static_cast<VertexId>(o)), sector.orbit_points[o]);
  }
  // Sides of top and bottom in two pieces each where the cut crosses them; two upright edges.
  std::size_t edges = 0;
  for (std::int32_t s = 0; s < 6; ++s) edges += segment_edges(initial, s);
  EXPECT_EQ(edges, 3U + 3U + 2U);
  EXPECT_EQ(initial.segment_markers.size(), 7U);
  EXPECT_EQ(initial.segment_markers.back(), 0);
  EXPECT_EQ(facets_of(mesh), (std::set<std::int32_t>{0, 1, 2, 3}));
}

TEST(InitialTetrahedralizationTest, SectorsThatDoNotTouch) {
  for (const std::int32_t n : {1, 2, 5}) {
    const Sector sector = test::block_sector(n, 2, 0.3, 1.0);
    const auto initial = meshed(sector);
    EXPECT_EQ(initial.mesh.tet_count(), 1U);
    EXPECT_NEAR(volume_of(initial.mesh), sector.expected_volume, 1e-12);
  }
}

TEST(InitialTetrahedralizationTest, SeveralComponents) {
  PrismSpec ring = six_fold();
  ring.inner_radius = 1.5;
  ring.outer_radius = 2;
  Sector sector = test::joined(test::prism_sector(six_fold()), test::prism_sector(ring));
  sector = test::joined(sector, test::block_sector(6, 3, 0.2, 0.2));
  for (const bool nesting : {false, true}) {
    sector.nesting_decides = nesting;
    EXPECT_NEAR(volume_of(meshed(sector).mesh), sector.expected_volume, 1e-12);
  }
}

TEST(InitialTetrahedralizationTest, NestedShellsByDepth) {
  Sector sector = test::joined(test::prism_sector(six_fold()), inner_prism(true), true);
  sector.nesting_decides = true;
  const auto with_void = meshed(sector);
  EXPECT_NEAR(volume_of(with_void.mesh), sector.expected_volume, 1e-12);
  // A solid within the void, across the axis.
  PrismSpec core = six_fold();
  core.outer_radius = 0.2;
  core.levels = {0.4, 0.6};
  sector = test::joined(sector, test::prism_sector(core));
  EXPECT_NEAR(volume_of(meshed(sector).mesh), sector.expected_volume, 1e-12);
}

TEST(InitialTetrahedralizationTest, HoleSeedsMakeVoids) {
  Sector sector = test::joined(test::prism_sector(six_fold()), inner_prism(false), true);
  add_hole(sector, {0, 0, 0.5});
  EXPECT_NEAR(volume_of(meshed(sector).mesh), sector.expected_volume, 1e-12);
  // One copy of a seed off the axis does, since the void goes round.
  sector.holes = {{-0.3, 0.1, 0.5}};
  EXPECT_NEAR(volume_of(meshed(sector).mesh), sector.expected_volume, 1e-12);
  // Without a seed what is enclosed is material.
  sector.holes.clear();
  sector.expected_volume = 0;
  EXPECT_NEAR(volume_of(meshed(sector).mesh), test::prism_sector(six_fold()).expected_volume,
              1e-12);
}

TEST(InitialTetrahedralizationTest, SeedsOnTheCutAreFound) {
  Sector sector = test::joined(test::prism_sector(six_fold()), inner_prism(false), true);
  sector.holes = {{0.3 * std::cos(0.2), 0.3 * std::sin(0.2), 0.5}};
  EXPECT_NEAR(volume_of(meshed(sector).mesh), sector.expected_volume, 1e-12);
}

TEST(InitialTetrahedralizationTest, SeedsOutsideAreNamed) {
  Sector sector = test::prism_sector(six_fold());
  sector.holes = {{0, 0, 7}};
  Error error = error_of(sector);
  EXPECT_EQ(error.code, ErrorCode::kUnreachableSeed);
  EXPECT_EQ(error.pointer, "/holes/0");
  sector.holes.clear();
  sector.regions = {{{0, 0, 0.5}, 1, 1}, {{5, 0, 0.5}, 1, 1}};
  error = error_of(sector);
  EXPECT_EQ(error.code, ErrorCode::kUnreachableSeed);
  EXPECT_EQ(error.pointer, "/regions/1");
}

TEST(InitialTetrahedralizationTest, InternalFacetsPartRegions) {
  PrismSpec spec = six_fold();
  spec.levels = {0, 0.25, 1};
  Sector sector = test::prism_sector(spec);
  add_region(sector, {0.1, 0.2, 0.1}, 7, 0.5);
  add_region(sector, {0.1, 0.2, 0.8}, -3);
  const auto initial = meshed(sector);
  ASSERT_EQ(initial.subdomains.size(), 3U);
  EXPECT_EQ(initial.subdomains[1].attribute, 7);
  EXPECT_EQ(initial.subdomains[1].max_volume, 0.5);
  EXPECT_EQ(initial.subdomains[2].attribute, -3);
  EXPECT_NEAR(volume_of(initial.mesh, 1), 0.25 * sector.expected_volume, 1e-12);
  EXPECT_NEAR(volume_of(initial.mesh, 2), 0.75 * sector.expected_volume, 1e-12);
  EXPECT_TRUE(facets_of(initial.mesh).contains(1));
  const auto axis = static_cast<std::int32_t>(sector.segment_markers.size());
  EXPECT_EQ(segment_edges(initial, axis), 2U);
}

TEST(InitialTetrahedralizationTest, SeedsThatDisagreeAreNamed) {
  Sector sector = test::prism_sector(six_fold());
  add_region(sector, {0.1, 0.2, 0.1}, 1);
  sector.regions.push_back({{0.3, 0.1, 0.5}, 2, 1});
  const Error error = error_of(sector);
  EXPECT_EQ(error.code, ErrorCode::kConflictingSeeds);
  EXPECT_EQ(error.pointer, "/regions/6");
  // Unless attributes take no part in the symmetry.
  sector.ignore_markers = true;
  const auto initial = meshed(sector);
  EXPECT_TRUE(initial.regions_differ);
  EXPECT_EQ(initial.seeds.size(), 7U);
}

TEST(InitialTetrahedralizationTest, DanglingFacetsStay) {
  PrismSpec disc = six_fold();
  disc.outer_radius = 0.5;
  disc.levels = {0.5};
  disc.discs_only = true;
  const Sector sector = test::joined(test::prism_sector(six_fold()), test::prism_sector(disc));
  const auto initial = meshed(sector);
  EXPECT_NEAR(volume_of(initial.mesh), sector.expected_volume, 1e-12);
  EXPECT_TRUE(facets_of(initial.mesh).contains(4));
  // Outside the material they go.
  disc.levels = {1.5};
  const Sector stray = test::joined(test::prism_sector(six_fold()), test::prism_sector(disc));
  const auto without = meshed(stray);
  EXPECT_NEAR(volume_of(without.mesh), stray.expected_volume, 1e-12);
  EXPECT_FALSE(facets_of(without.mesh).contains(4));
}

TEST(InitialTetrahedralizationTest, OpenBoundariesAreRefused) {
  Sector sector = test::prism_sector(six_fold());
  sector.faces.pop_back();
  EXPECT_EQ(error_of(sector).code, ErrorCode::kTetrahedralizationFailed);
}

TEST(InitialTetrahedralizationTest, WrongVolumesAreRefused) {
  Sector sector = test::prism_sector(six_fold());
  sector.expected_volume *= 1.01;
  EXPECT_EQ(error_of(sector).code, ErrorCode::kTetrahedralizationFailed);
}

TEST(InitialTetrahedralizationTest, SameBytesTwice) {
  PrismSpec spec = six_fold();
  spec.levels = {0, 0.25, 0.3, 1};
  const Sector sector = test::prism_sector(spec);
  const auto a = meshed(sector), b = meshed(sector);
  ASSERT_EQ(a.mesh.tet_slots(), b.mesh.tet_slots());
  for (TetId t = 0; t < a.mesh.tet_slots(); ++t) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      EXPECT_EQ(a.mesh.corner(t, i), b.mesh.corner(t, i));
      EXPECT_EQ(a.mesh.tet(t).nb[i], b.mesh.tet(t).nb[i]);
    }
  }
}

TEST(InitialTetrahedralizationTest, ACancelledContextEndsIt) {
  ExecutionContext context;
  context.cancel();
  const auto result = tetrahedralize_sector(test::prism_sector(six_fold()), context);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::kCancelled);
}

}  // namespace
}  // namespace symcell::solid
