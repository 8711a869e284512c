// A cell that is read from a file is the one that was written, in every format.
#include "api/formats/cell_input.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "api/formats/cell_archive.hpp"
#include "api/formats/vtu_reader.hpp"
#include "core/cell/quadratic.hpp"
#include "tests/support/extruded_cells.hpp"
#include "tests/support/sample_cells.hpp"
#include "tests/support/written_mesh.hpp"

namespace symcell {
namespace {

using test::written;

std::vector<SymmetryCellMesh> cells() {
  std::vector<SymmetryCellMesh> all{test::disc_cell(4, 1, {3, -1}), test::square_cell(),
                                    test::disc_cell(3, 1, {0, 0}), test::disc_cell(7, 2, {1, 1})};
  for (const std::int32_t fold : {3, 5}) {
    test::Extrusion how;
    how.layers = 2;
    how.height = 1.5;
    how.frame = AxisFrame::of_axis({3, -1, 2}, {1, 2, 2});
    all.push_back(test::extruded_cell(test::disc_cell(fold, 1, {0, 0}), how));
  }
  const std::size_t linear = all.size();
  for (std::size_t i = 0; i < linear; ++i) all.push_back(elevate_to_quadratic(all[i]));
  return all;
}

// Places go through the axis' frame and back, which rounds.
void expect_same(const SymmetryCellMesh& found, const SymmetryCellMesh& wanted) {
  const auto a = read_vtu(written(found, MeshPart::kCell, MeshFormat::kVtu));
  const auto b = read_vtu(written(wanted, MeshPart::kCell, MeshFormat::kVtu));
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->order, b->order);
  EXPECT_EQ(a->fold, b->fold);
  EXPECT_EQ(a->elements, b->elements);
  EXPECT_EQ(a->regions, b->regions);
  EXPECT_EQ(a->markers, b->markers);
  EXPECT_EQ(a->lower_to_higher, b->lower_to_higher);
  ASSERT_EQ(a->points.size(), b->points.size());
  for (std::size_t i = 0; i < a->points.size(); ++i) {
    EXPECT_LT(distance(a->points[i], b->points[i]), 1e-13);
  }
  EXPECT_EQ(found.lower_facets.size(), wanted.lower_facets.size());
}

TEST(CellInput, JsonLosesNothing) {
  for (SymmetryCellMesh cell : cells()) {
    cell.marker_names = {{11, "bore"}, {12, "two words"}};
    const std::string json = written(cell, MeshPart::kCell, MeshFormat::kJson);
    const auto read = read_cell(json);
    ASSERT_TRUE(read) << read.error().message;
    expect_same(*read, cell);
    EXPECT_EQ(read->boundary, cell.boundary);
    EXPECT_EQ(read->boundary_markers, cell.boundary_markers);
    EXPECT_EQ(read->marker_names, cell.marker_names);
    EXPECT_EQ(read->boundary_is_higher_image, cell.boundary_is_higher_image);
  }
}

// Nodes of the full mesh may be numbered otherwise, as orbits are.
TEST(CellInput, FullMeshesHaveTheSameNumbersOfAll) {
  for (const SymmetryCellMesh& cell : cells()) {
    const auto read = read_cell(written(cell, MeshPart::kCell, MeshFormat::kJson));
    ASSERT_TRUE(read);
    using Json = nlohmann::json;
    const Json a = Json::parse(written(cell, MeshPart::kFull, MeshFormat::kJson));
    const Json b = Json::parse(written(*read, MeshPart::kFull, MeshFormat::kJson));
    for (const char* list : {"nodes", "elements", "boundary", "regions"}) {
      EXPECT_EQ(a[list].size(), b[list].size()) << list;
    }
    EXPECT_EQ(a["regions"], b["regions"]);
  }
}

TEST(CellInput, ArchivesAndVtuAreRead) {
  for (const SymmetryCellMesh& cell : cells()) {
    std::string archive;
    ASSERT_TRUE(write_cell_archive(cell, [&](std::string_view piece) {
      archive += piece;
      return true;
    }));
    const auto first = read_cell(archive);
    ASSERT_TRUE(first);
    const std::string vtu = written(cell, MeshPart::kCell, MeshFormat::kVtu);
    EXPECT_EQ(written(*first, MeshPart::kCell, MeshFormat::kVtu),
              vtu);  // an archive is the cell itself
    const auto second = read_cell(vtu);
    ASSERT_TRUE(second) << second.error().message;
    expect_same(*second, cell);
  }
}

TEST(CellInput, OtherFilesAreRefused) {
  const SymmetryCellMesh cell = test::disc_cell(4, 1, {3, -1});
  EXPECT_FALSE(read_cell(""));
  EXPECT_FALSE(read_cell("{}"));
  EXPECT_FALSE(read_cell("{\"elements\":[],\"lower\":[]}"));
  EXPECT_FALSE(read_cell("SYMCELL"));
  const auto full = read_cell(written(cell, MeshPart::kFull, MeshFormat::kJson));
  ASSERT_FALSE(full);
  EXPECT_EQ(full.error().code, ErrorCode::kUnsupportedModel);
  EXPECT_FALSE(read_cell(written(cell, MeshPart::kFull, MeshFormat::kVtu)));
  nlohmann::json json = nlohmann::json::parse(written(cell, MeshPart::kCell, MeshFormat::kJson));
  for (const char* list : {"elements", "regions", "markers", "lower", "nodes"}) {
    nlohmann::json damaged = json;
    damaged[list].erase(damaged[list].size() - 1);
    EXPECT_FALSE(read_cell(damaged.dump())) << list;
  }
  json["elements"][0][0] = 1000000;
  EXPECT_FALSE(read_cell(json.dump()));
}

// Each would become a wrong full mesh, or end the program.
TEST(CellInput, CellsWhoseCopiesDoNotFitAreRefused) {
  test::Extrusion how;
  how.layers = 2;
  how.height = 1.5;
  const SymmetryCellMesh cell = test::extruded_cell(test::disc_cell(5, 1, {0, 0}), how);
  using Json = nlohmann::json;
  const Json good = Json::parse(written(cell, MeshPart::kCell, MeshFormat::kJson));
  ASSERT_TRUE(read_cell(good.dump()));
  const auto refused = [&](const char* pointer, const Json& value, const char* why) {
    Json damaged = good;
    damaged[Json::json_pointer(pointer)] = value;
    const auto read = read_cell(damaged.dump());
    ASSERT_FALSE(read) << pointer << ": " << value;
    EXPECT_NE(read.error().message.find(why), std::string::npos) << read.error().message;
    EXPECT_EQ(read.error().message.find("exception"), std::string::npos) << read.error().message;
  };
  refused("/fold", 6, "cell.pairs");
  refused("/fold", 5.5, "no integer");
  refused("/fold", 30001, "30000");
  // Numbers that would be others in 32 bits.
  refused("/fold", 4294967301, "fold");
  refused("/elements/0/0", 4294967296 + good["elements"][0][0].get<std::int64_t>(), "another type");
  refused("/lower/0", 4294967296 + good["lower"][0].get<std::int64_t>(), "another type");
  refused("/dimension", 4, "dimension");
  refused("/dimension", 2147483647, "dimension");
  refused("/regions", 1, "another type");
  refused("/regions", Json({{"a", 1}}), "another type");
  refused("/marker_names", {{"12x", "bore"}}, "another type");
  refused("/axis/direction", {0, 0, 0}, "axis");
  refused("/axis/direction", {0, 1, 0}, "cell.pairs");
  refused("/nodes/0/0", 1e308, "coordinate");
  refused("/nodes/0/0", "x", "another type");
  refused("/elements/0/0", good["elements"][0][1], "cell.corners");
  refused("/packed", "exact", "without --packed");
  Json turned = good;
  std::swap(turned["elements"][0][0], turned["elements"][0][1]);
  const auto read = read_cell(turned.dump());
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message.find("cell.orientation"), std::string::npos);
  const auto cut = read_cell(good.dump().substr(0, 100));
  ASSERT_FALSE(cut);
  EXPECT_NE(cut.error().message.find("at byte"), std::string::npos) << cut.error().message;

  Json named = good;
  named["marker_names"] = {{"1", "two\nlines"}};
  const auto renamed = read_cell(named.dump());
  ASSERT_TRUE(renamed);
  EXPECT_EQ(renamed->marker_names.front().name, "two_lines");
}

}  // namespace
}  // namespace symcell
