// Models with arcs, meshed and compared with what they are.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "api/formats/pslg_json.hpp"
#include "api/formats/vtu_reader.hpp"
#include "core/geometry/arc.hpp"
#include "core/mesh_model.hpp"
#include "core/verify/verify_mesh.hpp"
#include "tests/support/written_mesh.hpp"

namespace symcell {
namespace {

MeshOutcome meshed(const Model& model, const MeshOptions& options) {
  ExecutionContext context;
  auto made = mesh_model(model, options, context);
  EXPECT_TRUE(made) << made.error().message;
  return made ? std::move(*made) : MeshOutcome{};
}

void expect_verified(const Model& model,
                     const MeshOutcome& made,
                     const VerifyOptions& options = {}) {
  const auto read = [&](MeshPart part) {
    return read_vtu(test::written(made.mesh, part, MeshFormat::kVtu)).value();
  };
  const MeshData cell = read(MeshPart::kCell), full = read(MeshPart::kFull);
  for (const Check& check : verify_mesh(cell, &full, &model, options).checks) {
    EXPECT_NE(check.status, Check::Status::kFail)
        << "fold " << cell.fold << ", " << check.name << ": " << check.detail;
  }
}

Pslg model_of(const char* json) {
  auto model = read_pslg_json(json);
  EXPECT_TRUE(model) << model.error().message;
  return model ? std::move(*model) : Pslg{};
}

const char* kRing =
    R"({"type": "pslg", "vertices": [[2, 0], [-2, 0], [1, 0]], "holes": [[0, 0]], "segments": [
    {"vertices": [0, 1], "bulge": 1}, {"vertices": [1, 0], "center": [0, 0]},
    {"vertices": [2, 2], "center": [0, 0], "marker": 2}]})";

TEST(Arcs, RingOfOrderTwoHasItsArea) {
  const Pslg ring = model_of(kRing);
  MeshOptions options;
  options.order = 2;
  const double exact = 3 * std::numbers::pi;
  for (const std::int32_t fold : {1, 4, 6, 7, 12}) {
    options.fold = fold;
    const MeshOutcome made = meshed(ring, options);
    EXPECT_EQ(made.statistics.symmetry.fold, fold);
    EXPECT_NEAR(made.statistics.cell.measure * fold, exact, 1e-5 * exact) << fold;
    expect_verified(ring, made);
  }
}

// Joints that are off by more than the nodes' rounding move the arcs, whose nodes are found all the same;
// what is off by more than that is found, too.
TEST(Arcs, ModelsThatAreNearlySymmetricAreVerified) {
  for (const double off : {1e-7, 1e-5, 1e-4}) {
    Pslg petals;
    for (int i = 0; i < 3; ++i) {
      const double angle = 2 * std::numbers::pi * i / 3;
      petals.vertices.push_back({std::cos(angle), std::sin(angle)});
      petals.segments.push_back({i, (i + 1) % 3, 1});
      petals.bulges.push_back(0.5);
    }
    petals.vertices[0].x += off;
    MeshOptions options;
    options.fold = 3;
    options.symmetry_tolerance_rel = 1e-3;
    options.max_area = 0.01;
    MeshOutcome made = meshed(petals, options);
    expect_verified(petals, made);
    const auto node = made.mesh.nodes[static_cast<std::size_t>(made.mesh.boundary[0])];
    Point3& p = made.mesh.orbit_points[static_cast<std::size_t>(node.orbit)];
    p = (1 + 100 * off) * p;
    const MeshData cell =
        read_vtu(test::written(made.mesh, MeshPart::kCell, MeshFormat::kVtu)).value();
    const Model model = petals;
    EXPECT_FALSE(verify_mesh(cell, nullptr, &model, {}).ok()) << off;
  }
}

TEST(Arcs, VerticesOfRefinementLieOnTheArcs) {
  Pslg ring = model_of(kRing);
  MeshOptions options;
  options.max_area = 1e-3;
  options.chord_error_rel = 0.02;
  options.fold = 6;
  const MeshOutcome made = meshed(ring, options);
  const SymmetryCellMesh& mesh = made.mesh;
  for (const std::int32_t node : mesh.boundary) {
    const auto orbit = static_cast<std::size_t>(mesh.nodes[static_cast<std::size_t>(node)].orbit);
    const double radius = std::hypot(mesh.orbit_points[orbit].x, mesh.orbit_points[orbit].y);
    EXPECT_NEAR(std::min(std::abs(radius - 1), std::abs(radius - 2)), 0, 1e-12);
  }
  for (const Warning& w : made.statistics.warnings) EXPECT_NE(w.code, WarningCode::kArcsAsChords);
  expect_verified(ring, made);
}

TEST(Arcs, SectorsOfAMotorAreVerifiedAgainstTheSector) {
  Pslg pole{{{1, 0}, {2, 0}, {3, 0}, {0, 3}, {0, 2}, {0, 1}},
            {{0, 1, 9}, {1, 2, 9}, {2, 3, 1}, {3, 4, 9}, {4, 5, 9}, {5, 0, 2}, {1, 4, 3}},
            {},
            {{{1.1, 1.1}, 1, kInfinity}, {{1.8, 1.8}, 2, kInfinity}}};
  const double quarter = bulge_of_angle(std::numbers::pi / 2);
  pole.bulges = {0, 0, quarter, 0, 0, -quarter, quarter};
  MeshOptions options;
  options.sector = 4;
  options.order = 2;
  const MeshOutcome made = meshed(pole, options);
  EXPECT_EQ(made.statistics.symmetry.fold, 4);
  VerifyOptions verify;
  verify.sector = 4;
  expect_verified(pole, made, verify);
}

TEST(Arcs, AlternatingPolesAreAntiperiodic) {
  // Four quarters of a square, two materials.
  Pslg poles{{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}},
             {{1, 2},
              {2, 3},
              {3, 4},
              {4, 5},
              {5, 6},
              {6, 7},
              {7, 8},
              {8, 1},
              {0, 1},
              {0, 3},
              {0, 5},
              {0, 7}},
             {},
             {{{0.5, 0.5}, 1, kInfinity},
              {{-0.5, 0.5}, 2, kInfinity},
              {{-0.5, -0.5}, 1, kInfinity},
              {{0.5, -0.5}, 2, kInfinity}}};
  MeshOptions options;
  EXPECT_FALSE(meshed(poles, options).statistics.symmetry.antiperiodic);
  options.ignore_markers = true;
  const MeshOutcome made = meshed(poles, options);
  EXPECT_EQ(made.statistics.symmetry.fold, 4);
  EXPECT_TRUE(made.statistics.symmetry.antiperiodic);
}

}  // namespace
}  // namespace symcell
