// Sizes of solids from place to place: the field itself, and that meshes keep it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "core/cell/full_mesh.hpp"
#include "core/geometry/triangle_tree.hpp"
#include "core/mesh_model.hpp"
#include "core/solid/sizes/size_field.hpp"
#include "core/solid/sizes/size_lookup.hpp"
#include "core/solid/sizes/size_sources.hpp"
#include "core/solid/sizes/wall_sizes.hpp"
#include "tests/support/plc_builders.hpp"
#include "tests/support/surface_builders.hpp"

namespace symcell {
namespace {

using solid::SizeField;
using solid::SizeLookup;
using solid::SizeSource;

TEST(SizeField, IsTheSmallestThatAnyCopyAllows) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> in(-1, 1);
  const auto point = [&] { return Point3{3 * in(random), 3 * in(random), in(random)}; };
  for (const std::int32_t fold : {1, 2, 3, 7, 24}) {
    for (const double gradation : {1.2, 1.5, 2.5, 4.0}) {
      std::vector<SizeSource> sources;
      for (int i = 0; i < 40; ++i) {
        const Point3 a = point();
        // Some reach over many sectors, some over the axis.
        const double reach = std::pow(10, 2 * in(random)-1);
        const auto near = [&] {
          return a + Point3{reach * in(random), reach * in(random), reach * in(random)};
        };
        sources.push_back({{a, near(), near()}, 0.05 + 0.5 * std::abs(in(random))});
      }
      const SizeField field(sources, gradation, fold);
      SizeLookup lookup(std::make_shared<const SizeField>(field), {0, 0, 0}, 2.5);
      const RotationTable rotations(fold);
      for (int i = 0; i < 400; ++i) {
        const Point3 p = point();
        double wanted = kInfinity;
        for (const SizeSource& s : sources) {
          for (std::int32_t k = 0; k < fold; ++k) {
            const Point3 q = rotations.rotate(p, k);
            const double d = distance(q, closest_point(q, s.place[0], s.place[1], s.place[2]));
            wanted = std::min(wanted, s.size + (gradation - 1) * std::max(0.0, d - 0.5 * s.size));
          }
        }
        EXPECT_NEAR(field.max_edge(p), wanted, 1e-9) << fold << ", " << gradation;
        EXPECT_NEAR(lookup.max_edge(p, kInfinity), wanted, 1e-9) << fold << ", " << gradation;
        EXPECT_EQ(lookup.max_edge(p, 0.5 * wanted), 0.5 * wanted);
      }
    }
  }
}

// A disc in triangles of its own, larger and smaller than sectors.
TEST(SizeField, TheFirstSectorOfAFaceStandsForAll) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> in(0, 1);
  for (const std::int32_t fold : {1, 2, 3, 8, 24}) {
    for (const double middle : {0.0, 0.4}) {
      std::vector<double> turns;
      for (int i = 0; i < 9; ++i)
        turns.push_back(2 * std::numbers::pi * (i + 0.9 * in(random)) / 9);
      std::vector<SizeSource> sources;
      for (std::size_t i = 0; i < turns.size(); ++i) {
        const double a = turns[i], b = turns[(i + 1) % turns.size()];
        sources.push_back({{Point3{middle, 0.1, 0}, Point3{std::cos(a), std::sin(a), 0},
                            Point3{std::cos(b), std::sin(b), 0}},
                           0.1});
      }
      const SizeField all(sources, 1.5, fold);
      const SizeField one(solid::of_first_sector(sources, fold), 1.5, fold);
      for (int i = 0; i < 200; ++i) {
        const double r = 0.7 * in(random), turn = 7 * in(random);
        const Point3 p{r * std::cos(turn), r * std::sin(turn), 3 * in(random)};
        EXPECT_NEAR(one.max_edge(p), all.max_edge(p), 1e-9) << fold;
      }
    }
  }
}

