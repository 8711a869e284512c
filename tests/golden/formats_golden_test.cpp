// Every format on one small mesh whose coordinates are exact on any machine: a square of four
// quarter turns about its centre.
#include <gtest/gtest.h>

#include <cstring>
#include <initializer_list>
#include <nlohmann/json.hpp>

#include "api/problem.hpp"
#include "api/schema/options.hpp"
#include "core/cell/quadratic.hpp"
#include "tests/golden/golden.hpp"
#include "tests/support/extruded_cells.hpp"
#include "tests/support/sample_cells.hpp"
#include "tests/support/written_mesh.hpp"

namespace symcell {
namespace {

using test::expect_golden;
using test::written;

SymmetryCellMesh quarter() {
  return test::disc_cell(4, 1, {3, -1});
}

SymmetryCellMesh prism() {
  test::Extrusion how;
  how.layers = 1;
  how.height = 1;
  how.frame.origin = {3, -1, 2};
  return test::extruded_cell(test::disc_cell(4, 1, {0, 0}), how);
}

TEST(Golden, Json) {
  expect_golden("quarter_cell.json", written(quarter(), MeshPart::kCell, MeshFormat::kJson));
  expect_golden("quarter_full.json", written(quarter(), MeshPart::kFull, MeshFormat::kJson));
  expect_golden("quarter_cell_order2.json",
                written(elevate_to_quadratic(quarter()), MeshPart::kCell, MeshFormat::kJson));
}

TEST(Golden, PackedJson) {
  WriteOptions packed;
  packed.packed = PackedReals::kFloat32;
  expect_golden("quarter_cell_packed.json",
                written(quarter(), MeshPart::kCell, MeshFormat::kJson, packed));
  packed.packed = PackedReals::kFloat64;
  expect_golden("prism_full_packed.json",
                written(prism(), MeshPart::kFull, MeshFormat::kJson, packed));
}

// The description of what the binary part holds; that part is read back elsewhere.
std::string glb_description(const std::string& glb) {
  const auto number = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, glb.data() + at, sizeof value);
    return value;
  };
  EXPECT_EQ(glb.substr(0, 4), "glTF");
  EXPECT_EQ(number(8), glb.size());
  return nlohmann::ordered_json::parse(glb.substr(20, number(12))).dump(1) + "\n";
}

TEST(Golden, Glb) {
  expect_golden("quarter_full.glb.json",
                glb_description(written(quarter(), MeshPart::kFull, MeshFormat::kGlb)));
  expect_golden("prism_cell.glb.json",
                glb_description(written(prism(), MeshPart::kCell, MeshFormat::kGlb)));
}

TEST(Golden, Vtu) {
  const WriteOptions ascii{VtuEncoding::kAscii};
  expect_golden("quarter_cell.vtu", written(quarter(), MeshPart::kCell, MeshFormat::kVtu, ascii));
  expect_golden("quarter_full.vtu", written(quarter(), MeshPart::kFull, MeshFormat::kVtu, ascii));
  // The head of the binary file; its data are checked by reading back.
  const std::string raw = written(quarter(), MeshPart::kCell, MeshFormat::kVtu);
  expect_golden("quarter_cell_raw_head.vtu", raw.substr(0, raw.find("<AppendedData")));
}

TEST(Golden, Msh) {
  expect_golden("quarter_cell.msh", written(quarter(), MeshPart::kCell, MeshFormat::kMsh));
  expect_golden("quarter_full.msh", written(quarter(), MeshPart::kFull, MeshFormat::kMsh));
  expect_golden("quarter_cell_order2.msh",
                written(elevate_to_quadratic(quarter()), MeshPart::kCell, MeshFormat::kMsh));
  expect_golden("square_cell.msh", written(test::square_cell(), MeshPart::kCell, MeshFormat::kMsh));
}

TEST(Golden, Msh2) {
  expect_golden("quarter_cell.msh2", written(quarter(), MeshPart::kCell, MeshFormat::kMsh2));
}

