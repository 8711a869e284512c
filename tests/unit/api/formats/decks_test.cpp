// What decks hold, and what is refused before a byte of them is written.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include "api/formats/decks/bound_nodes.hpp"
#include "api/formats/decks/deck_groups.hpp"
#include "api/formats/decks/deck_numbers.hpp"
#include "core/cell/full_mesh.hpp"
#include "core/cell/quadratic.hpp"
#include "tests/support/extruded_cells.hpp"
#include "tests/support/sample_cells.hpp"
#include "tests/support/written_mesh.hpp"

namespace symcell {
namespace {

using test::written;
using Texts = std::vector<std::pair<std::string, std::string>>;

WriteOptions options_of(const Texts& texts) {
  WriteOptions options;
  for (const auto& [name, text] : texts) EXPECT_TRUE(set_deck_option(options.deck, name, text));
  return options;
}

std::vector<SymmetryCellMesh> solids() {
  std::vector<SymmetryCellMesh> all;
  for (const test::SolidSample& sample : test::solid_samples()) {
    all.push_back(sample.cell);
    all.push_back(elevate_to_quadratic(sample.cell));
  }
  return all;
}

// The lines of a card, comments left out.
std::vector<std::string> card(const std::string& deck, const std::string& head) {
  std::vector<std::string> lines;
  std::istringstream in(deck);
  std::string line;
  bool inside = false;
  while (std::getline(in, line)) {
    if (line.starts_with("**")) continue;
    if (line.starts_with("*")) {
      inside = line == head;
    } else if (inside) {
      lines.push_back(line);
    }
  }
  return lines;
}

std::set<std::int64_t> ids(const std::vector<std::string>& lines) {
  std::set<std::int64_t> result;
  for (const std::string& line : lines) {
    std::istringstream in(line);
    std::string entry;
    while (std::getline(in, entry, ',')) {
      if (entry.find_first_of("0123456789") != std::string::npos) {
        EXPECT_TRUE(result.insert(std::stoll(entry)).second) << "twice: " << entry;
      }
    }
  }
  return result;
}

TEST(DeckNumbers, FitTheirFields) {
  using internal::fitting_number;
  using internal::nastran_number;
  EXPECT_EQ(fitting_number(-0.0, 20), "0");
  EXPECT_EQ(fitting_number(0.5, 20), "0.5");
  for (const double value : {-1.0 / 3, 1e300 / 3, -1e-300 / 3, -1e-5 / 3, 123456789.123456789,
                             -0.00012345678901234567}) {
    const std::string text = fitting_number(value, 20);
    EXPECT_LE(text.size(), 20U);
    EXPECT_NEAR(std::stod(text) / value, 1, 1e-12) << text;
    const std::string field = nastran_number(value, 16);
    EXPECT_LE(field.size(), 16U) << field;
    EXPECT_NE(field.find('.'), std::string::npos) << field;
    EXPECT_EQ(field.find('e'), std::string::npos) << field;
  }
  EXPECT_EQ(nastran_number(1, 8), "1.");
  EXPECT_EQ(nastran_number(1e-9, 16), "1.-09");
  EXPECT_EQ(internal::without_rounding({1e-15, -2, 3e-14}, 1), (Point3{0, -2, 3e-14}));
}

TEST(DeckNames, AreUniqueAndPlain) {
  SymmetryCellMesh cell = test::square_cell();
  cell.marker_names = {
      {1, "bore"}, {2, "BORE"}, {3, "1st \"ring\""}, {4, "nall"}, {5, "bore_support"}};
  MeshStream mesh(cell, MeshPart::kCell);
  const MeshGroups groups(mesh);
  const std::array<std::string_view, 1> reserved{"NALL"};
  const auto names = internal::deck_names(cell, groups, 20, reserved);
  EXPECT_EQ(names.markers, (std::vector<std::string>{"bore", "BORE_2", "g_1st__ring_", "nall_2",
                                                     "bore_support_2"}));
  EXPECT_EQ(names.regions, (std::vector<std::string>{"region_1", "region_2"}));
  EXPECT_EQ(internal::find_marker_group(cell, groups, names, "3"), 2U);
  EXPECT_EQ(internal::find_marker_group(cell, groups, names, "BORE"), 1U);
  const auto absent = internal::find_marker_group(cell, groups, names, "rim");
  ASSERT_FALSE(absent);
  EXPECT_NE(absent.error().message.find("bore"), std::string::npos);
}

// Of every tie the nodes lie apart in (r, z); together they pair the bounds.
TEST(InpDeck, TiesPairTheBoundsAndNodesDifferInEach) {
  for (const SymmetryCellMesh& cell : solids()) {
    const std::string deck = written(cell, MeshPart::kCell, MeshFormat::kInp);
    std::map<std::int64_t, std::int64_t> pairs;
    const FullMeshView view(cell);
    std::size_t ties = 0;
    for (;; ++ties) {
      const auto lower = card(deck, "*SURFACE, NAME=LOWER" + std::to_string(ties) + ", TYPE=NODE");
      const auto higher =
          card(deck, "*SURFACE, NAME=HIGHER" + std::to_string(ties) + ", TYPE=NODE");
      ASSERT_EQ(lower.size(), higher.size());
      if (lower.empty()) break;
      std::vector<std::pair<double, double>> places;
      for (std::size_t i = 0; i < lower.size(); ++i) {
        const std::int64_t a = std::stoll(lower[i]) - 1;
        pairs[a] = std::stoll(higher[i]) - 1;
        const Point3 p = cell.orbit_points[static_cast<std::size_t>(
            cell.nodes[static_cast<std::size_t>(a)].orbit)];
        for (const auto& [r, z] : places)
          EXPECT_GT(std::hypot(std::hypot(p.x, p.y) - r, p.z - z), 1e-9);
        places.emplace_back(std::hypot(p.x, p.y), p.z);
      }
    }
    std::size_t paired = 0;
    for (std::size_t i = 0; i < cell.nodes.size(); ++i) {
      if (cell.lower_to_higher[i] < 0) continue;
      ++paired;
      EXPECT_EQ(pairs.at(static_cast<std::int64_t>(i)), cell.lower_to_higher[i]);
    }
    EXPECT_EQ(pairs.size(), paired);
    EXPECT_EQ(ties > 0, cell.fold > 1);
  }
}

// Facets as sides of elements: the corners are those of the boundary.
TEST(InpDeck, SurfacesAreTheFacetsOfTheirGroups) {
  constexpr std::array<std::array<std::size_t, 3>, 4> kSides{
      {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}};
  for (const SymmetryCellMesh& cell : solids()) {
    const auto ke = static_cast<std::size_t>(cell.nodes_per_element);
    const auto kf = static_cast<std::size_t>(cell.nodes_per_facet);
    const auto sides = internal::facet_sides(cell);
    ASSERT_TRUE(sides);
    for (std::size_t b = 0; b < cell.facet_count(); ++b) {
      std::set<std::int32_t> facet(&cell.boundary[b * kf], &cell.boundary[b * kf] + 3);
      std::set<std::int32_t> side;
      for (const std::size_t c : kSides[(*sides)[b].side]) {
        side.insert(cell.elements[(*sides)[b].element * ke + c]);
      }
      EXPECT_EQ(side, facet);
      EXPECT_EQ((*sides)[b].inner, cell.boundary_markers[b] == test::kPlateMarker);
    }
  }
}

TEST(InpDeck, SupportsHoldNoNodeThatDependsOnOthers) {
  for (const SymmetryCellMesh& cell : solids()) {
    const std::string deck = written(cell, MeshPart::kCell, MeshFormat::kInp);
    std::set<std::int64_t> held;
    for (const std::int64_t i : ids(card(deck, "*NSET, NSET=boundary_11_support"))) {
      held.insert(cell.nodes[static_cast<std::size_t>(i - 1)].orbit);
      EXPECT_LT(cell.lower_to_higher[static_cast<std::size_t>(i - 1)], 0);
    }
    if (cell.fold == 1) continue;
    // Every orbit off the axis that the group has a node of.
    std::set<std::int64_t> all;
    for (const std::int64_t i : ids(card(deck, "*NSET, NSET=boundary_11"))) {
      const auto orbit = cell.nodes[static_cast<std::size_t>(i - 1)].orbit;
      if (cell.on_axis[static_cast<std::size_t>(orbit)] == 0) all.insert(orbit);
    }
    EXPECT_EQ(held, all);
  }
}

// Off the axis one step does; with nodes on it nodal diameters 0, 1 and the others are parted.
TEST(InpDeck, NodesOnTheAxisPartTheSteps) {
  const WriteOptions modal = options_of({{"analysis", "modal"}, {"material", "steel"}});
  for (const SymmetryCellMesh& cell : solids()) {
    const std::string deck = written(cell, MeshPart::kCell, MeshFormat::kInp, modal);
    std::size_t steps = 0;
    for (std::size_t at = 0; (at = deck.find("*FREQUENCY", at)) != std::string::npos; ++at) ++steps;
    const bool axis = std::ranges::any_of(cell.nodes, [&](const OrbitVertex& v) {
      return cell.on_axis[static_cast<std::size_t>(v.orbit)] != 0;
    });
    EXPECT_EQ(steps, axis && cell.fold > 1 ? (cell.fold >= 4 ? 3U : 2U) : 1U);
  }
}

ErrorCode refusal(const SymmetryCellMesh& cell,
                  MeshFormat format,
                  const Texts& texts,
                  const std::string& word) {
  const WriteOptions options = options_of(texts);
  const auto checked = check_mesh_output(cell, MeshPart::kCell, format, options);
  const auto done = write_mesh(cell, MeshPart::kCell, format, options, [](std::string_view) {
    ADD_FAILURE() << "nothing is written";
    return true;
  });
  if (checked || done) {
    ADD_FAILURE() << "was taken";
    return ErrorCode::kInternal;
  }
  EXPECT_EQ(checked.error().code, done.error().code);
  EXPECT_NE(checked.error().message.find(word), std::string::npos) << checked.error().message;
  return checked.error().code;
}

TEST(Decks, WhatCannotBeExpressedIsRefused) {
  const SymmetryCellMesh solid = test::solid_samples().front().cell;
  const SymmetryCellMesh planar = test::disc_cell(4, 1, {0, 0});
  const std::pair<std::string, std::string> steel{"material", "steel"};
  constexpr auto kInp = MeshFormat::kInp;
  constexpr auto kBad = ErrorCode::kBadOption;
  EXPECT_EQ(refusal(solid, kInp, {{"analysis", "modal"}}, "material="), kBad);
  EXPECT_EQ(refusal(solid, kInp, {{"material", "999=steel"}}, "region 999"), kBad);
  EXPECT_EQ(refusal(solid, kInp, {{"analysis", "static"}, steel}, "support="), kBad);
  EXPECT_EQ(refusal(solid, kInp, {{"analysis", "static"}, steel, {"support", "11"}}, "load="),
            kBad);
  EXPECT_EQ(refusal(solid, kInp, {{"analysis", "modal"}, steel, {"support", "rim"}}, "\"rim\""),
            kBad);
  EXPECT_EQ(refusal(solid, kInp, {{"analysis", "modal"}, steel, {"load", "11=1"}}, "static"), kBad);
  EXPECT_EQ(refusal(solid, MeshFormat::kBdf, {{"analysis", "modal"}, steel}, "inp"), kBad);
  EXPECT_EQ(refusal(solid, MeshFormat::kVtu, {steel}, "vtu"), kBad);
  EXPECT_EQ(refusal(planar, kInp, {{"analysis", "modal"}, steel}, "plane elements"),
            ErrorCode::kUnsupportedModel);
  EXPECT_EQ(
      refusal(planar, kInp, {{"analysis", "static"}, steel, {"support", "3"}, {"load", "3=1"}},
              "plane=strain"),
      ErrorCode::kUnsupportedModel);
}

// The cell of a third turn: node and its copies at 0, 1 and 2 sectors.
SymmetryCellMesh chained() {
  SymmetryCellMesh cell = test::extruded_cell(test::disc_cell(6, 1, {0, 0}), {});
  const auto nodes = cell.nodes.size();
  const auto elements = cell.elements;
  const auto regions = cell.regions;
  std::vector<std::int32_t> image(nodes, -1);
  for (std::size_t i = 0; i < nodes; ++i) {
    const OrbitVertex v = cell.nodes[i];
    const bool axis = cell.on_axis[static_cast<std::size_t>(v.orbit)] != 0;
    const OrbitVertex turned{v.orbit, axis ? 0 : v.exponent + 1};
    const auto known = std::ranges::find(cell.nodes, turned);
    image[i] = static_cast<std::int32_t>(known - cell.nodes.begin());
    if (known == cell.nodes.end()) {
      cell.nodes.push_back(turned);
      cell.node_markers.push_back(0);
      cell.lower_to_higher.push_back(-1);
    }
  }
  for (const std::int32_t node : elements)
    cell.elements.push_back(image[static_cast<std::size_t>(node)]);
  cell.regions.insert(cell.regions.end(), regions.begin(), regions.end());
  for (std::size_t i = 0; i < nodes; ++i) cell.lower_to_higher[i] = image[i];
  return cell;
}

TEST(Decks, AThirdCopyOfANodeIsRefusedWherePairsAreAllThereIs) {
  const SymmetryCellMesh cell = chained();
  for (const MeshFormat format : {MeshFormat::kInp, MeshFormat::kBdf, MeshFormat::kCdb}) {
    EXPECT_EQ(refusal(cell, format, {}, "copies of node"), ErrorCode::kUnsupportedModel);
  }
  // Equations can: every copy follows from one node.
  const auto bounds = internal::bound_nodes(cell);
  EXPECT_GE(bounds.beyond_pairs, 0);
  std::set<std::int32_t> dependent, independent;
  for (const internal::NodeCopy& copy : bounds.copies) {
    EXPECT_TRUE(dependent.insert(copy.dependent).second);
    independent.insert(copy.independent);
  }
  for (const std::int32_t node : independent) EXPECT_FALSE(dependent.contains(node));
  const WriteOptions loaded = options_of(
      {{"analysis", "static"}, {"material", "steel"}, {"support", "11"}, {"load", "12=1"}});
  EXPECT_TRUE(check_mesh_output(cell, MeshPart::kCell, MeshFormat::kInp, loaded));
}

TEST(DeckOptions, AreReadOrRefused) {
  DeckOptions options;
  ASSERT_TRUE(set_deck_option(options, "material", "3=70e3/0.33/2.7e-9,aluminum"));
  EXPECT_EQ(options.materials[0].region, 3);
  EXPECT_EQ(options.materials[0].material.modulus, 70e3);
  EXPECT_FALSE(options.materials[1].region);
  EXPECT_EQ(options.materials[1].material.density, 2.7e-9);
  ASSERT_TRUE(set_deck_option(options, "load", "a=b=2"));
  EXPECT_EQ(options.loads[0].group, "a=b");
  for (const auto& [name, text] : Texts{{"analysis", "buckling"},
                                        {"material", "wood"},
                                        {"material", "1/2/3"},
                                        {"material", "x=steel"},
                                        {"material", "aluminium"},
                                        {"load", "bore"},
                                        {"load", "=3"},
                                        {"support", "a,,b"},
                                        {"plane", "curved"},
                                        {"colour", "red"}}) {
    const auto set = set_deck_option(options, name, text);
    ASSERT_FALSE(set) << name << " " << text;
    EXPECT_EQ(set.error().code, ErrorCode::kBadOption);
  }
}

TEST(MshTags, AreTheUsersOwnAndUniqueOverDimensions) {
  SymmetryCellMesh cell = test::disc_cell(4, 1, {0, 0});  // marker 3, region 7
  for (const MeshFormat format : {MeshFormat::kMsh, MeshFormat::kMsh2}) {
    const std::string msh = written(cell, MeshPart::kCell, format);
    EXPECT_NE(msh.find("\n1 3 \"boundary_3\"\n"), std::string::npos);
    EXPECT_NE(msh.find("\n2 7 \"region_7\"\n"), std::string::npos);
    EXPECT_NE(msh.find("\n1 1 \"lower_bound\"\n"), std::string::npos);
    EXPECT_NE(msh.find("\n1 2 \"higher_bound\"\n"), std::string::npos);
  }
  // A region of a marker's number gives way, and so do the bounds; 0 is no tag.
  cell.regions.assign(cell.regions.size(), 1);
  cell.boundary_markers.assign(cell.boundary_markers.size(), 1);
  const std::string msh = written(cell, MeshPart::kCell, MeshFormat::kMsh);
  EXPECT_NE(msh.find("\n1 1 \"boundary_1\"\n"), std::string::npos);
  EXPECT_NE(msh.find("\n1 2 \"lower_bound\"\n"), std::string::npos);
  EXPECT_NE(msh.find("\n1 3 \"higher_bound\"\n"), std::string::npos);
  EXPECT_NE(msh.find("\n2 4 \"region_1\"\n"), std::string::npos);
}

}  // namespace
}  // namespace symcell
