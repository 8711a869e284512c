// Meshes of bodies that overlap, against the surface as it was given: walls within the solid are no
// part of its boundary, all others are.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <string>

#include "api/formats/vtu_reader.hpp"
#include "core/mesh_model.hpp"
#include "core/verify/verify_mesh.hpp"
#include "tests/support/written_mesh.hpp"

namespace symcell {
namespace {

void add_box(TriangleSurface& surface, Point3 low, Point3 high) {
  const auto first = static_cast<std::int32_t>(surface.vertices.size());
  for (int i = 0; i < 8; ++i) {
    surface.vertices.push_back({(i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y,
                                (i & 4) != 0 ? high.z : low.z});
  }
  constexpr std::array<std::array<int, 4>, 6> kSquares = {
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  for (const auto& q : kSquares) {
    surface.triangles.push_back({first + q[0], first + q[1], first + q[2]});
    surface.triangles.push_back({first + q[0], first + q[2], first + q[3]});
  }
}

// The checks that fail.
std::set<std::string> failed(const SymmetryCellMesh& mesh, const Model& model) {
  const auto cell = read_vtu(test::written(mesh, MeshPart::kCell, MeshFormat::kVtu));
  const auto full = read_vtu(test::written(mesh, MeshPart::kFull, MeshFormat::kVtu));
  std::set<std::string> names;
  if (!cell || !full) return {"not read"};
  for (const Check& c : verify_mesh(*cell, &*full, &model, {}).checks) {
    if (c.status == Check::Status::kFail) names.insert(c.name + ": " + c.detail);
  }
  return names;
}

TEST(OverlappingBodies, WallsWithinTheSolidNeedNoFaces) {
  TriangleSurface cross;
  add_box(cross, {-2, -0.5, -0.5}, {2, 0.5, 0.5});
  add_box(cross, {-0.5, -2, -0.25}, {0.5, 2, 0.25});
  ExecutionContext context;
  const auto outcome = mesh_model(cross, {}, context);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_NEAR(outcome->statistics.cell.measure * outcome->statistics.symmetry.fold, 5.5, 1e-3);
  EXPECT_EQ(failed(outcome->mesh, cross), std::set<std::string>{});
}

TEST(OverlappingBodies, AMeshThatLacksOneOfThemIsFound) {
  TriangleSurface one, both;
  add_box(one, {-2, -0.5, -0.5}, {2, 0.5, 0.5});
  both = one;
  add_box(both, {-0.5, -2, -0.25}, {0.5, 2, 0.25});
  ExecutionContext context;
  const auto outcome = mesh_model(one, {}, context);
  ASSERT_TRUE(outcome) << outcome.error().message;
  const auto names = failed(outcome->mesh, both);
  ASSERT_FALSE(names.empty());
  EXPECT_TRUE(std::any_of(names.begin(), names.end(), [](const std::string& name) {
    return name.starts_with("model.covered");
  }));
}

}  // namespace
}  // namespace symcell
