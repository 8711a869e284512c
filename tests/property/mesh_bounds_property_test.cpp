// What the bounds of planar meshes mean: none where none is asked for, more triangles for more angle.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "core/base/execution_context.hpp"
#include "core/mesh_model.hpp"
#include "tests/property/mesh_laws.hpp"
#include "tests/property/random_case.hpp"
#include "tests/property/restored_mesh.hpp"
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

// The shortest edge with an end at which the model has no vertex.
double shortest_made_edge(const MeshOutcome& outcome, const Pslg& model) {
  const RestoredMesh full = restore(outcome.mesh);
  // The centre is added as a vertex of the model.
  std::vector<Point2> places = model.vertices;
  places.push_back({outcome.mesh.axis_origin.x, outcome.mesh.axis_origin.y});
  std::vector<char> given;
  for (std::size_t i = 0; i < full.points.size(); ++i) {
    const Point2 x = full.points[i];
    given.push_back(
        std::any_of(places.begin(), places.end(), [&](Point2 p) { return distance(p, x) < 1e-9; })
            ? 1
            : 0);
  }
  double shortest = kInfinity;
  for (std::size_t h = 0; h < 3 * full.triangles.size(); ++h) {
    const auto a = static_cast<std::size_t>(full.from(h)), b = static_cast<std::size_t>(full.to(h));
    if (given[a] != 0 && given[b] != 0) continue;
    shortest = std::min(shortest, distance(full.at(full.from(h)), full.at(full.to(h))));
  }
  return shortest;
}

std::uint64_t exempt_of(const MeshOutcome& outcome, const std::string& reason) {
  for (const ExemptCount& e : outcome.statistics.exempt) {
    if (e.reason == reason) return e.elements;
  }
  return 0;
}

TEST(MeshBoundsProperty, NoEdgeShorterThanTheLeast) {
  const std::vector<Pslg> models = {gear(12, 1, 0.8, 0.3), flange(6, 1, 0.7, 0.1, 0.2),
                                    regular_ring(30, 1, 0.98), plate_with_gap(1e-3),
                                    star(9, 1, 0.6)};
  for (const Pslg& model : models) {
    const double scale = length(model.vertices.front());
    std::uint64_t last_exempt = 0;
    for (const double least : {1e-4, 0.01, 0.03, 0.1, 0.3}) {
      for (const bool plain : {false, true}) {
        for (const double angle : {20.0, 33.0}) {
          MeshOptions options;
          options.min_angle_deg = angle;
          options.min_edge = least * scale;
          options.plain = plain;
          const std::string label = "model " + std::to_string(&model - models.data()) +
                                    ", min_edge " + std::to_string(options.min_edge) + ", angle " +
                                    std::to_string(angle) + (plain ? ", plain" : "");
          const auto outcome = mesh(model, options);
          ASSERT_TRUE(outcome) << label << ": " << outcome.error().message;
          EXPECT_GE(shortest_made_edge(*outcome, model), options.min_edge * (1 - 1e-9)) << label;
          last_exempt = exempt_of(*outcome, "min_edge");
        }
      }
    }
    // The last and longest leaves something undone in most of these models; the first nothing in
    // those whose features are larger.
    EXPECT_TRUE(&model - models.data() != 3 || last_exempt > 0);
  }
}

// Where nothing asks for edges as short, the bound changes nothing that is promised.
TEST(MeshBoundsProperty, LeastEdgesBelowAllFeaturesExemptNothing) {
  for (const Pslg& model : {gear(12, 1, 0.8, 0.3), flange(6, 1, 0.7, 0.1, 0.2)}) {
    MeshOptions options;
    const auto free = mesh(model, options);
    options.min_edge = 1e-6;
    const auto bound = mesh(model, options);
    ASSERT_TRUE(free && bound);
    EXPECT_TRUE(bound->statistics.exempt.empty());
    EXPECT_LE(static_cast<double>(bound->statistics.cell.elements),
              1.05 * static_cast<double>(free->statistics.cell.elements) + 4);
  }
}

