// verify_mesh on tetrahedra: good meshes pass, and every flaw is found by the check that is for it.
#include <gtest/gtest.h>

#include <functional>

#include "api/formats/vtu_reader.hpp"
#include "core/cell/boundary_faces.hpp"
#include "core/cell/full_mesh.hpp"
#include "core/cell/quadratic.hpp"
#include "core/verify/verify_mesh.hpp"
#include "tests/support/extruded_cells.hpp"
#include "tests/support/moved_elements.hpp"
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

// The full mesh's boundary, three vertices of its own a triangle, as STL has it.
TriangleSurface surface_of(const SymmetryCellMesh& cell) {
  const FullMeshView view(cell);
  TriangleSurface surface;
  for (const BoundaryFace& face : boundary_faces(cell)) {
    if (!face.outer) continue;
    for (std::int32_t s = 0; s < cell.fold; ++s) {
      std::array<std::int32_t, 3> triangle{};
      for (std::size_t i = 0; i < 3; ++i) {
        triangle[i] = static_cast<std::int32_t>(surface.vertices.size());
        const auto node = static_cast<std::size_t>(face.corners[i]);
        surface.vertices.push_back(view.position(view.node(view.node_id(node, s))));
      }
      surface.triangles.push_back(triangle);
    }
  }
  return surface;
}

TEST(VerifySolid, GoodMeshesPass) {
  for (const test::SolidSample& sample : test::solid_samples()) {
    const Model plc = sample.model;
    const Model surface = surface_of(sample.cell);
    VerifyOptions options;
    options.model_measure = sample.volume;
    for (const SymmetryCellMesh& mesh : {sample.cell, elevate_to_quadratic(sample.cell)}) {
      const MeshData cell = read(mesh, MeshPart::kCell);
      const MeshData full = read(mesh, MeshPart::kFull);
      for (const Model* model : {&plc, &surface, static_cast<const Model*>(nullptr)}) {
        for (const MeshData* given : {&full, static_cast<const MeshData*>(nullptr)}) {
          const auto report = verify_mesh(cell, given, model, options);
          EXPECT_TRUE(report.ok()) << sample.name << ": " << failures(report);
        }
      }
    }
  }
}

// Writers and other programs may name the corners of a copy in another order.
TEST(VerifySolid, CopiesMayBeTurnedWithinTheirElements) {
  const SymmetryCellMesh mesh = elevate_to_quadratic(test::solid_samples().front().cell);
  const MeshData cell = read(mesh, MeshPart::kCell);
  MeshData full = read(mesh, MeshPart::kFull);
  // (0 1 2 3) -> (1 2 0 3); its edges 01 12 02 03 13 23 -> 12 02 01 13 23 03.
  constexpr std::array<std::size_t, 10> kTurned{1, 2, 0, 3, 5, 6, 4, 8, 9, 7};
  const std::vector<std::int32_t> before = full.elements;
  for (std::size_t i = 0; i < 10; ++i) full.elements[i] = before[kTurned[i]];
  const auto report = verify_mesh(cell, &full, nullptr, {});
  EXPECT_TRUE(report.ok()) << failures(report);
}

// One flaw at a time, and the check that must find it.
struct Flaw {
  const char* check;
  std::function<void(MeshData& cell, MeshData& full, Plc& model)> make;
};

void add_element(MeshData& mesh, std::array<std::int32_t, 4> nodes) {
  mesh.elements.insert(mesh.elements.end(), nodes.begin(), nodes.end());
  mesh.regions.push_back(0);
}

