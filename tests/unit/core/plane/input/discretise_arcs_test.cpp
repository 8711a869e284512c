// Where arcs are cut into chords: within the error, alike in all copies, in phase with the fold.
#include "core/plane/input/discretise_arcs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <variant>

#include "core/geometry/arc.hpp"
#include "core/mesh_model.hpp"

namespace symcell::plane {
namespace {

// A circle as two halves that begin at an angle.
void add_circle(Pslg& pslg, Point2 centre, double radius, double angle, std::int32_t marker = 0) {
  const auto first = static_cast<std::int32_t>(pslg.vertices.size());
  const Point2 spoke = radius * Point2{std::cos(angle), std::sin(angle)};
  pslg.vertices.push_back(centre + spoke);
  pslg.vertices.push_back(centre - spoke);
  pslg.segments.push_back({first, first + 1, marker});
  pslg.segments.push_back({first + 1, first, marker});
  pslg.bulges.resize(pslg.segments.size(), 1);
}

// A disc with a bore and bolt holes, all of whose circles begin in the direction of the x axis.
Pslg flange(std::int32_t bolts) {
  Pslg pslg;
  add_circle(pslg, {0, 0}, 10, 0, 1);
  add_circle(pslg, {0, 0}, 3, 0, 2);
  pslg.holes.push_back({0, 0});
  for (std::int32_t i = 0; i < bolts; ++i) {
    const double angle = 2 * std::numbers::pi * i / bolts + 0.1;
    const Point2 place = 7 * Point2{std::cos(angle), std::sin(angle)};
    add_circle(pslg, place, 1, 0, 3);
    pslg.holes.push_back(place);
  }
  return pslg;
}

ChordedPslg chorded(const Pslg& pslg, const MeshOptions& options = {}) {
  ExecutionContext context;
  auto result = discretise_arcs(pslg, options, context);
  EXPECT_TRUE(result) << result.error().message;
  return result ? *result : ChordedPslg{};
}

// Whether the rotation about the origin permutes the vertices.
bool permutes(const Pslg& pslg, std::int32_t fold) {
  const double angle = 2 * std::numbers::pi / fold;
  for (const Point2 p : pslg.vertices) {
    bool found = false;
    for (const Point2 q : pslg.vertices) found = found || distance(turned(p, angle), q) < 1e-9;
    if (!found) return false;
  }
  return true;
}

std::size_t with_marker(const Pslg& pslg, std::int32_t marker) {
  std::size_t count = 0;
  for (const PslgSegment& s : pslg.segments) count += s.marker == marker ? 1 : 0;
  return count;
}

TEST(DiscretiseArcs, ChordsAreInPhaseWithTheFold) {
  for (const std::int32_t bolts : {3, 5, 6, 7, 12}) {
    const ChordedPslg result = chorded(flange(bolts));
    EXPECT_TRUE(permutes(result.pslg, bolts)) << bolts;
    EXPECT_EQ(with_marker(result.pslg, 1) % static_cast<std::size_t>(bolts), 0U) << bolts;
    EXPECT_EQ(result.pslg.segments.size(), result.source.size());
  }
}

// A star of nearly straight arcs, as a gear's flanks are, every number rounded as drawings have them.
Pslg rounded_star(std::int32_t tips, double unit) {
  const auto rounded = [&](double x) { return unit * std::round(x / unit); };
  Pslg pslg;
  for (std::int32_t i = 0; i < 2 * tips; ++i) {
    const double angle = std::numbers::pi * i / tips + 0.3, radius = i % 2 == 0 ? 40 : 33;
    pslg.vertices.push_back({rounded(radius * std::cos(angle)), rounded(radius * std::sin(angle))});
    pslg.segments.push_back({i, (i + 1) % (2 * tips), 0});
    pslg.bulges.push_back(rounded(i % 2 == 0 ? 0.0123 : -0.0127));
  }
  return pslg;
}

// The radius of a nearly straight arc is known far worse than its ends are.
TEST(DiscretiseArcs, RoundedArcsKeepTheirFold) {
  for (const std::int32_t tips : {5, 13, 15, 17}) {
    SCOPED_TRACE(tips);
    ExecutionContext context;
    const auto found = inspect_model(Model(rounded_star(tips, 1e-5)), {}, context);
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_EQ(std::get<PslgInspection>(*found).fold, tips);
    // Beyond the tolerance, but not by ten times: not taken, and told.
    const auto nearly = inspect_model(Model(rounded_star(tips, 2e-4)), {}, context);
    ASSERT_TRUE(nearly) << nearly.error().message;
    const auto& inspection = std::get<PslgInspection>(*nearly);
    EXPECT_EQ(inspection.fold, 1);
    EXPECT_TRUE(
        std::any_of(inspection.warnings.begin(), inspection.warnings.end(),
                    [&](const Warning& w) { return w.near_fold && w.near_fold->fold == tips; }));
  }
}

// On an arc, or between it and its chord, a seed is on another side of the chords than of the arc, or of neither.
TEST(DiscretiseArcs, SeedsOnArcsAreRefused) {
  Pslg plate;
  add_circle(plate, {0, 0}, 10, 0, 1);
  add_circle(plate, {4, 0}, 1.5, std::numbers::pi / 2, 2);
  plate.segments.push_back({2, 3, 3});  // an arc through the hole
  plate.bulges.push_back(0.2);
  const auto on_arc = [&](double share) {
    return arc_point(plate.vertices[2], plate.vertices[3], 0.2, share);
  };
  ExecutionContext context;
  const auto refused = [&](Point2 seed) {
    plate.holes = {seed};
    const auto result = discretise_arcs(plate, {}, context);
    EXPECT_TRUE(result || result.error().pointer == "/holes/0") << result.error().message;
    return !result;
  };
  for (const double share : {0.1, 0.37, 0.5, 0.81}) EXPECT_TRUE(refused(on_arc(share))) << share;
  // Within the arc, by less than its chords are.
  const Point2 inwards = 1e-5 * (Point2{4, 0} - on_arc(0.5));
  int beside = 0;
  for (int i = 1; i < 100; ++i) beside += refused(on_arc(0.01 * i) + inwards) ? 1 : 0;
  EXPECT_GT(beside, 50);
  EXPECT_FALSE(refused(on_arc(0.5) - 1e3 * inwards));
  EXPECT_FALSE(refused({4, 0}));
  EXPECT_FALSE(refused({-3, 0}));
  plate.holes.clear();
  plate.regions = {{on_arc(0.3), 1}};
  const auto region = discretise_arcs(plate, {}, context);
  ASSERT_FALSE(region);
  EXPECT_EQ(region.error().pointer, "/regions/0");
}

TEST(DiscretiseArcs, ChordsKeepTheError) {
  const Pslg model = flange(6);
  for (const double error : {1e-1, 1e-2, 1e-3, 1e-4}) {
    MeshOptions options;
    options.chord_error_rel = error;
    const Pslg pslg = chorded(model, options).pslg;
    double worst = 0;
    for (std::size_t s = 0; s < pslg.segments.size(); ++s) {
      if (pslg.segments[s].marker != 1) continue;
      const Point2 a = pslg.vertices[static_cast<std::size_t>(pslg.segments[s].a)];
      const Point2 b = pslg.vertices[static_cast<std::size_t>(pslg.segments[s].b)];
      EXPECT_NEAR(length(a), 10, 1e-12);
      EXPECT_NEAR(length(arc_middle(a, b, pslg.bulge(s))), 10, 1e-12);
      worst = std::max(worst, 1 - length(0.5 * (a + b)) / 10);
    }
    EXPECT_LE(worst, error * (1 + 1e-9));
    EXPECT_GE(worst, error / 3);
  }
}

TEST(DiscretiseArcs, ChordsKeepTheLongestEdge) {
  MeshOptions options;
  options.max_edge = 0.2;
  const Pslg pslg = chorded(flange(6), options).pslg;
  for (const PslgSegment& s : pslg.segments) {
    EXPECT_LE(distance(pslg.vertices[static_cast<std::size_t>(s.a)],
                       pslg.vertices[static_cast<std::size_t>(s.b)]),
              0.2);
  }
}

TEST(DiscretiseArcs, AngleOfTheModelStandsForTheError) {
  Pslg pslg;
  add_circle(pslg, {0, 0}, 1, 0.3);
  pslg.chord_angles = {std::numbers::pi / 6, std::numbers::pi / 6};
  MeshOptions options;
  options.fold = 1;
  EXPECT_EQ(chorded(pslg, options).pslg.segments.size(), 12U);
}

TEST(DiscretiseArcs, JointsThatTheFoldPermutesStay) {
  // A circle of six arcs; of five the joints go, as nothing else is five-fold.
  Pslg pslg;
  for (int i = 0; i < 6; ++i) {
    const double angle = std::numbers::pi * i / 3;
    pslg.vertices.push_back({std::cos(angle), std::sin(angle)});
    pslg.segments.push_back({i, (i + 1) % 6, 1});
    pslg.bulges.push_back(bulge_of_angle(std::numbers::pi / 3));
  }
  MeshOptions options;
  options.fold = 3;
  const Pslg kept = chorded(pslg, options).pslg;
  for (std::size_t v = 0; v < 6; ++v) EXPECT_EQ(kept.vertices[v], pslg.vertices[v]);
  options.fold = 5;
  EXPECT_TRUE(permutes(chorded(pslg, options).pslg, 5));
}

TEST(DiscretiseArcs, VerticesOnArcsCutThem) {
  // A half disc with a spoke to the middle of its arc, which is one segment.
  Pslg pslg{{{-1, 0}, {1, 0}, {0, 0}, {0, 1}}, {{0, 2}, {2, 1}, {1, 0}, {2, 3}}, {}, {}};
  pslg.bulges = {0, 0, 1, 0};
  const Pslg result = chorded(pslg).pslg;
  std::set<std::int32_t> neighbours;
  for (const PslgSegment& s : result.segments) {
    if (s.a == 3) neighbours.insert(s.b);
    if (s.b == 3) neighbours.insert(s.a);
  }
  EXPECT_EQ(neighbours.size(), 3U);
}

TEST(DiscretiseArcs, ArcAndItsChordEncloseSomething) {
  Pslg pslg{{{0, 0}, {1, 0}}, {{0, 1}, {1, 0}}, {}, {}};
  pslg.bulges = {0, 0.05};
  EXPECT_GE(chorded(pslg).pslg.segments.size(), 3U);
}

TEST(DiscretiseArcs, ArcsThatLieCloseGetFinerChords) {
  // Two circles out of phase, nearer to each other than chords of the default are to their arcs.
  Pslg pslg;
  add_circle(pslg, {0, 0}, 1, 0, 1);
  add_circle(pslg, {1e-5, 0}, 1.0001, 0.02, 2);
  pslg.regions = {{{0, 0}, 1, kInfinity}};
  MeshOptions options;
  options.fold = 1;
  const Pslg result = chorded(pslg, options).pslg;
  EXPECT_GT(result.segments.size(), 142U);
}

TEST(DiscretiseArcs, NamesTheArcOfAFault) {
  // Two circles that cross.
  Pslg pslg;
  add_circle(pslg, {0, 0}, 1, 0);
  add_circle(pslg, {1, 0}, 1, 0.3);
  ExecutionContext context;
  const auto result = discretise_arcs(pslg, {}, context);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::kSelfIntersection) << result.error().message;
  for (const std::int64_t s : result.error().elements) EXPECT_LT(s, 4);
  pslg = flange(3);
  pslg.bulges[1] = std::nan("");
  const auto bad = discretise_arcs(pslg, {}, context);
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.error().elements, (std::vector<std::int64_t>{1}));
}

}  // namespace
}  // namespace symcell::plane