// A stop instead of a failure.
TEST(MeshBoundsProperty, LeastEdgesEndWhatNoBoundWould) {
  MeshOptions options;
  options.max_elements = 5000;
  const Pslg model = plate_with_gap(1e-6);
  EXPECT_FALSE(mesh(model, options));
  options.min_edge = 0.1;
  const auto outcome = mesh(model, options);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_GT(exempt_of(*outcome, "min_edge"), 0U);
}

TEST(MeshBoundsProperty, KeptBoundariesHaveNoNewPoints) {
  for (const Pslg& model : {gear(12, 1, 0.8, 0.3), flange(6, 1, 0.7, 0.1, 0.2),
                            regular_ring(30, 1, 0.9), plate_with_gap(1e-3), spoked_wheel(7, 1)}) {
    for (const bool plain : {false, true}) {
      MeshOptions options;
      options.keep_boundary = true;
      options.plain = plain;
      const auto outcome = mesh(model, options);
      ASSERT_TRUE(outcome) << outcome.error().message;
      const RestoredMesh full = restore(outcome->mesh);
      std::map<std::pair<std::int32_t, std::int32_t>, int> sides;
      for (std::size_t h = 0; h < 3 * full.triangles.size(); ++h) {
        ++sides[std::minmax(full.from(h), full.to(h))];
      }
      for (const auto& [edge, count] : sides) {
        if (count != 1) continue;
        for (const std::int32_t end : {edge.first, edge.second}) {
          EXPECT_TRUE(std::any_of(model.vertices.begin(), model.vertices.end(),
                                  [&](Point2 p) { return distance(p, full.at(end)) < 1e-9; }));
        }
      }
    }
  }
}

TEST(MeshBoundsProperty, SizesHoldAtMarkersAndVerticesAndTheirCopies) {
  constexpr std::int32_t kFold = 8;
  SectorBuilder builder(kFold);
  const auto outer = builder.add_vertex({1, 0});
  const auto inner = builder.add_vertex({0.5, 0});
  builder.add_loop({outer}, 1);
  builder.add_loop({inner}, 2);
  builder.add_hole({0, 0});
  const Pslg& model = builder.pslg();
  for (const bool plain : {false, true}) {
    MeshOptions options;
    options.plain = plain;
    const auto free = mesh(model, options);
    options.sizes = {{SizeRequest::Kind::kMarker, 2, 0.05}, {SizeRequest::Kind::kVertex, 0, 0.03}};
    const auto outcome = mesh(model, options);
    ASSERT_TRUE(free && outcome);
    EXPECT_EQ(outcome->mesh.fold, kFold);
    EXPECT_GT(outcome->statistics.cell.elements, 4 * free->statistics.cell.elements);
    // Less than a hundredth of what the smallest size would take everywhere, were it no local one.
    EXPECT_LT(outcome->statistics.cell.elements, 400U);
    EXPECT_GE(outcome->statistics.cell.min_angle_deg, 30);
    const RestoredMesh full = restore(outcome->mesh);
    for (std::size_t h = 0; h < 3 * full.triangles.size(); ++h) {
      const Point2 a = full.at(full.from(h)), b = full.at(full.to(h));
      const double apothem = 0.5 * std::cos(std::numbers::pi / kFold);
      const auto is_tip = [](Point2 p) { return std::abs(length(p) - 1) < 1e-9; };
      const bool tip = std::any_of(model.vertices.begin(), model.vertices.end(), [&](Point2 v) {
        return is_tip(v) && (distance(v, a) < 1e-9 || distance(v, b) < 1e-9);
      });
      EXPECT_TRUE(!tip || distance(a, b) <= 0.03);
      if (length(0.5 * (a + b)) < apothem + 1e-6 && length(a) < 0.5 + 1e-9 &&
          length(b) < 0.5 + 1e-9) {
        EXPECT_LE(distance(a, b), 0.05);
      }
    }
    options.sizes = {{SizeRequest::Kind::kVertex, 0, 0.03}, {SizeRequest::Kind::kVertex, 1, 0.04}};
    const auto refused = mesh(model, options);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::kBadOption);
    EXPECT_EQ(refused.error().elements, (std::vector<std::int64_t>{0, 1}));
    options.fold = 1;
    EXPECT_TRUE(mesh(model, options)) << "without symmetry they may differ";
    options.sizes = {{SizeRequest::Kind::kMarker, 9, 0.03}};
    EXPECT_EQ(mesh(model, options).error().code, ErrorCode::kBadOption);
    options.sizes = {{SizeRequest::Kind::kVertex, 99, 0.03}};
    EXPECT_EQ(mesh(model, options).error().code, ErrorCode::kBadOption);
  }
}

