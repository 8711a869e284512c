// Pinches of models, computed from their triangles alone.
#include <gtest/gtest.h>

#include "core/verify/against_model.hpp"
#include "tests/support/block_meshes.hpp"

namespace symcell {
namespace {

using internal::ModelPinches;
using internal::SidedTriangles;
using test::all_blocks;

// Material behind every triangle; further triangles lie inside it.
ModelPinches pinches(const test::Blocks& cubes,
                     const std::vector<std::array<Point3, 3>>& inside = {}) {
  TriangleSurface surface = test::cube_surface(cubes);
  SidedTriangles solid;
  solid.triangles = surface.triangles;
  solid.material.assign(solid.triangles.size(), {false, true});
  for (const auto& corners : inside) {
    Triangle triangle{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto at = std::ranges::find(surface.vertices, corners[i]);
      triangle[i] = static_cast<std::int32_t>(at - surface.vertices.begin());
      if (at == surface.vertices.end()) surface.vertices.push_back(corners[i]);
    }
    solid.triangles.push_back(triangle);
    solid.material.push_back({true, true});
  }
  solid.points = surface.vertices;
  return internal::find_model_pinches(solid);
}

TEST(ModelPinches, NoneInABodyOrRoundACavity) {
  EXPECT_TRUE(pinches(all_blocks({2, 2, 2})).empty());
  EXPECT_TRUE(pinches(all_blocks({3, 3, 3}, {{1, 1, 1}})).empty());
}

TEST(ModelPinches, BodiesThatTouch) {
  const ModelPinches vertex = pinches({{0, 0, 0}, {1, 1, 1}});
  EXPECT_EQ(vertex.points, (std::vector<Point3>{{1, 1, 1}}));
  EXPECT_TRUE(vertex.edges.empty());
  const ModelPinches edge = pinches({{0, 0, 0}, {1, 1, 0}});
  EXPECT_EQ(edge.points.size(), 2U);
  ASSERT_EQ(edge.edges.size(), 1U);
  EXPECT_EQ(edge.edges[0], (std::array<Point3, 2>{Point3{1, 1, 0}, Point3{1, 1, 1}}));
}

// The surface touches itself, but the material hangs together round the place: two cavities that
// meet at a vertex, and two notches that do.
TEST(ModelPinches, VoidsThatTouchAreNone) {
  EXPECT_TRUE(pinches(all_blocks({4, 4, 4}, {{1, 1, 1}, {2, 2, 2}})).empty());
  EXPECT_TRUE(pinches(all_blocks({2, 2, 2}, {{0, 0, 0}, {1, 1, 1}})).empty());
}

// Two cavities that meet along an edge leave material on two sides of it that no face joins.
TEST(ModelPinches, VoidsThatTouchAtAnEdge) {
  EXPECT_EQ(pinches(all_blocks({4, 4, 3}, {{1, 1, 1}, {2, 2, 1}})).edges.size(), 1U);
}

// A facet inside the material that touches the surface at a vertex, or nothing, or along an edge.
TEST(ModelPinches, FacetsInsideAreNone) {
  const auto cubes = all_blocks({2, 2, 2});
  const Point3 corner{0, 0, 0}, a{0.5, 0.5, 0.75}, b{0.75, 0.25, 0.5}, c{0.25, 0.5, 0.25};
  EXPECT_TRUE(pinches(cubes, {{corner, a, b}}).empty());
  EXPECT_TRUE(pinches(cubes, {{c, a, b}}).empty());
  EXPECT_TRUE(pinches(cubes, {{corner, Point3{1, 0, 0}, b}}).empty());
}

// Where bodies touch at a vertex, a facet inside one of them changes nothing.
TEST(ModelPinches, FacetsInsideBodiesThatTouch) {
  const ModelPinches found = pinches(
      {{0, 0, 0}, {1, 1, 1}}, {{Point3{1, 1, 1}, Point3{1.5, 1.25, 1.5}, Point3{1.25, 1.5, 1.25}}});
  EXPECT_EQ(found.points, (std::vector<Point3>{{1, 1, 1}}));
}

}  // namespace
}  // namespace symcell