// Crowds of sources: of one size, and of many.
TEST(SizeLookup, IsTheFieldWhereSourcesCrowd) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> in(-1, 1);
  for (const double spread : {0.0, 0.2}) {
    std::vector<SizeSource> sources;
    for (int i = 0; i < 3000; ++i) {
      const Point3 a{in(random), in(random), 0};
      sources.push_back({{a, a, a}, 0.2 + spread * std::abs(in(random))});
    }
    const auto field = std::make_shared<const SizeField>(sources, 1.5, 5);
    SizeLookup lookup(field, {0, 0, 0}, 3);
    for (int i = 0; i < 2000; ++i) {
      const Point3 p{2 * in(random), 2 * in(random), 4 * in(random)};
      const double wanted = field->max_edge(p);
      EXPECT_NEAR(lookup.max_edge(p, kInfinity), wanted, 1e-9);
      EXPECT_NEAR(lookup.max_edge(p, 1.1 * wanted), wanted, 1e-9);
    }
  }
}

TEST(SizeField, WithoutSourcesHasNoBound) {
  EXPECT_EQ(SizeField({}, 1.5, 3).max_edge({1, 2, 3}), kInfinity);
}

struct Meshed {
  SymmetryCellMesh cell;
  Statistics statistics;
  std::vector<std::array<Point3, 4>> tets;
};

Meshed meshed(const Model& model, const MeshOptions& options) {
  ExecutionContext context;
  auto outcome = mesh_model(model, options, context);
  EXPECT_TRUE(outcome) << (outcome ? "" : outcome.error().message);
  if (!outcome) return {};
  Meshed m{std::move(outcome->mesh), std::move(outcome->statistics), {}};
  const FullMeshView view(m.cell);
  for (std::size_t e = 0; e < m.cell.element_count(); ++e) {
    std::array<Point3, 4> p;
    for (std::size_t i = 0; i < 4; ++i) {
      p[i] = view.cell_node_position(static_cast<std::size_t>(m.cell.elements[4 * e + i]));
    }
    m.tets.push_back(p);
  }
  return m;
}

double longest(const std::array<Point3, 4>& p) {
  double most = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < i; ++j) most = std::max(most, distance(p[i], p[j]));
  }
  return most;
}

Point3 middle(const std::array<Point3, 4>& p) {
  return 0.25 * (p[0] + p[1] + p[2] + p[3]);
}

MeshOptions with_fold(std::int32_t fold) {
  MeshOptions options;
  options.fold = fold;
  options.axis_origin = Point3{0, 0, 0};
  options.axis_direction = Point3{0, 0, 1};
  return options;
}

// Of facets with a marker the longest edge.
double longest_on(const Meshed& m, const std::string& name) {
  const FullMeshView view(m.cell);
  double most = 0;
  for (std::size_t b = 0; b < m.cell.facet_count(); ++b) {
    const auto own =
        std::ranges::find(m.cell.marker_names, m.cell.boundary_markers[b], &MarkerName::marker);
    if (own == m.cell.marker_names.end() || own->name != name) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto at = [&](std::size_t c) {
        return view.cell_node_position(static_cast<std::size_t>(m.cell.boundary[3 * b + c % 3]));
      };
      most = std::max(most, distance(at(i), at(i + 1)));
    }
  }
  return most;
}

TEST(Sizes, OfAGroupHoldOnItAndGrowAwayFromIt) {
  const TriangleSurface ring = ring_surface(48, 6, 2, 3);
  MeshOptions options = with_fold(8);
  const std::size_t coarse = meshed(ring, options).tets.size();
  options.sizes = {{SizeRequest::Kind::kGroup, 0, 0.3, "bore"}};
  for (const double gradation : {kInfinity, 2.0}) {
    options.gradation = gradation;
    const Meshed m = meshed(ring, options);
    EXPECT_GT(m.tets.size(), coarse);
    EXPECT_LE(longest_on(m, "bore"), 0.3 * (1 + 1e-9));
    const double slope = std::isfinite(gradation) ? gradation - 1 : solid::kStandardGradation - 1;
    std::size_t large = 0;
    for (const auto& p : m.tets) {
      const double r = std::hypot(middle(p).x, middle(p).y);
      // The bore is a polygon: its sides are nearer to the axis than its corners.
      const double off = std::max(0.0, r - 2 * std::cos(std::numbers::pi / 48));
      EXPECT_LE(longest(p), 0.3 + slope * std::max(0.0, off - 0.15) + 0.02);
      large += longest(p) > 0.6 ? 1 : 0;
    }
    EXPECT_GT(large, 0U) << "the sizes are of the group alone";
    EXPECT_LT(m.tets.size(), 20000U);
  }
}