TEST(Golden, Solids) {
  const WriteOptions ascii{VtuEncoding::kAscii};
  expect_golden("prism_cell.json", written(prism(), MeshPart::kCell, MeshFormat::kJson));
  expect_golden("prism_cell.vtu", written(prism(), MeshPart::kCell, MeshFormat::kVtu, ascii));
  expect_golden("prism_full.vtu", written(prism(), MeshPart::kFull, MeshFormat::kVtu, ascii));
  expect_golden("prism_cell.msh", written(prism(), MeshPart::kCell, MeshFormat::kMsh));
  expect_golden("prism_cell_order2.msh",
                written(elevate_to_quadratic(prism()), MeshPart::kCell, MeshFormat::kMsh));
  expect_golden("prism_cell.stl", written(prism(), MeshPart::kCell, MeshFormat::kStl, ascii));
  expect_golden("prism_full.stl", written(prism(), MeshPart::kFull, MeshFormat::kStl, ascii));
}

WriteOptions deck(std::initializer_list<std::pair<const char*, const char*>> texts) {
  WriteOptions options;
  for (const auto& [name, text] : texts) {
    EXPECT_TRUE(set_deck_option(options.deck, name, text)) << name;
  }
  return options;
}

TEST(Golden, Decks) {
  const WriteOptions modal = deck({{"analysis", "modal"}, {"material", "steel"}});
  const WriteOptions loaded = deck({{"analysis", "static"},
                                    {"material", "7=steel_si"},
                                    {"support", "11"},
                                    {"load", "boundary_12=2.5"}});
  expect_golden("prism_cell_modal.inp", written(prism(), MeshPart::kCell, MeshFormat::kInp, modal));
  expect_golden("prism_cell_static.inp",
                written(prism(), MeshPart::kCell, MeshFormat::kInp, loaded));
  expect_golden("prism_full_static.inp",
                written(prism(), MeshPart::kFull, MeshFormat::kInp, loaded));
  expect_golden("quarter_cell_order2.inp",
                written(elevate_to_quadratic(quarter()), MeshPart::kCell, MeshFormat::kInp));
  const WriteOptions made_of = deck({{"material", "titanium"}});
  expect_golden("prism_cell.bdf", written(prism(), MeshPart::kCell, MeshFormat::kBdf, made_of));
  expect_golden("prism_cell_order2.cdb",
                written(elevate_to_quadratic(prism()), MeshPart::kCell, MeshFormat::kCdb, made_of));
}

TEST(Golden, Boundary) {
  const WriteOptions ascii{VtuEncoding::kAscii};
  expect_golden("prism_cell.vtp", written(prism(), MeshPart::kCell, MeshFormat::kVtp, ascii));
  expect_golden("quarter_cell_order2.vtp",
                written(elevate_to_quadratic(quarter()), MeshPart::kCell, MeshFormat::kVtp, ascii));
}

TEST(Golden, Svg) {
  expect_golden("quarter_cell.svg", written(quarter(), MeshPart::kCell, MeshFormat::kSvg));
  expect_golden("quarter_full.svg", written(quarter(), MeshPart::kFull, MeshFormat::kSvg));
}

TEST(Golden, Options) {
  expect_golden("options_defaults.json",
                options_to_json(MeshOptions{}, ModelKind::kPslg).dump(1) + "\n");
  expect_golden("options_defaults_surface.json",
                options_to_json(MeshOptions{}, ModelKind::kSurface).dump(1) + "\n");
  std::string table;
  for (const OptionInfo& info : mesh_option_table()) {
    table += std::string(info.name) + " | " + std::string(info.metavar) + " | " +
             std::string(info.standard) + " | " + std::string(info.help) + "\n";
  }
  expect_golden("options_table.txt", table);
}

// Codes, statuses and exit codes are part of the interface.
TEST(Golden, Problems) {
  std::string table;
  for (const ProblemRow& row : problem_table()) {
    table += std::string(error_code_name(row.code)) + " " + std::to_string(row.http_status) + " " +
             std::to_string(row.exit_code) + " " + std::string(row.title) + "\n";
  }
  expect_golden("problems.txt", table);
}

}  // namespace
}  // namespace symcell
