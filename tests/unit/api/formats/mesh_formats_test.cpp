#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "core/cell/full_mesh.hpp"
#include "core/cell/quadratic.hpp"
#include "tests/support/sample_cells.hpp"
#include "tests/support/written_mesh.hpp"

namespace symcell {
namespace {

using Json = nlohmann::json;
using test::written;

std::vector<SymmetryCellMesh> meshes() {
  std::vector<SymmetryCellMesh> all;
  for (const test::Sample& sample : test::all_samples()) {
    all.push_back(sample.cell);
    all.push_back(elevate_to_quadratic(sample.cell));
  }
  return all;
}

TEST(MeshJson, CellHasTheFieldsOfTheInterface) {
  for (const SymmetryCellMesh& cell : meshes()) {
    const Json json = Json::parse(written(cell, MeshPart::kCell, MeshFormat::kJson));
    const FullMeshView view(cell);
    EXPECT_EQ(json["dimension"], 2);
    EXPECT_EQ(json["order"], cell.order);
    EXPECT_EQ(json["fold"], cell.fold);
    EXPECT_EQ(json["axis"]["direction"], Json({0.0, 0.0, 1.0}));
    ASSERT_EQ(json["nodes"].size(), cell.nodes.size());
    for (std::size_t i = 0; i < cell.nodes.size(); ++i) {
      const Point3 p = view.cell_node_position(i);
      EXPECT_EQ(json["nodes"][i], Json({p.x, p.y}));  // the same bits
    }
    EXPECT_EQ(json["elements"].size(), cell.element_count());
    EXPECT_EQ(json["regions"], Json(cell.regions));
    EXPECT_EQ(json["markers"], Json(cell.node_markers));
    EXPECT_EQ(json["boundary"].size(), cell.facet_count());
    ASSERT_EQ(json["lower"].size(), json["higher"].size());
    for (std::size_t i = 0; i < json["lower"].size(); ++i) {
      EXPECT_EQ(cell.lower_to_higher[json["lower"][i].get<std::size_t>()], json["higher"][i]);
    }
    EXPECT_FALSE(json.contains("sector"));
  }
}

TEST(MeshJson, FullMeshIsWhatTheViewSays) {
  for (const SymmetryCellMesh& cell : meshes()) {
    const Json json = Json::parse(written(cell, MeshPart::kFull, MeshFormat::kJson));
    const FullMeshView view(cell);
    ASSERT_EQ(json["nodes"].size(), static_cast<std::size_t>(view.node_count()));
    for (std::int64_t i = 0; i < view.node_count(); ++i) {
      const Point3 p = view.position(view.node(i));
      EXPECT_EQ(json["nodes"][static_cast<std::size_t>(i)], Json({p.x, p.y}));
      EXPECT_EQ(json["markers"][static_cast<std::size_t>(i)], view.node_marker(i));
    }
    ASSERT_EQ(json["elements"].size(), static_cast<std::size_t>(view.element_count()));
    const auto k = static_cast<std::size_t>(cell.nodes_per_element);
    for (std::size_t i = 0; i < json["elements"].size(); ++i) {
      const std::size_t e = json["cell_element"][i];
      const std::int32_t s = json["sector"][i];
      EXPECT_EQ(i, static_cast<std::size_t>(s) * cell.element_count() + e);
      for (std::size_t c = 0; c < k; ++c) {
        const auto node = static_cast<std::size_t>(cell.elements[e * k + c]);
        EXPECT_EQ(json["elements"][i][c], view.node_id(node, s));
      }
    }
    EXPECT_EQ(json["boundary"].size(), cell.facet_count() * static_cast<std::size_t>(cell.fold));
  }
}

TEST(MeshJson, FacetsSharedWithTheLowerBoundAreWrittenOnce) {
  SymmetryCellMesh cell = test::disc_cell(5, 2, {0, 0});
  // A constraint along the bounds: the lower facet and its image.
  cell.boundary.insert(cell.boundary.end(), {0, 1, 0, 3});
  cell.boundary_markers.insert(cell.boundary_markers.end(), {9, 9});
  cell.boundary_is_higher_image.insert(cell.boundary_is_higher_image.end(), {0, 1});
  const Json full = Json::parse(written(cell, MeshPart::kFull, MeshFormat::kJson));
  EXPECT_EQ(full["boundary"].size(), 5U * 3U);
  const Json part = Json::parse(written(cell, MeshPart::kCell, MeshFormat::kJson));
  EXPECT_EQ(part["boundary"].size(), 4U);
}

TEST(MeshJson, RegionsAndMarkersMayDifferBetweenSectors) {
  SymmetryCellMesh cell = test::disc_cell(3, 1, {0, 0});
  cell.sector_regions = {10, 11, 12};
  cell.sector_boundary_markers = {20, 21, 22};
  const Json json = Json::parse(written(cell, MeshPart::kFull, MeshFormat::kJson));
  EXPECT_EQ(json["regions"], Json({10, 11, 12}));
  EXPECT_EQ(json["boundary"][2]["marker"], 22);
}

// The sections of an MSH file, by name.
std::map<std::string, std::string> sections(const std::string& text) {
  std::map<std::string, std::string> result;
  std::istringstream in(text);
  std::string line;
  std::string name;
  while (std::getline(in, line)) {
    if (line.starts_with("$End")) {
      EXPECT_EQ(line, "$End" + name);
      name.clear();
    } else if (line.starts_with("$")) {
      name = line.substr(1);
    } else {
      result[name] += line + "\n";
    }
  }
  return result;
}

TEST(Msh, CountsAreThoseOfTheMesh) {
  for (const SymmetryCellMesh& cell : meshes()) {
    for (const MeshPart part : {MeshPart::kCell, MeshPart::kFull}) {
      auto parts = sections(written(cell, part, MeshFormat::kMsh));
      EXPECT_EQ(parts["MeshFormat"], "4.1 0 8\n");
      std::istringstream nodes(parts["Nodes"]);
      std::size_t blocks = 0;
      std::int64_t count = 0;
      nodes >> blocks >> count;
      EXPECT_EQ(count, part == MeshPart::kCell ? static_cast<std::int64_t>(cell.nodes.size())
                                               : FullMeshView(cell).node_count());
      const bool periodic = part == MeshPart::kCell && cell.fold > 1;
      EXPECT_EQ(parts.contains("Periodic"), periodic);
      EXPECT_EQ(parts["PhysicalNames"].find("lower_bound") != std::string::npos, periodic);
    }
  }
}

TEST(Msh, PeriodicMapTakesLowerToHigher) {
  for (const SymmetryCellMesh& cell : meshes()) {
    if (cell.fold == 1) continue;
    std::istringstream in(sections(written(cell, MeshPart::kCell, MeshFormat::kMsh))["Periodic"]);
    int links = 0, dimension = 0, slave = 0, master = 0, size = 0;
    in >> links >> dimension >> slave >> master >> size;
    EXPECT_EQ(links, 1);
    EXPECT_EQ(dimension, 1);
    const std::string names =
        sections(written(cell, MeshPart::kCell, MeshFormat::kMsh))["PhysicalNames"];
    EXPECT_NE(names.find("1 " + std::to_string(slave) + " \"higher_bound\""), std::string::npos);
    EXPECT_NE(names.find("1 " + std::to_string(master) + " \"lower_bound\""), std::string::npos);
    ASSERT_EQ(size, 16);
    double map[16];
    for (double& entry : map) in >> entry;
    std::size_t pairs = 0;
    in >> pairs;
    ASSERT_GT(pairs, 0U);
    const FullMeshView view(cell);
    for (std::size_t i = 0; i < pairs; ++i) {
      std::size_t higher = 0, lower = 0;
      in >> higher >> lower;
      const Point3 p = view.cell_node_position(lower - 1);
      const Point3 q = view.cell_node_position(higher - 1);
      EXPECT_NEAR(map[0] * p.x + map[1] * p.y + map[2] * p.z + map[3], q.x, 1e-13);
      EXPECT_NEAR(map[4] * p.x + map[5] * p.y + map[6] * p.z + map[7], q.y, 1e-13);
      EXPECT_NEAR(map[8] * p.x + map[9] * p.y + map[10] * p.z + map[11], 0, 1e-13);
    }
  }
}

TEST(Svg, ShowsTheBoundsAndEverySector) {
  const SymmetryCellMesh cell = test::disc_cell(5, 2, {3, 4});
  const std::string part = written(cell, MeshPart::kCell, MeshFormat::kSvg);
  EXPECT_TRUE(part.starts_with("<svg"));
  EXPECT_NE(part.find("#d62424"), std::string::npos);
  EXPECT_NE(part.find("#2454d6"), std::string::npos);
  EXPECT_EQ(part.find("<use"), std::string::npos);
  const std::string full = written(cell, MeshPart::kFull, MeshFormat::kSvg);
  std::size_t uses = 0;
  for (std::size_t at = full.find("<use"); at != std::string::npos;
       at = full.find("<use", at + 1)) {
    ++uses;
  }
  EXPECT_EQ(uses, 4U);
  EXPECT_NE(full.find("rotate(-72)"), std::string::npos);
}

TEST(MeshWriter, StopsWithItsReceiver) {
  const SymmetryCellMesh cell = test::ring_cell({.fold = 20000, .steps = 4, .layers = 4});
  for (const MeshFormat format : {MeshFormat::kJson, MeshFormat::kVtu, MeshFormat::kMsh}) {
    int pieces = 0;
    const auto done = write_mesh(cell, MeshPart::kFull, format, {},
                                 [&](std::string_view) { return ++pieces < 3; });
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().code, ErrorCode::kWriteFailed);
    EXPECT_EQ(pieces, 3);
  }
}

}  // namespace
}  // namespace symcell