TEST(Sizes, OfPointsHoldAtAllCopies) {
  MeshOptions options = with_fold(6);
  options.sizes = {{SizeRequest::Kind::kPoint, 0, 0.15, "", {-4, 0.3, 1.5}}};
  const Meshed m = meshed(ring_surface(48, 6, 2, 3), options);
  const RotationTable rotations(6);
  std::size_t near = 0;
  for (const auto& p : m.tets) {
    for (std::int32_t k = 0; k < 6; ++k) {
      if (distance(rotations.rotate(middle(p), k), {-4, 0.3, 1.5}) > 0.075) continue;
      EXPECT_LE(longest(p), 0.15 * (1 + 1e-9));
      ++near;
    }
  }
  EXPECT_GT(near, 0U);
}

TEST(Sizes, OfMarkersOfAPlc) {
  Plc box = test::box({-1, -1, 0}, {1, 1, 2});
  for (std::size_t f = 0; f < box.facets.size(); ++f) {
    const bool top = std::ranges::all_of(box.facets[f].polygons[0], [&](std::int32_t v) {
      return box.vertices[static_cast<std::size_t>(v)].z == 2;
    });
    box.facets[f].marker = top ? 7 : 1;
  }
  MeshOptions options = with_fold(4);
  options.sizes = {{SizeRequest::Kind::kMarker, 7, 0.2}};
  const Meshed m = meshed(box, options);
  for (const auto& p : m.tets) {
    if (std::ranges::count_if(p, [](Point3 q) { return q.z > 2 - 1e-9; }) >= 2) {
      EXPECT_LE(longest(p), 0.2 * (1 + 1e-9));
    }
  }
  options.sizes = {{SizeRequest::Kind::kMarker, 8, 0.2}};
  ExecutionContext context;
  const auto refused = mesh_model(box, options, context);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kBadOption);
  EXPECT_NE(refused.error().message.find("7"), std::string::npos);
}

TEST(Sizes, UnknownRegionsAreRefused) {
  Plc box = test::box({-1, -1, 0}, {1, 1, 2});
  const auto refusal = [](const Model& model, std::int64_t region) {
    MeshOptions options = with_fold(4);
    options.sizes = {{SizeRequest::Kind::kRegion, region, 0.5}};
    ExecutionContext context;
    const auto outcome = mesh_model(model, options, context);
    if (outcome) return std::string();
    EXPECT_EQ(outcome.error().code, ErrorCode::kBadOption);
    return outcome.error().message;
  };
  EXPECT_EQ(refusal(box, 0), "");
  EXPECT_NE(refusal(box, 3).find("region 3"), std::string::npos);
  box.regions.push_back({{0, 0, 1}, 5, kInfinity});
  EXPECT_EQ(refusal(box, 5), "");
  const std::string message = refusal(box, 3);
  EXPECT_NE(message.find("region 3"), std::string::npos) << message;
  EXPECT_NE(message.find("the regions are 5"), std::string::npos) << message;
  // All of it has an attribute.
  EXPECT_NE(refusal(box, 0), "");
  const std::string of_surface = refusal(ring_surface(48, 6, 2, 3), 0);
  EXPECT_NE(of_surface.find("region 0"), std::string::npos) << of_surface;
}

// Where markers are not part of the symmetry those of every copy may be named.
TEST(Sizes, OfMarkersThatDifferBetweenCopies) {
  Plc box = test::box({-1, -1, 0}, {1, 1, 2});
  std::int32_t next = 1;
  for (PlcFacet& f : box.facets) f.marker = next++;
  MeshOptions options = with_fold(4);
  options.ignore_markers = true;
  const std::size_t coarse = meshed(box, options).tets.size();
  for (std::int32_t marker = 1; marker < next; ++marker) {
    options.sizes = {{SizeRequest::Kind::kMarker, marker, 0.4}};
    EXPECT_GT(meshed(box, options).tets.size(), 2 * coarse) << marker;
  }
}

