#include "core/verify/verify_mesh.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "api/formats/vtu_reader.hpp"
#include "core/cell/quadratic.hpp"
#include "tests/support/sample_cells.hpp"
#include "tests/support/written_mesh.hpp"

namespace symcell {
namespace {

MeshData read(const SymmetryCellMesh& cell, MeshPart part) {
  return read_vtu(test::written(cell, part, MeshFormat::kVtu)).value();
}

std::string failures(const VerifyReport& report) {
  std::string names;
  for (const Check& c : report.checks) {
    if (c.status == Check::Status::kFail) names += c.name + " (" + c.detail + ") ";
  }
  return names;
}

bool fails(const VerifyReport& report, const std::string& name) {
  return std::ranges::any_of(report.checks, [&](const Check& c) {
    return c.name == name && c.status == Check::Status::kFail;
  });
}

TEST(VerifyMesh, GoodMeshesPass) {
  for (const test::Sample& sample : test::all_samples()) {
    for (const SymmetryCellMesh& mesh : {sample.cell, elevate_to_quadratic(sample.cell)}) {
      const MeshData cell = read(mesh, MeshPart::kCell);
      const MeshData full = read(mesh, MeshPart::kFull);
      const Model model = sample.model;
      const auto given = verify_mesh(cell, &full, &model, {});
      EXPECT_TRUE(given.ok()) << sample.name << ": " << failures(given);
      const auto restored = verify_mesh(cell, nullptr, &model, {});
      EXPECT_TRUE(restored.ok()) << sample.name << ": " << failures(restored);
      EXPECT_TRUE(verify_mesh(cell, nullptr, nullptr, {}).ok());
    }
  }
}

// One flaw at a time, and the check that must find it.
struct Flaw {
  const char* check;
  std::function<void(MeshData& cell, MeshData& full, Pslg& model)> make;
};

TEST(VerifyMesh, EveryFlawIsFound) {
  const Flaw flaws[] = {
      {"cell.fields", [](auto& c, auto&, auto&) { c.points[1].z = 1e-3; }},
      {"cell.fields",
       [](auto& c, auto&, auto&) {
         c.axis_direction = {1, 0, 0};
       }},
      {"cell.corners", [](auto& c, auto&, auto&) { c.elements[1] = c.elements[0]; }},
      {"cell.corners",
       [](auto& c, auto&, auto&) {
         c.points.push_back({9, 9, 0});
       }},
      {"cell.orientation", [](auto& c, auto&, auto&) { std::swap(c.elements[0], c.elements[1]); }},
      {"cell.pairs", [](auto& c, auto&, auto&) { c.points[0].x += 1e-6; }},
      {"cell.pairs", [](auto& c, auto&, auto&) { c.lower_to_higher.clear(); }},
      {"cell.pairs", [](auto& c, auto&, auto&) { c.lower_to_higher[1] = 2; }},
      {"full.conforming",
       [](auto&, auto& f, auto&) {
         f.elements.insert(f.elements.end(), f.elements.begin(), f.elements.begin() + 3);
         f.regions.push_back(0);
       }},
      {"full.copies", [](auto&, auto& f, auto&) { f.sectors[0] = 1; }},
      {"full.copies", [](auto&, auto& f, auto&) { f.cell_elements[0] = 99; }},
      {"full.copies", [](auto&, auto& f, auto&) { f.points[5].y += 1e-6; }},
      {"full.copies", [](auto&, auto& f, auto&) { f.fold = 3; }},
      {"model.vertices", [](auto&, auto&, auto& m) { m.vertices[0].x += 0.01; }},
      {"model.segments",
       [](auto&, auto&, auto& m) {
         // From a vertex of the inner polygon across the ring.
         m.segments.push_back({0, 20, 0});
       }},
      {"model.valid",
       [](auto&, auto&, auto& m) {
         m.segments.push_back({0, 999, 0});
       }},
      {"model.boundary", [](auto&, auto&, auto& m) { m.segments.pop_back(); }},
      {"model.holes",
       [](auto&, auto&, auto& m) {
         m.holes.push_back({1.5, 0.1});
       }},
      {"model.regions",
       [](auto&, auto&, auto& m) {
         m.regions.push_back({{1.5, 0.1}, 4, 1});
       }},
      {"model.regions",
       [](auto&, auto&, auto& m) {
         m.regions.push_back({{5, 5}, 0, 1});
       }},
      {"model.region_borders", [](auto&, auto& f, auto&) { f.regions[0] = 8; }},
  };
  test::RingShape shape;
  shape.swirl = 0.3;
  for (const Flaw& flaw : flaws) {
    MeshData cell = read(test::ring_cell(shape), MeshPart::kCell);
    MeshData full = read(test::ring_cell(shape), MeshPart::kFull);
    Pslg model = test::ring_model(shape);
    flaw.make(cell, full, model);
    const Model given = model;
    const auto report = verify_mesh(cell, &full, &given, {});
    EXPECT_TRUE(fails(report, flaw.check)) << flaw.check << "; found: " << failures(report);
  }
}

// Constraints may end in the open, where nothing is meshed.
TEST(VerifyMesh, SegmentsOutsideTheDomainAreNoFlaw) {
  const MeshData cell = read(test::disc_cell(5, 2, {0, 0}), MeshPart::kCell);
  Pslg model = test::disc_model(5, 2, {0, 0});
  model.vertices.push_back({5, 5});
  const auto out = static_cast<std::int32_t>(model.vertices.size()) - 1;
  model.segments.push_back({0, out, 0});
  const Model given = model;
  const auto report = verify_mesh(cell, nullptr, &given, {});
  EXPECT_TRUE(report.ok()) << failures(report);
}

// A pair that is left out leaves a slit in the restored mesh.
TEST(VerifyMesh, MissingPairsShowInTheRestoredMesh) {
  const SymmetryCellMesh mesh = test::ring_cell({});
  MeshData cell = read(mesh, MeshPart::kCell);
  for (std::int32_t& image : cell.lower_to_higher) {
    if (image >= 0) {
      image = -1;
      break;
    }
  }
  EXPECT_TRUE(fails(verify_mesh(cell, nullptr, nullptr, {}), "full.duplicates"));
}

TEST(VerifyMesh, MidNodesOffTheirEdge) {
  const SymmetryCellMesh mesh = elevate_to_quadratic(test::disc_cell(5, 2, {0, 0}));
  MeshData cell = read(mesh, MeshPart::kCell);
  cell.points.back().x += 1e-3;
  EXPECT_TRUE(fails(verify_mesh(cell, nullptr, nullptr, {}), "cell.mid_nodes"));
}

TEST(VerifyMesh, AreaOfTheModel) {
  const MeshData cell = read(test::square_cell(), MeshPart::kCell);
  VerifyOptions options;
  options.model_measure = 1.0;
  EXPECT_TRUE(verify_mesh(cell, nullptr, nullptr, options).ok());
  options.model_measure = 1.5;
  EXPECT_TRUE(fails(verify_mesh(cell, nullptr, nullptr, options), "model.area"));
}

}  // namespace
}  // namespace symcell
