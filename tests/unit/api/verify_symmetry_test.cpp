// verify_mesh on cells whose symmetry is damaged: pairs, bounds, copies.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "api/formats/vtu_reader.hpp"
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
    if (c.status == Check::Status::kFail) names += c.name + " ";
  }
  return names;
}

bool fails(const VerifyReport& report, const std::string& name) {
  return std::ranges::any_of(report.checks, [&](const Check& c) {
    return c.name == name && c.status == Check::Status::kFail;
  });
}

std::size_t first_lower(const MeshData& cell) {
  const auto found =
      std::ranges::find_if(cell.lower_to_higher, [](std::int32_t j) { return j >= 0; });
  return static_cast<std::size_t>(found - cell.lower_to_higher.begin());
}

// Two nodes that are nearly one, and the same pair: an element of the first gets the second.
void split_first_lower_node(MeshData& cell) {
  const std::size_t node = first_lower(cell);
  cell.points.push_back(cell.points[node]);
  cell.points.back().x += 2e-9;  // above what makes nodes one, below the tolerance of pairs
  cell.lower_to_higher.push_back(cell.lower_to_higher[node]);
  *std::ranges::find(cell.elements, static_cast<std::int32_t>(node)) =
      static_cast<std::int32_t>(cell.points.size()) - 1;
}

// One flaw at a time, and the check that must find it.
struct Flaw {
  const char* check;
  std::function<void(MeshData& cell, MeshData& full)> make;
};

const Flaw kFlaws[] = {
    {"cell.pairs",
     [](auto& c, auto&) {
       const std::size_t i = first_lower(c);
       const auto next =
           std::find_if(c.lower_to_higher.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                        c.lower_to_higher.end(), [](std::int32_t j) { return j >= 0; });
       std::iter_swap(c.lower_to_higher.begin() + static_cast<std::ptrdiff_t>(i), next);
     }},
    {"cell.pairs", [](auto& c, auto&) { c.lower_to_higher[first_lower(c)] = -7; }},
    {"cell.pairs", [](auto& c, auto&) { c.lower_to_higher[first_lower(c)] = 1'000'000; }},
    {"cell.pairs_injective", [](auto& c, auto&) { split_first_lower_node(c); }},
    {"cell.pairs_complete", [](auto& c, auto&) { c.lower_to_higher[first_lower(c)] = -1; }},
    {"cell.bounds_nodes",
     [](auto& c, auto&) {
       // One pair alone makes no facet of a bound.
       const std::size_t kept = first_lower(c);
       std::fill(c.lower_to_higher.begin() + static_cast<std::ptrdiff_t>(kept) + 1,
                 c.lower_to_higher.end(), -1);
     }},
    {"cell.bounds_in_full", [](auto& c, auto&) { c.lower_to_higher[first_lower(c)] = -1; }},
    {"full.regions", [](auto&, auto& f) { f.regions[0] = 8; }},
    {"full.regions", [](auto&, auto& f) { f.regions.back() = 8; }},
    {"full.pairs", [](auto&, auto& f) { f.lower_to_higher.assign(f.points.size(), 0); }},
    {"full.copies", [](auto&, auto& f) { f.cell_elements[0] = f.cell_elements[1]; }},
    {"full.copies",
     [](auto&, auto& f) {
       f.elements.resize(f.elements.size() - static_cast<std::size_t>(f.nodes_per_element));
       f.regions.pop_back();
       f.sectors.pop_back();
       f.cell_elements.pop_back();
     }},
    {"cell.fields", [](auto& c, auto&) { c.single_precision = true; }},
};

TEST(VerifySymmetry, EveryFlawIsFound) {
  test::RingShape shape;
  shape.swirl = 0.3;
  for (const SymmetryCellMesh& mesh :
       {test::ring_cell(shape), test::solid_samples().front().cell}) {
    for (const Flaw& flaw : kFlaws) {
      MeshData cell = read(mesh, MeshPart::kCell);
      MeshData full = read(mesh, MeshPart::kFull);
      ASSERT_TRUE(verify_mesh(cell, &full, nullptr, {}).ok());
      flaw.make(cell, full);
      const auto report = verify_mesh(cell, &full, nullptr, {});
      EXPECT_TRUE(fails(report, flaw.check))
          << mesh.dimension << "D " << flaw.check << "; found: " << failures(report);
    }
  }
}

