#include "api/formats/cell_archive.hpp"

#include <gtest/gtest.h>

#include "core/cell/quadratic.hpp"
#include "tests/support/sample_cells.hpp"

namespace symcell {
namespace {

std::string archive(const SymmetryCellMesh& cell) {
  std::string bytes;
  const auto written = write_cell_archive(cell, [&](std::string_view piece) {
    bytes += piece;
    return true;
  });
  EXPECT_TRUE(written);
  return bytes;
}

void expect_equal(const SymmetryCellMesh& a, const SymmetryCellMesh& b) {
  EXPECT_EQ(a.dimension, b.dimension);
  EXPECT_EQ(a.order, b.order);
  EXPECT_EQ(a.fold, b.fold);
  EXPECT_EQ(a.axis_origin, b.axis_origin);
  EXPECT_EQ(a.frame, b.frame);
  EXPECT_EQ(a.orbit_points, b.orbit_points);
  EXPECT_EQ(a.on_axis, b.on_axis);
  EXPECT_EQ(a.nodes, b.nodes);
  EXPECT_EQ(a.node_markers, b.node_markers);
  EXPECT_EQ(a.elements, b.elements);
  EXPECT_EQ(a.regions, b.regions);
  EXPECT_EQ(a.boundary, b.boundary);
  EXPECT_EQ(a.boundary_markers, b.boundary_markers);
  EXPECT_EQ(a.boundary_is_higher_image, b.boundary_is_higher_image);
  EXPECT_EQ(a.lower_facets, b.lower_facets);
  EXPECT_EQ(a.higher_facets, b.higher_facets);
  EXPECT_EQ(a.lower_to_higher, b.lower_to_higher);
  EXPECT_EQ(a.sector_regions, b.sector_regions);
  EXPECT_EQ(a.sector_boundary_markers, b.sector_boundary_markers);
}

TEST(CellArchive, ReadsBackWhatItWrote) {
  for (const test::Sample& sample : test::all_samples()) {
    SymmetryCellMesh cell = sample.cell;
    cell.sector_regions.assign(cell.element_count() * static_cast<std::size_t>(cell.fold), 3);
    for (const SymmetryCellMesh& mesh : {cell, elevate_to_quadratic(sample.cell)}) {
      const auto back = read_cell_archive(archive(mesh));
      ASSERT_TRUE(back) << sample.name << ": " << back.error().message;
      expect_equal(*back, mesh);
    }
  }
}

TEST(CellArchive, CutsAreTold) {
  const std::string bytes = archive(test::disc_cell(5, 2, {0, 0}));
  for (std::size_t size = 8; size < bytes.size(); ++size) {
    const auto cell = read_cell_archive(bytes.substr(0, size));
    ASSERT_FALSE(cell) << size;
    EXPECT_EQ(cell.error().code, ErrorCode::kTruncated) << size;
  }
  EXPECT_EQ(read_cell_archive("").error().code, ErrorCode::kUnknownFormat);
  EXPECT_EQ(read_cell_archive("SYMCELL\x02 and so on").error().code, ErrorCode::kUnknownFormat);
}

TEST(CellArchive, NoFlippedBitIsTaken) {
  const std::string bytes = archive(test::disc_cell(5, 2, {0, 0}));
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x10);
    EXPECT_FALSE(read_cell_archive(damaged)) << i;
  }
}

TEST(CellArchive, IndicesAreChecked) {
  SymmetryCellMesh cell = test::disc_cell(5, 2, {0, 0});
  cell.elements[4] = 1000;
  EXPECT_EQ(read_cell_archive(archive(cell)).error().code, ErrorCode::kSyntax);
  cell = test::disc_cell(5, 2, {0, 0});
  cell.nodes[1].exponent = 5;
  EXPECT_EQ(read_cell_archive(archive(cell)).error().code, ErrorCode::kSyntax);
  cell = test::disc_cell(5, 2, {0, 0});
  cell.regions.pop_back();
  EXPECT_EQ(read_cell_archive(archive(cell)).error().code, ErrorCode::kSyntax);
}

TEST(CellArchive, KeepsTheNamesOfMarkers) {
  SymmetryCellMesh cell = test::square_cell();
  cell.marker_names = {{1, "outer rim"}, {-7, ""}, {12, "K\xc3\xbchlung"}};
  const auto back = read_cell_archive(archive(cell));
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->marker_names, cell.marker_names);
}

}  // namespace
}  // namespace symcell
