// Bodies that touch: united or left apart at all copies alike, however their corners were rounded.
#include "core/solid/surface/contacts.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/random.hpp"
#include "core/geometry/self_intersections.hpp"
#include "core/mesh_model.hpp"
#include "core/solid/surface/clean_surface.hpp"
#include "core/solid/surface/sheets.hpp"
#include "core/solid/surface/weld.hpp"
#include "tests/support/surface_builders.hpp"
#include "tests/support/touching_bodies.hpp"

namespace symcell::solid {
namespace {

using test::body;
using test::prism_with_bodies;
using test::Touch;

CleanSurface cleaned(const TriangleSurface& surface, Repair repair = Repair::kSafe) {
  ExecutionContext context;
  auto clean = clean_surface(surface, context, kSurfaceSymmetryToleranceRel, repair);
  EXPECT_TRUE(clean) << (clean ? "" : clean.error().message);
  return clean ? std::move(*clean) : CleanSurface{};
}

double volume_of(const TriangleSurface& surface) {
  return enclosed_volume(weld_exactly(surface), surface.vertices.front());
}

TEST(Contacts, OfCopiesAreAllTreatedAlike) {
  Random random(11);
  for (const Touch touch : test::kTouches) {
    for (std::int32_t n = 3; n <= 9; ++n) {
      SCOPED_TRACE("touch " + std::to_string(static_cast<int>(touch)) +
                   ", n = " + std::to_string(n));
      const bool moved = n % 2 == 0;
      const Point3 centre = moved ? Point3{13.3, -7.1, 2.9} : Point3{};
      const TriangleSurface model = prism_with_bodies(n, touch, random.uniform(), centre);
      const CleanSurface clean = cleaned(model);
      ASSERT_FALSE(clean.problem) << clean.problem->message;
      EXPECT_EQ(clean.shells, test::is_one_solid(touch) ? 1 : n + 1);
      EXPECT_NEAR(clean.volume, volume_of(model), 2e-4 * clean.volume);
      ExecutionContext context;
      const auto pairs = self_intersections(clean.surface, 1, context);
      ASSERT_TRUE(pairs);
      EXPECT_TRUE(pairs->empty());
      const auto found = inspect_model(Model(model), {}, context);
      ASSERT_TRUE(found) << found.error().message;
      const auto fold = std::get<SolidInspection>(*found).fold;
      EXPECT_EQ(fold % n, 0) << fold;
    }
  }
}

// Corners in common, and faces cut into triangles by other diagonals: rounding makes them cross. And bodies
// that are in a hollow, at its wall.
TEST(Contacts, OfWholeFacesMakeOneSolid) {
  Random random(12);
  for (const test::Assembly kind : test::kAssemblies) {
    for (std::int32_t n = 3; n <= 15; n += 4) {
      SCOPED_TRACE("assembly " + std::to_string(static_cast<int>(kind)) +
                   ", n = " + std::to_string(n));
      const Point3 turns{6 * random.uniform(), 6 * random.uniform(), 6 * random.uniform()};
      const TriangleSurface model = test::assembled(n, kind, turns, {1, 2, 3});
      const CleanSurface clean = cleaned(model);
      ASSERT_FALSE(clean.problem) << clean.problem->message;
      const test::United united = test::united(n, kind);
      EXPECT_EQ(clean.shells, united.shells);
      EXPECT_NEAR(clean.volume, volume_of(model) - united.overlap, 1e-4 * clean.volume);
      ExecutionContext context;
      const auto found = inspect_model(Model(model), {}, context);
      ASSERT_TRUE(found) << found.error().message;
      const auto fold = std::get<SolidInspection>(*found).fold;
      EXPECT_EQ(n % fold == 0 || fold % n == 0, true) << fold;
      EXPECT_GT(fold, 1);
    }
  }
}

// What touches exactly needs no moving: faces that lie on each other go, to the last digit.
TEST(Contacts, ThatAreExactStayExact) {
  TriangleSurface surface = box_surface({0, 0, 0}, {2, 2, 1});
  append(surface, box_surface({0.5, 0.5, 1}, {1.5, 1.5, 2}));
  append(surface, box_surface({2, 0, 0}, {3, 2, 1}));
  const CleanSurface clean = cleaned(surface);
  ASSERT_FALSE(clean.problem);
  EXPECT_EQ(clean.shells, 1);
  EXPECT_DOUBLE_EQ(clean.volume, 7);
}

// Bars across another, one a rounding in, one off: none has a corner at another.
TEST(Contacts, OfCrossedBarsAreFound) {
  for (const double off : {0.0, 3e-7, 1e-6}) {
    TriangleSurface surface = box_surface({-3, -0.5, 0}, {3, 0.5, 1});
    append(surface, box_surface({-2, -3, 1 - 1e-7}, {-1, 3, 2}));
    append(surface, box_surface({1, -3, 1 + off}, {2, 3, 2}));
    test::turn(surface, 0.3);
    const CleanSurface clean = cleaned(surface);
    ASSERT_FALSE(clean.problem) << clean.problem->message;
    EXPECT_EQ(clean.shells, 1) << off;
    EXPECT_NEAR(clean.volume, 18, 1e-3);
  }
}

// Gaps and walls that are a shape stay, and a body's own other side is no contact.
TEST(Contacts, AreNotSeenInGapsAndThinWalls) {
  ExecutionContext context;
  for (const double thin : {1e-4, 1e-5}) {
    TriangleSurface apart = box_surface({0, 0, 0}, {1, 1, 1});
    append(apart, box_surface({0, 0, 1 + thin}, {1, 1, 2}));
    IndexedSurface surface = weld_exactly(apart);
    EXPECT_TRUE(deepen_contacts(surface, 2e-6, context)->empty());
    EXPECT_EQ(cleaned(apart).shells, 2);

    TriangleSurface hollow = box_surface({0, 0, 0}, {1, 1, 1});
    TriangleSurface inner = box_surface({0.25, 0.25, 0.25}, {0.75, 0.75, 1 - thin});
    turn_inside_out(inner);
    append(hollow, inner);
    EXPECT_EQ(cleaned(hollow).shells, 2);
  }
  // A wall thinner than the reach: its sides look away from each other.
  TriangleSurface hollow = box_surface({0, 0, 0}, {1, 1, 1});
  TriangleSurface inner = box_surface({0.25, 0.25, 0.25}, {0.75, 0.75, 1 - 1e-6});
  turn_inside_out(inner);
  append(hollow, inner);
  IndexedSurface surface = weld_exactly(hollow);
  EXPECT_TRUE(deepen_contacts(surface, 2e-6, context)->empty());
}

TEST(Contacts, AreLeftToTheUserWhereNothingMayBeRepaired) {
  const TriangleSurface model = prism_with_bodies(5, Touch::kFace, 0.3, {});
  EXPECT_TRUE(cleaned(model, Repair::kNone).problem);
  EXPECT_FALSE(cleaned(model, Repair::kSafe).repairs.empty());
}

// Two boxes over a common corner, alone and beside what else meets; an hourglass of one body.
TEST(Contacts, CornersAreTakenApart) {
  TriangleSurface corner = box_surface({0, 0, 0}, {1, 1, 1});
  append(corner, box_surface({-1, -1, -1}, {0, 0, 0}));
  TriangleSurface with_edge = corner;
  append(with_edge, box_surface({1, 1, 0}, {2, 2, 1}));
  TriangleSurface hourglass = body(Touch::kCorner, 0, 1);
  TriangleSurface mirrored = body(Touch::kCorner, 0, 1);
  for (Point3& p : mirrored.vertices) p.x = -p.x;
  for (auto& t : mirrored.triangles) std::swap(t[1], t[2]);
  append(hourglass, mirrored);
  for (const auto& [model, shells, volume] :
       {std::tuple{corner, 2, 2.0}, {with_edge, 3, 3.0}, {hourglass, 2, volume_of(hourglass)}}) {
    EXPECT_TRUE(cleaned(model, Repair::kNone).problem);
    const CleanSurface clean = cleaned(model);
    ASSERT_FALSE(clean.problem) << clean.problem->message;
    EXPECT_EQ(clean.shells, shells);
    EXPECT_NEAR(clean.volume, volume, 1e-3 * volume);
    const Touching left = touching_places(clean.surface);
    EXPECT_EQ(left.edges + left.corners, 0U);
    ASSERT_FALSE(clean.repairs.empty());
    EXPECT_NE(clean.repairs.back().find("1 corner"), std::string::npos) << clean.repairs.back();
  }
}

// Faces of two bodies on each other: each stays with its own.
TEST(Contacts, BodiesAreToldApart) {
  TriangleSurface surface = box_surface({0, 0, 0}, {1, 1, 1});
  append(surface, box_surface({1, 0, 0}, {2, 1, 1}));    // a face
  append(surface, box_surface({1, 1, 1}, {2, 2, 2}));    // an edge of the second
  append(surface, box_surface({-1, -1, 1}, {0, 0, 2}));  // a corner of the first
  const auto bodies = bodies_of(weld_exactly(surface));
  ASSERT_TRUE(bodies) << bodies.error().message;
  for (std::size_t t = 0; t < bodies->size(); ++t) {
    for (std::size_t u = 0; u < t; ++u) {
      EXPECT_EQ((*bodies)[t] == (*bodies)[u], t / 12 == u / 12) << t << " and " << u;
    }
  }
}

}  // namespace
}  // namespace symcell::solid