// A ring of two loops, marker 1 without and 2 within.
SectorBuilder ring_of_markers(std::int32_t fold) {
  SectorBuilder builder(fold);
  const auto outer = builder.add_vertex({1, 0});
  const auto inner = builder.add_vertex({0.5, 0});
  builder.add_loop({outer}, 1);
  builder.add_loop({inner}, 2);
  builder.add_hole({0, 0});
  return builder;
}

TEST(MeshBoundsProperty, EdgesGrowByTheGradationAwayFromSmallOnes) {
  constexpr double kSmall = 0.01;
  SectorBuilder builder = ring_of_markers(6);
  const Pslg& model = builder.pslg();
  for (const bool plain : {false, true}) {
    std::uint64_t fewest = std::numeric_limits<std::uint64_t>::max();
    for (const double gradation : {1.1, 1.3, 2.0, 1e6}) {
      MeshOptions options;
      options.plain = plain;
      options.sizes = {{SizeRequest::Kind::kVertex, 0, kSmall}};
      options.gradation = gradation;
      const auto outcome = mesh(model, options);
      ASSERT_TRUE(outcome) << outcome.error().message;
      EXPECT_EQ(outcome->mesh.fold, 6);
      EXPECT_GE(outcome->statistics.cell.min_angle_deg, 30);
      EXPECT_TRUE(outcome->statistics.exempt.empty());
      EXPECT_LE(outcome->statistics.cell.elements, fewest) << gradation;
      fewest = outcome->statistics.cell.elements;
      const RestoredMesh full = restore(outcome->mesh);
      for (std::size_t h = 0; h < 3 * full.triangles.size(); ++h) {
        const Point2 a = full.at(full.from(h)), b = full.at(full.to(h));
        for (const Point2 v : model.vertices) {
          if (std::abs(length(v) - 1) > 1e-9) continue;
          const double wanted = kSmall + (gradation - 1) * std::min(distance(v, a), distance(v, b));
          EXPECT_LE(distance(a, b), gradation * wanted * (1 + 1e-9));
        }
      }
    }
  }
}

// Short segments and narrow places are what edges grow from where no size is given.
TEST(MeshBoundsProperty, EdgesGrowAwayFromNarrowPlaces) {
  MeshOptions options;
  const auto free = mesh(plate_with_gap(0.02), options);
  options.gradation = 1.2;
  const auto graded = mesh(plate_with_gap(0.02), options);
  ASSERT_TRUE(free && graded);
  EXPECT_GT(graded->statistics.cell.elements, free->statistics.cell.elements);
  for (const auto& law : broken_laws(plate_with_gap(0.02), 396 + 0.04, options, *graded)) {
    ADD_FAILURE() << law;
  }
}

// A disc with a hole out of its centre, each circle an arc and one more.
Pslg disc_with_hole() {
  Pslg model;
  model.vertices = {{40, 0}, {-40, 0}, {33, 0}, {27, 0}};
  model.segments = {{0, 1, 1}, {1, 0, 1}, {2, 3, 2}, {3, 2, 2}};
  model.bulges = {1, 1, 1, 1};
  model.holes = {{30, 0}};
  return model;
}