TEST(VerifySymmetry, NodesOnTheAxis) {
  for (const SymmetryCellMesh& mesh :
       {test::disc_cell(5, 2, {0, 0}), test::solid_samples()[4].cell}) {
    MeshData cell = read(mesh, MeshPart::kCell);
    for (std::size_t i = 0; i < cell.points.size(); ++i) {
      if (cell.lower_to_higher[i] != static_cast<std::int32_t>(i)) continue;
      cell.lower_to_higher[i] = -1;
      break;
    }
    EXPECT_TRUE(fails(verify_mesh(cell, nullptr, nullptr, {}), "cell.axis_self"));
  }
}

// Half a turn takes the higher bound to the lower one as well, but only one of them is the lower.
TEST(VerifySymmetry, BothBoundsCalledLower) {
  test::RingShape shape;
  shape.fold = 2;
  MeshData cell = read(test::ring_cell(shape), MeshPart::kCell);
  EXPECT_TRUE(verify_mesh(cell, nullptr, nullptr, {}).ok());
  for (std::size_t i = 0; i < cell.points.size(); ++i) {
    const std::int32_t j = cell.lower_to_higher[i];
    if (j >= 0) cell.lower_to_higher[static_cast<std::size_t>(j)] = static_cast<std::int32_t>(i);
  }
  EXPECT_TRUE(fails(verify_mesh(cell, nullptr, nullptr, {}), "cell.bounds"));
}

// An element from the sector opposite, where no other of the cell is.
TEST(VerifySymmetry, CellsThatFallApart) {
  for (const SymmetryCellMesh& mesh : {test::ring_cell({}), test::solid_samples().front().cell}) {
    const SymmetryCellMesh apart =
        test::with_elements_moved(mesh, 3, [](std::size_t e) { return e == 0; });
    const MeshData cell = read(apart, MeshPart::kCell);
    const MeshData full = read(apart, MeshPart::kFull);
    const auto report = verify_mesh(cell, &full, nullptr, {});
    EXPECT_TRUE(fails(report, "cell.connected")) << failures(report);
    EXPECT_FALSE(fails(report, "full.copies")) << failures(report);
  }
}

// Vertices that miss their images by little move nodes by little; by more, they are others.
TEST(VerifySymmetry, NodesOffTheModel) {
  const MeshData cell = read(test::disc_cell(5, 2, {0, 0}), MeshPart::kCell);
  const auto report_with = [&](double off, std::optional<double> tolerance) {
    Pslg model = test::disc_model(5, 2, {0, 0});
    model.vertices[0].x += off;
    const Model given = model;
    VerifyOptions options;
    options.model_tolerance_rel = tolerance;
    return verify_mesh(cell, nullptr, &given, options);
  };
  EXPECT_TRUE(report_with(1e-7, {}).ok());
  EXPECT_TRUE(fails(report_with(1e-3, {}), "model.vertices"));
  EXPECT_TRUE(report_with(1e-3, 1e-2).ok());
}

// Where attributes took no part in the symmetry, those of the model hold in each sector.
TEST(VerifySymmetry, RegionsThatAreNoCopies) {
  const test::Sample disc{"disc", test::disc_model(4, 2, {0, 0}), test::disc_cell(4, 2, {0, 0})};
  const MeshData cell = read(disc.cell, MeshPart::kCell);
  MeshData full = read(disc.cell, MeshPart::kFull);
  for (std::size_t e = 0; e < full.element_count(); ++e) {
    if (full.sectors[e] == 2) full.regions[e] = 9;
  }
  EXPECT_TRUE(fails(verify_mesh(cell, &full, nullptr, {}), "full.regions"));
  const Model model = disc.model;
  EXPECT_EQ(fails(verify_mesh(cell, &full, &model, {}), "full.regions"),
            disc.model.regions.empty());
}

}  // namespace
}  // namespace symcell
