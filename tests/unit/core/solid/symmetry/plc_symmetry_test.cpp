#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/solid/sector/symmetrise.hpp"
#include "tests/support/plc_builders.hpp"
#include "tests/support/plc_sector_checks.hpp"
#include "tests/support/random_plc.hpp"

namespace symcell::solid {
namespace {

using test::add_box;
using test::box;
using test::expect_sound_sector;
using test::prism;
using test::restore_surface;

Result<std::unique_ptr<SectorSource>> symmetrise(const Plc& plc, const MeshOptions& options = {}) {
  ExecutionContext context;
  return symmetrise_plc(plc, options, context);
}

MeshOptions about_z(std::int32_t fold) {
  MeshOptions options;
  options.fold = fold;
  options.axis_origin = Point3{0, 0, 0};
  options.axis_direction = Point3{0, 0, 1};
  return options;
}

PlcFacet facet(std::vector<std::vector<std::int32_t>> polygons, std::int32_t marker = 0) {
  PlcFacet f;
  f.polygons = std::move(polygons);
  f.marker = marker;
  return f;
}

void expect_refused(const Result<std::unique_ptr<SectorSource>>& result,
                    ErrorCode code,
                    const std::vector<std::string>& words) {
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, code) << result.error().message;
  for (const std::string& word : words) {
    EXPECT_NE(result.error().message.find(word), std::string::npos) << result.error().message;
  }
}

// All sectors of a source are sound, restore the same area and `volume` (0: not looked at).
void expect_all_sectors(const SectorSource& source, double volume) {
  ExecutionContext context;
  for (std::int32_t i = 0; i < source.candidates(); ++i) {
    SCOPED_TRACE("candidate " + std::to_string(i));
    const auto sector = source.sector(i, context);
    ASSERT_TRUE(sector) << sector.error().message;
    expect_sound_sector(*sector);
    const auto surface = restore_surface(*sector);
    if (volume > 0) {
      EXPECT_NEAR(surface.volume, volume, 1e-12 * volume);
    }
  }
}

TEST(PlcSymmetry, PrismsHaveTheFoldOfTheirBase) {
  for (const std::int32_t n : {3, 4, 5, 6, 7, 12, 31}) {
    const auto source = symmetrise(prism(n, 1, 2.7));
    ASSERT_TRUE(source) << source.error().message;
    EXPECT_EQ((*source)->symmetry().fold, n);
    EXPECT_EQ((*source)->symmetry().frame.direction(), (Point3{0, 0, 1}));
    const double area = 0.5 * n * std::sin(2 * std::numbers::pi / n);
    expect_all_sectors(**source, 2.7 * area);
  }
}

TEST(PlcSymmetry, MarkersAndAttributesTakePart) {
  Plc plc = prism(6, 1, 1);
  plc.facets[2].marker = 8;  // one side of six
  auto source = symmetrise(plc);
  ASSERT_TRUE(source);
  EXPECT_EQ((*source)->symmetry().fold, 1);
  expect_refused(symmetrise(plc, about_z(3)), ErrorCode::kNotSymmetric,
                 {"3-fold", "facet 2 has marker 8", "marker 3"});
  plc.facets[4].marker = plc.facets[6].marker = 8;
  source = symmetrise(plc);
  ASSERT_TRUE(source);
  EXPECT_EQ((*source)->symmetry().fold, 3);
  MeshOptions ignore;
  ignore.ignore_markers = true;
  source = symmetrise(plc, ignore);
  ASSERT_TRUE(source);
  EXPECT_EQ((*source)->symmetry().fold, 6);
}

TEST(PlcSymmetry, SeedsMustLieInTheImagesOfTheirCells) {
  // Four boxes in a ring.
  Plc plc;
  for (const Point3 p : {Point3{2, 0, 0}, Point3{0, 2, 0}, Point3{-2, 0, 0}, Point3{0, -2, 0}}) {
    add_box(plc, p - Point3{0.5, 0.5, 0.5}, p + Point3{0.5, 0.5, 0.5});
  }
  EXPECT_EQ((*symmetrise(plc))->symmetry().fold, 4);
  // Two of one material: half a turn is left. Seeds need not be copies of each other.
  plc.regions.push_back({{2.1, 0.2, 0.3}, 5});
  plc.regions.push_back({{-1.9, 0.1, -0.3}, 5});
  EXPECT_EQ((*symmetrise(plc))->symmetry().fold, 2);
  expect_refused(symmetrise(plc, about_z(4)), ErrorCode::kNotSymmetric,
                 {"attribute 5", "without region seed"});
  plc.regions.push_back({{0, 2, 0}, 5});
  plc.regions.push_back({{0, -2, 0}, 5, 0.1});
  // About z nothing is left; half a turn about y remains.
  MeshOptions z;
  z.axis_direction = Point3{0, 0, 1};
  EXPECT_EQ((*symmetrise(plc, z))->symmetry().fold, 1);
  const Symmetry found = (*symmetrise(plc))->symmetry();
  EXPECT_EQ(found.fold, 2);
  EXPECT_NEAR(std::abs(found.frame.direction().y), 1, 1e-12);
  MeshOptions ignore = z;
  ignore.ignore_markers = true;
  EXPECT_EQ((*symmetrise(plc, ignore))->symmetry().fold, 4);
  plc.regions.clear();
  // A hole is geometry: ignore_markers does not hide it.
  plc.holes.push_back({0, 2, 0});
  EXPECT_EQ((*symmetrise(plc, ignore))->symmetry().fold, 1);
  expect_refused(symmetrise(plc, about_z(2)), ErrorCode::kNotSymmetric, {"hole of seed 0"});
}

TEST(PlcSymmetry, OneSeedServesARegionRoundTheAxis) {
  Plc plc = prism(5, 1, 1);
  plc.regions.push_back({{0.3, 0.1, 0.5}, 4, 0.01});
  EXPECT_EQ((*symmetrise(plc))->symmetry().fold, 5);
}

TEST(PlcSymmetry, ErrorsAreMeasuredAndNamed) {
  Plc plc = prism(8, 1, 1);
  plc.vertices[3].x += 1e-7;
  auto source = symmetrise(plc, about_z(8));
  ASSERT_TRUE(source) << source.error().message;
  EXPECT_GT((*source)->symmetry().error_rel, 2e-8);
  EXPECT_LT((*source)->symmetry().error_rel, 1e-7);
  plc.vertices[3].x += 1e-3;
  plc.vertices[11].x += 1e-3;  // above it: the side stays planar
  expect_refused(symmetrise(plc, about_z(8)), ErrorCode::kNotSymmetric,
                 {"8-fold", "tolerance of 1e-06", "of the diameter, worst at vertex "});
  MeshOptions loose = about_z(8);
  loose.symmetry_tolerance_rel = 1e-3;
  EXPECT_TRUE(symmetrise(plc, loose));
  // A fold that the model does not have, axis to be found.
  MeshOptions seven;
  seven.fold = 7;
  expect_refused(symmetrise(prism(8, 1, 1), seven), ErrorCode::kNotSymmetric, {"7-fold", "error"});
}

TEST(PlcSymmetry, BadOptionsAreRefused) {
  const Plc plc = prism(4, 1, 1);
  MeshOptions options;
  options.fold = 0;
  expect_refused(symmetrise(plc, options), ErrorCode::kBadFold, {"fold 0"});
  options.fold = kMaxFold + 1;
  expect_refused(symmetrise(plc, options), ErrorCode::kBadFold, {});
  options = {};
  options.axis_direction = Point3{0, 0, 0};
  expect_refused(symmetrise(plc, options), ErrorCode::kBadAxis, {"direction (0, 0, 0)"});
  options.axis_direction = Point3{0, 0, std::nan("")};
  expect_refused(symmetrise(plc, options), ErrorCode::kBadAxis, {});
  options = {};
  options.axis_origin = Point3{0, 1e300, 0};
  expect_refused(symmetrise(plc, options), ErrorCode::kBadAxis, {"origin"});
}

TEST(PlcSymmetry, SolidsWithEqualMomentsHaveAxesElsewhere) {
  const Plc cube = box({0, 0, 0}, {1, 1, 1});
  EXPECT_EQ((*symmetrise(cube))->symmetry().fold, 4);
  MeshOptions three;
  three.fold = 3;
  const auto source = symmetrise(cube, three);
  ASSERT_TRUE(source) << source.error().message;
  const Point3 d = (*source)->symmetry().frame.direction();
  EXPECT_NEAR(std::abs(d.x), 1 / std::sqrt(3), 1e-12);
  EXPECT_NEAR(std::abs(d.y), 1 / std::sqrt(3), 1e-12);
  expect_all_sectors(**source, 1);

  // A cube with one corner cut off keeps that axis only.
  Plc cut = cube;
  cut.vertices[0] = {0.3, 0, 0};
  cut.vertices.push_back({0, 0.3, 0});
  cut.vertices.push_back({0, 0, 0.3});
  cut.facets[0].polygons = {{8, 2, 3, 1, 0}};
  cut.facets[2].polygons = {{0, 1, 5, 4, 9}};
  cut.facets[4].polygons = {{9, 4, 6, 2, 8}};
  cut.facets.push_back(facet({{0, 8, 9}}));
  const auto corner = symmetrise(cut);
  ASSERT_TRUE(corner) << corner.error().message;
  EXPECT_EQ((*corner)->symmetry().fold, 3);
  expect_all_sectors(**corner, 1 - 0.3 * 0.3 * 0.3 / 6);

  // A regular icosahedron: a fold of five through a vertex.
  Plc ico;
  const double g = std::numbers::phi;
  for (const double s : {-1.0, 1.0}) {
    for (const double t : {-g, g}) {
      ico.vertices.push_back({0, s, t});
      ico.vertices.push_back({s, t, 0});
      ico.vertices.push_back({t, 0, s});
    }
  }
  for (std::int32_t a = 0; a < 12; ++a) {
    for (std::int32_t b = a + 1; b < 12; ++b) {
      for (std::int32_t c = b + 1; c < 12; ++c) {
        const auto size = [&](std::int32_t i, std::int32_t j) {
          return distance(ico.vertices[static_cast<std::size_t>(i)],
                          ico.vertices[static_cast<std::size_t>(j)]);
        };
        if (size(a, b) < 2.1 && size(b, c) < 2.1 && size(a, c) < 2.1) {
          ico.facets.push_back(facet({{a, b, c}}));
        }
      }
    }
  }
  ASSERT_EQ(ico.facets.size(), 20u);
  const auto found = symmetrise(ico);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ((*found)->symmetry().fold, 5);
  expect_all_sectors(**found, 5.0 / 12 * (3 + std::sqrt(5)) * 8);
}

TEST(PlcSymmetry, AFacetThroughTheAxisIsCutThere) {
  // A wall that divides a box in two; half a turn maps it onto itself.
  Plc plc = box({-1, -2, 0}, {1, 2, 3});
  for (const Point3 p : {Point3{0, -2, 0}, Point3{0, 2, 0}, Point3{0, 2, 3}, Point3{0, -2, 3}}) {
    plc.vertices.push_back(p);
  }
  plc.facets.push_back(facet({{8, 9, 10, 11}}, 6));
  plc.regions.push_back({{0.5, 0, 1}, 1});
  plc.regions.push_back({{-0.5, 0, 1}, 1});
  const auto source = symmetrise(plc, about_z(2));
  ASSERT_TRUE(source) << source.error().message;
  ExecutionContext context;
  for (std::int32_t i = 0; i < (*source)->candidates(); ++i) {
    const auto sector = (*source)->sector(i, context);
    ASSERT_TRUE(sector) << sector.error().message;
    expect_sound_sector(*sector);
    const auto surface = restore_surface(*sector);
    EXPECT_NEAR(surface.facet_area.back(), 4 * 3, 1e-12);
    const auto axial =
        std::count_if(sector->edges.begin(), sector->edges.end(), [&](const SectorEdge& e) {
          const auto on_axis = [&](std::int32_t v) {
            return sector->on_axis[static_cast<std::size_t>(
                       sector->vertices[static_cast<std::size_t>(v)].orbit)] != 0;
          };
          return on_axis(e.a) && on_axis(e.b);
        });
    EXPECT_EQ(axial, 1);
  }
}

TEST(PlcSymmetry, WallsThatMeetOnTheAxis) {
  // n walls from the axis to the edges of a prism: the axis is one segment of all.
  for (const std::int32_t n : {3, 4, 5, 8}) {
    Plc plc = prism(n, 1, 2);
    const auto low = static_cast<std::int32_t>(plc.vertices.size());
    plc.vertices.push_back({0, 0, 0});
    plc.vertices.push_back({0, 0, 2});
    for (std::int32_t i = 0; i < n; ++i) {
      plc.facets.push_back(facet({{low, i, n + i, low + 1}}, 9));
      const double a = 2 * std::numbers::pi * (i + 0.5) / n;
      plc.regions.push_back({{0.3 * std::cos(a), 0.3 * std::sin(a), 1}, 1});
    }
    const auto source = symmetrise(plc);
    ASSERT_TRUE(source) << source.error().message;
    EXPECT_EQ((*source)->symmetry().fold, n);
    ExecutionContext context;
    for (std::int32_t i = 0; i < (*source)->candidates(); ++i) {
      const auto sector = (*source)->sector(i, context);
      ASSERT_TRUE(sector) << sector.error().message;
      expect_sound_sector(*sector);
      const auto surface = restore_surface(*sector);
      ASSERT_EQ(surface.facet_area.size(), 4u);
      EXPECT_NEAR(surface.facet_area.back(), 2.0 * n, 1e-12 * n);
    }
    // Materials that alternate need an even number.
    if (n % 2 != 0) continue;
    for (std::size_t r = 0; r < plc.regions.size(); r += 2) plc.regions[r].attribute = 2;
    EXPECT_EQ((*symmetrise(plc))->symmetry().fold, n / 2);
  }
}

TEST(PlcSymmetry, NeedlesPlatesAndPointsOnTheAxis) {
  Plc plc = prism(3, 2, 4);
  // A segment on the axis, a plate across it, a lone vertex on it and three off it.
  const auto first = static_cast<std::int32_t>(plc.vertices.size());
  plc.vertices.push_back({0, 0, 0.5});
  plc.vertices.push_back({0, 0, 1.5});
  plc.segments.push_back({first, first + 1, 4});
  for (int i = 0; i < 3; ++i) {
    const double a = 2 * std::numbers::pi * i / 3 + 0.2;
    plc.vertices.push_back({0.4 * std::cos(a), 0.4 * std::sin(a), 2.5});
  }
  plc.facets.push_back(facet({{first + 2, first + 3, first + 4}}, 7));
  plc.vertices.push_back({0, 0, 3.5});
  for (int i = 0; i < 3; ++i) {
    const double a = 2 * std::numbers::pi * i / 3 + 0.1;
    plc.vertices.push_back({0.5 * std::cos(a), 0.5 * std::sin(a), 3});
  }
  const auto source = symmetrise(plc);
  ASSERT_TRUE(source) << source.error().message;
  EXPECT_EQ((*source)->symmetry().fold, 3);
  ExecutionContext context;
  for (std::int32_t i = 0; i < (*source)->candidates(); ++i) {
    const auto sector = (*source)->sector(i, context);
    ASSERT_TRUE(sector) << sector.error().message;
    expect_sound_sector(*sector);
    // Six of the prism in two orbits, two of the needle, the plate and its middle, the lone ones,
    // the middles of the caps; and what the cut adds.
    const auto fixed =
        std::count(sector->kinds.begin(), sector->kinds.end(), SectorVertexKind::kFixed);
    EXPECT_EQ(fixed, 2 + 2 + 2 + 2 + 2);
  }
}

TEST(PlcSymmetry, InspectionTellsTheLadder) {
  ExecutionContext context;
  Plc plc = prism(12, 1, 1);
  plc.facets[2].marker = plc.facets[6].marker = plc.facets[10].marker = 5;
  const auto inspection = inspect_plc(plc, MeshOptions{}, context);
  ASSERT_TRUE(inspection) << inspection.error().message;
  EXPECT_EQ(inspection->kind, "plc");
  EXPECT_EQ(inspection->fold, 3);
  EXPECT_NEAR(inspection->volume, 6 * std::sin(std::numbers::pi / 6), 1e-12);
  EXPECT_TRUE(inspection->watertight);
  std::vector<std::int32_t> folds, accepted;
  for (const FoldCandidate& f : inspection->folds) {
    folds.push_back(f.fold);
    if (f.accepted) accepted.push_back(f.fold);
    EXPECT_LE(f.error_rel, 1e-12);
  }
  EXPECT_EQ(folds, (std::vector<std::int32_t>{2, 3, 4, 6, 12}));
  EXPECT_EQ(accepted, (std::vector<std::int32_t>{3}));
}

}  // namespace
}  // namespace symcell::solid