TEST(Sizes, WhatHasNoEffectIsTold) {
  const TriangleSurface ring = ring_surface(48, 6, 2, 3);
  const auto told = [&](const std::vector<SizeRequest>& sizes) {
    MeshOptions options = with_fold(8);
    options.sizes = sizes;
    std::string text;
    for (const Warning& w : meshed(ring, options).statistics.warnings) {
      if (w.code == WarningCode::kSizesWithoutEffect) text += w.text;
    }
    return text;
  };
  using Kind = SizeRequest::Kind;
  EXPECT_EQ(told({{Kind::kGroup, 0, 0.8, "bore"}, {Kind::kPoint, 0, 0.5, "", {4, 0, 1}}}), "");
  EXPECT_NE(told({{Kind::kPoint, 0, 0.5, "", {400, 0, 1}}}).find("point:400/0/1=0.5"),
            std::string::npos);
  // Beside the part, but near enough.
  EXPECT_EQ(told({{Kind::kPoint, 0, 0.5, "", {7, 0, 1}}}), "");
  const std::string twice = told({{Kind::kGroup, 0, 0.8, "bore"}, {Kind::kGroup, 0, 1.2, "bore"}});
  EXPECT_NE(twice.find("bore=1.2 beside bore=0.8"), std::string::npos) << twice;
}

TEST(Sizes, UnknownGroupsAreRefusedWithThoseThatThereAre) {
  MeshOptions options = with_fold(8);
  options.sizes = {{SizeRequest::Kind::kGroup, 0, 0.3, "boar"}};
  ExecutionContext context;
  const auto refused = mesh_model(ring_surface(48, 6, 2, 3), options, context);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kBadOption);
  EXPECT_NE(refused.error().message.find("bore"), std::string::npos);
}

TEST(Sizes, ChordErrorBoundsEdgesOnCurvedGroups) {
  MeshOptions options = with_fold(8);
  options.chord_error_rel = 0.002;
  options.chord_error_given = true;
  const Meshed m = meshed(ring_surface(240, 6, 2, 3), options);
  const auto chord = [](double r) { return 2 * r * std::sqrt(0.002 * 1.998); };
  EXPECT_LE(longest_on(m, "bore"), chord(2) * 1.001);
  EXPECT_LE(longest_on(m, "rim"), chord(6) * 1.001);
}

TEST(Sizes, PresetsPutElementsAcrossWalls) {
  // A tube with a wall of 0.5.
  const TriangleSurface tube = ring_surface(96, 5, 4.5, 1.5);
  std::size_t before = 0;
  for (const auto& [preset, edge] : {std::pair{Preset::kCoarse, 0.5}, {Preset::kNormal, 0.25}}) {
    MeshOptions options = with_fold(8);
    options.preset = preset;
    const Meshed m = meshed(tube, options);
    for (const auto& p : m.tets) EXPECT_LE(longest(p), 1.2 * edge + 0.05);
    EXPECT_GT(m.tets.size(), before);
    before = m.tets.size();
  }
}

TEST(Sizes, WallsAreSeenThroughTheMaterial) {
  const TriangleSurface box = box_surface({-2, -2, 0}, {2, 2, 0.5});
  IndexedSurface surface{box.vertices, box.triangles, {}};
  ExecutionContext context;
  const TriangleTree tree(surface.points, surface.triangles);
  const auto walls = solid::wall_sizes(surface, tree, 1, false, context);
  ASSERT_TRUE(walls);
  for (const SizeSource& w : *walls) {
    const bool flat = std::abs(w.place[0].z - w.place[1].z) < 1e-9 &&
                      std::abs(w.place[0].z - w.place[2].z) < 1e-9;
    EXPECT_NEAR(w.size, flat ? 0.5 : 4, 1e-4);
  }
}

TEST(MeshToCount, ComesWithinATenth) {
  for (const std::uint64_t wanted : {1500ULL, 3000ULL}) {
    MeshOptions options = with_fold(8);
    options.target_elements = wanted;
    const Meshed m = meshed(ring_surface(48, 6, 2, 3), options);
    EXPECT_NEAR(static_cast<double>(m.tets.size()), static_cast<double>(wanted),
                0.1 * static_cast<double>(wanted));
    EXPECT_EQ(m.statistics.target.elements, wanted);
    EXPECT_GT(m.statistics.target.max_edge, 0);
  }
}

TEST(MeshToCount, SaysWhatItCannotReach) {
  MeshOptions options = with_fold(8);
  options.target_elements = 3;
  const Meshed m = meshed(ring_surface(48, 6, 2, 3), options);
  EXPECT_TRUE(std::ranges::any_of(m.statistics.warnings, [](const Warning& w) {
    return w.code == WarningCode::kElementsMissed;
  }));
}

}  // namespace
}  // namespace symcell