// No size is asked for that the least edge forbids.
TEST(MeshBoundsProperty, GradationDoesNotAskForLessThanTheLeastEdge) {
  MeshOptions options;
  options.min_edge = 0.5;
  const auto free = mesh(plate_with_gap(0.02), options);
  options.gradation = 1.1;
  const auto graded = mesh(plate_with_gap(0.02), options);
  ASSERT_TRUE(free && graded);
  const auto count = [](const MeshOutcome& outcome) {
    std::uint64_t exempt = 0;
    for (const auto& e : outcome.statistics.exempt) exempt += e.elements;
    return exempt;
  };
  EXPECT_LE(count(*graded), 2 * count(*free));
}

// Chords that are divided for the sake of the gradation are no small features to grow away from.
TEST(MeshBoundsProperty, EdgesOnArcsGrowByTheGradation) {
  MeshOptions options;
  options.fold = 1;
  const auto free = mesh(disc_with_hole(), options);
  ASSERT_TRUE(free) << free.error().message;
  std::uint64_t most = 20'000;
  for (const double gradation : {1.05, 1.2, 1.5}) {
    options.gradation = gradation;
    const auto graded = mesh(disc_with_hole(), options);
    ASSERT_TRUE(graded) << graded.error().message;
    EXPECT_GE(graded->statistics.cell.elements, free->statistics.cell.elements);
    EXPECT_LE(graded->statistics.cell.elements, most) << gradation;
    most = graded->statistics.cell.elements;
  }
}

// Chords are edges that the mesher makes.
TEST(MeshBoundsProperty, ChordsAreNoShorterThanTheLeastEdge) {
  MeshOptions options;
  options.fold = 1;
  options.min_edge = 1;
  const auto outcome = mesh(disc_with_hole(), options);
  ASSERT_TRUE(outcome) << outcome.error().message;
  const RestoredMesh full = restore(outcome->mesh);
  for (std::size_t h = 0; h < 3 * full.triangles.size(); ++h) {
    EXPECT_GE(distance(full.at(full.from(h)), full.at(full.to(h))), 1);
  }
  EXPECT_TRUE(outcome->statistics.exempt.empty());
  EXPECT_GE(outcome->statistics.cell.min_angle_deg, 30);
}

TEST(MeshBoundsProperty, DividedSegmentsHaveEqualPartsAndNoOtherPoints) {
  constexpr std::int32_t kFold = 7, kParts = 9;
  SectorBuilder builder = ring_of_markers(kFold);
  const Pslg& model = builder.pslg();
  const double part = 2 * 0.5 * std::sin(std::numbers::pi / kFold) / kParts;
  for (const bool plain : {false, true}) {
    MeshOptions options;
    options.plain = plain;
    options.divisions = {{2, kParts}};
    options.max_edge = 0.03;  // on the other loop alone: shorter than the parts
    const auto outcome = mesh(model, options);
    ASSERT_TRUE(outcome) << outcome.error().message;
    EXPECT_EQ(outcome->mesh.fold, kFold);
    const RestoredMesh full = restore(outcome->mesh);
    std::map<std::pair<std::int32_t, std::int32_t>, int> sides;
    for (std::size_t h = 0; h < 3 * full.triangles.size(); ++h) {
      ++sides[std::minmax(full.from(h), full.to(h))];
    }
    int inner = 0;
    for (const auto& [edge, count] : sides) {
      const Point2 a = full.at(edge.first), b = full.at(edge.second);
      if (count != 1 || std::max(length(a), length(b)) > 0.5 + 1e-9) continue;
      ++inner;
      EXPECT_NEAR(distance(a, b), part, 1e-9);
    }
    EXPECT_EQ(inner, kFold * kParts);
    EXPECT_GT(exempt_of(*outcome, "kept_boundary"), 0U) << "parts are longer than max_edge";
    options.max_edge = kInfinity;
    EXPECT_EQ(exempt_of(*mesh(model, options), "kept_boundary"), 0U);
  }
  MeshOptions options;
  options.divisions = {{9, 2}};
  EXPECT_EQ(mesh(model, options).error().code, ErrorCode::kBadOption);
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