TEST(VerifySolid, EveryFlawIsFound) {
  const test::SolidSample sample = test::solid_samples()[2];  // n = 2, a plate, a skew axis
  const Flaw flaws[] = {
      {"cell.fields",
       [](auto& c, auto&, auto&) {
         c.axis_direction = {1, 1, 0};
       }},
      {"cell.corners", [](auto& c, auto&, auto&) { c.elements[1] = c.elements[0]; }},
      {"cell.corners",
       [](auto& c, auto&, auto&) {
         c.points.push_back({9, 9, 0});
       }},
      {"cell.orientation", [](auto& c, auto&, auto&) { std::swap(c.elements[0], c.elements[1]); }},
      {"cell.conforming",
       [](auto& c, auto&, auto&) {
         add_element(c, {c.elements[0], c.elements[1], c.elements[2], c.elements[3]});
       }},
      {"cell.duplicates",
       [](auto& c, auto&, auto&) {
         c.points.push_back(c.points[static_cast<std::size_t>(c.elements[0])]);
         c.elements[0] = static_cast<std::int32_t>(c.points.size()) - 1;
       }},
      {"cell.pairs",
       [](auto& c, auto&, auto&) {
         for (std::size_t i = 0; i < c.points.size(); ++i) {
           if (c.lower_to_higher[i] >= 0) c.points[i].y += 1e-6;
         }
       }},
      {"cell.pairs", [](auto& c, auto&, auto&) { c.lower_to_higher.clear(); }},
      {"full.conforming",
       [](auto&, auto& f, auto&) {
         f.elements.insert(f.elements.end(), f.elements.begin(), f.elements.begin() + 4);
         f.regions.push_back(0);
       }},
      {"full.copies", [](auto&, auto& f, auto&) { f.sectors[0] = 1; }},
      {"full.copies", [](auto&, auto& f, auto&) { f.cell_elements[0] = 999; }},
      {"full.copies", [](auto&, auto& f, auto&) { f.points[5].z += 1e-6; }},
      {"full.copies",
       [](auto&, auto& f, auto&) {
         f.axis_direction = {0, 0, 1};
       }},
      {"model.vertices",
       [](auto&, auto&, auto& m) {
         // The vertices of a level: 12 inner ones, 12 outer ones.
         const auto first = static_cast<std::int32_t>(m.vertices.size());
         m.vertices.push_back(0.3 * m.vertices[0] + 0.25 * (m.vertices[12] + m.vertices[24]) +
                              0.2 * m.vertices[36]);
         m.segments.push_back({first, 0, 0});
       }},
      {"model.segments",
       [](auto&, auto&, auto& m) {
         m.segments.push_back({12, 24, 0});  // from an outer corner across
       }},
      {"model.facets",
       [](auto&, auto&, auto& m) {
         m.facets.push_back({{{0, 1, 37, 36}}, {}, 0});
       }},
      {"model.valid", [](auto&, auto&, auto& m) { m.facets.pop_back(); }},
      {"model.boundary",
       [](auto&, auto&, auto& m) {
         // A higher top; levels have 24 vertices.
         for (std::size_t i = 48; i < 72; ++i) {
           m.vertices[i] = m.vertices[i] + 0.1 * (m.vertices[i] - m.vertices[i - 24]);
         }
       }},
      {"model.holes",
       [](auto&, auto&, auto& m) {
         m.holes.push_back(m.regions[0].point);
         m.regions.erase(m.regions.begin());
       }},
      {"model.regions", [](auto&, auto&, auto& m) { m.regions[0].attribute = 4; }},
      {"model.valid",
       [](auto&, auto&, auto& m) {
         m.regions[0].point = {500, 500, 500};
       }},
      {"model.region_borders", [](auto&, auto& f, auto&) { f.regions[0] = 8; }},
  };
  int index = 0;
  for (const Flaw& flaw : flaws) {
    MeshData cell = read(sample.cell, MeshPart::kCell);
    MeshData full = read(sample.cell, MeshPart::kFull);
    Plc model = sample.model;
    flaw.make(cell, full, model);
    const Model given = model;
    const auto report = verify_mesh(cell, &full, &given, {});
    EXPECT_TRUE(fails(report, flaw.check))
        << index << " " << flaw.check << "; found: " << failures(report);
    ++index;
  }
}

