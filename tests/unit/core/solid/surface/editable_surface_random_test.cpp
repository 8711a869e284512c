// Random edits of a quotient surface: it stays closed and of the same topology, and marked sides
// stay edges.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "core/base/random.hpp"
#include "core/solid/surface/editable_surface.hpp"
#include "tests/unit/core/solid/editable_checks.hpp"

namespace symcell::solid {
namespace {

using test::slots;

constexpr int kFew = 20;  // triangles

// One edit at random; false if it was not allowed.
bool edit(EditableSurface& mesh, Random& random) {
  const auto t = static_cast<std::int32_t>(random.next() % mesh.surface().triangles.size());
  const auto side = static_cast<std::int32_t>(random.next() % 3);
  if (!mesh.alive(t)) return false;
  const std::uint64_t kind = random.next() % 8;
  if (kind == 0) {
    const auto changed = mesh.split(t, side);
    test::expect_as_planned(mesh, changed);
    return !changed.empty();
  }
  if (kind < 4) {
    const auto plan = mesh.plan_flip(t, side);
    if (!plan) return false;
    mesh.flip(*plan);
    test::expect_as_planned(mesh, plan->changed);
    return true;
  }
  // Too few triangles cannot be collapsed to a surface.
  if (test::live(mesh) < kFew) return false;
  const bool to_start = kind < 6;
  if (!mesh.may_leave(t, side, !to_start)) return false;
  const auto plan = mesh.plan_collapse(t, side, to_start);
  if (!plan) return false;
  mesh.collapse(*plan);
  test::expect_as_planned(mesh, plan->changed);
  EXPECT_FALSE(mesh.alive(plan->removed[0]) || mesh.alive(plan->removed[1]));
  EXPECT_TRUE(mesh.star(plan->from).empty());
  return true;
}

TEST(EditableSurface, KeepsASurfaceThroughRandomEdits) {
  for (const QuotientSurface& given : test::samples()) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      QuotientSurface surface = given;
      const auto euler = test::euler_characteristic(test::restored(given));
      auto mesh = EditableSurface::create(surface);
      ASSERT_TRUE(mesh);
      test::expect_consistent(*mesh);
      Random random(seed);
      int done = 0;
      for (int i = 0; i < 2000; ++i) {
        if (!edit(*mesh, random)) continue;
        if (++done % 40 == 0) test::expect_consistent(*mesh);
        ASSERT_FALSE(HasFailure()) << given.fold << "-fold, edit " << i;
      }
      EXPECT_GT(done, 100);
      test::expect_consistent(*mesh);
      const std::vector<QuotientTriangle> before = surface.triangles;
      const auto old = mesh->compact();
      ASSERT_EQ(old.size(), surface.triangles.size());
      for (std::size_t k = 0; k < old.size(); ++k) {
        EXPECT_EQ(surface.triangles[k], before[old[k]]);
      }
      test::expect_sound(surface);
      EXPECT_EQ(test::euler_characteristic(test::restored(surface)), euler);
    }
  }
}

// Edges of a box stay edges of their length and its corners corners, whatever is done to the rest.
TEST(EditableSurface, CreasesStayEdges) {
  for (const std::uint64_t seed : {4U, 5U, 6U}) {
    QuotientSurface surface =
        test::uncut(test::divided(test::divided(box_surface({0, 0, 0}, {1, 2, 3}))));
    auto mesh = EditableSurface::create(surface);
    ASSERT_TRUE(mesh);
    const auto figures = [&] {
      double creases = 0;
      std::size_t sides = 0;
      for (std::int32_t t = 0; t < slots(*mesh); ++t) {
        if (!mesh->alive(t)) continue;
        const auto p = mesh->points(t);
        for (std::size_t i = 0; i < 3; ++i) {
          if (mesh->mark(t, static_cast<std::int32_t>(i)) == 0) continue;
          EXPECT_EQ(mesh->mark(t, static_cast<std::int32_t>(i)), kCreaseSide);
          creases += 0.5 * distance(p[i], p[(i + 1) % 3]);
          ++sides;
        }
      }
      return std::pair(creases, sides);
    };
    EXPECT_NEAR(figures().first, 4 * (1 + 2 + 3), 1e-12);
    const std::size_t before = figures().second;
    Random random(seed);
    for (int i = 0; i < 4000; ++i) static_cast<void>(edit(*mesh, random));
    EXPECT_NEAR(figures().first, 4 * (1 + 2 + 3), 1e-12);
    EXPECT_NE(figures().second, before);  // vertices left them, or came
    for (std::size_t v = 0; v < surface.points.size(); ++v) {
      const Point3 p = surface.points[v];
      const bool corner =
          (p.x == 0 || p.x == 1) && (p.y == 0 || p.y == 2) && (p.z == 0 || p.z == 3);
      EXPECT_TRUE(!corner || !mesh->star(static_cast<std::int32_t>(v)).empty());
    }
    // All that was done was done within the faces.
    mesh->compact();
    EXPECT_NEAR(test::volume_of(test::restored(surface)), 6, 1e-12);
  }
}

}  // namespace
}  // namespace symcell::solid