TEST(VerifySolid, MidNodesOffTheirEdge) {
  MeshData cell = read(elevate_to_quadratic(test::solid_samples()[4].cell), MeshPart::kCell);
  cell.points.back().z += 1e-3;
  EXPECT_TRUE(fails(verify_mesh(cell, nullptr, nullptr, {}), "cell.mid_nodes"));
}

// Two elements of the cell that touch at an edge only, while the full mesh goes round it.
TEST(VerifySolid, CellPinchesWhereTheFullMeshDoesNot) {
  const SymmetryCellMesh ring = test::solid_samples()[1].cell;
  // The ring's sector is one column of prisms: its upper half is taken from the next sector.
  const SymmetryCellMesh mesh = test::with_elements_moved(ring, 1, [&](std::size_t e) {
    double z = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto node = static_cast<std::size_t>(ring.elements[4 * e + i]);
      z += ring.orbit_points[static_cast<std::size_t>(ring.nodes[node].orbit)].z / 4;
    }
    return z >= 0.75;
  });
  const MeshData cell = read(mesh, MeshPart::kCell);
  const MeshData full = read(mesh, MeshPart::kFull);
  const auto report = verify_mesh(cell, &full, nullptr, {});
  EXPECT_TRUE(fails(report, "cell.edge_links")) << failures(report);
  EXPECT_FALSE(fails(report, "full.edge_links")) << failures(report);
  EXPECT_FALSE(fails(report, "full.copies")) << failures(report);
}

TEST(VerifySolid, SurfacesAreComparedBothWays) {
  const test::SolidSample sample = test::solid_samples()[4];
  const MeshData cell = read(sample.cell, MeshPart::kCell);
  TriangleSurface moved = surface_of(sample.cell);
  for (Point3& p : moved.vertices) p.z *= 1.1;
  Model model = moved;
  EXPECT_TRUE(fails(verify_mesh(cell, nullptr, &model, {}), "model.on_surface"));
  EXPECT_TRUE(fails(verify_mesh(cell, nullptr, &model, {}), "model.covered"));
  TriangleSurface more = surface_of(sample.cell);
  const auto first = static_cast<std::int32_t>(more.vertices.size());
  more.vertices.insert(more.vertices.end(), {{0, 0, 3}, {0.1, 0, 3}, {0, 0.1, 3}});
  more.triangles.push_back({first, first + 1, first + 2});
  model = more;
  EXPECT_FALSE(fails(verify_mesh(cell, nullptr, &model, {}), "model.on_surface"));
  EXPECT_TRUE(fails(verify_mesh(cell, nullptr, &model, {}), "model.covered"));
  more.triangles.back()[0] = 100'000;
  model = more;
  EXPECT_TRUE(fails(verify_mesh(cell, nullptr, &model, {}), "model.valid"));
}

TEST(VerifySolid, ModelOfAnotherDimension) {
  const MeshData cell = read(test::solid_samples().front().cell, MeshPart::kCell);
  const Model planar = test::ring_model({});
  EXPECT_TRUE(fails(verify_mesh(cell, nullptr, &planar, {}), "model.valid"));
}

// A plate that ends in the open is no flaw where nothing is meshed.
TEST(VerifySolid, WhatDanglesOutsideTheDomainIsNoFlaw) {
  const test::SolidSample sample = test::solid_samples().front();
  Plc model = sample.model;
  const auto first = static_cast<std::int32_t>(model.vertices.size());
  model.vertices.insert(model.vertices.end(), {{4, 0, 0}, {5, 0, 0}, {5, 0, 1}});
  model.facets.push_back({{{first, first + 1, first + 2}}, {}, 9});
  const Model given = model;
  const auto report = verify_mesh(read(sample.cell, MeshPart::kCell), nullptr, &given, {});
  EXPECT_TRUE(report.ok()) << failures(report);
}

}  // namespace
}  // namespace symcell
