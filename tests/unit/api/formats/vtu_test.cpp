#include <gtest/gtest.h>

#include "api/formats/vtu_reader.hpp"
#include "core/cell/full_mesh.hpp"
#include "core/cell/quadratic.hpp"
#include "tests/support/sample_cells.hpp"
#include "tests/support/written_mesh.hpp"

namespace symcell {
namespace {

using test::written;

constexpr VtuEncoding kEncodings[] = {VtuEncoding::kAppendedRaw, VtuEncoding::kAppendedZlib,
                                      VtuEncoding::kAscii};

TEST(Vtu, CellReadsBack) {
  for (const test::Sample& sample : test::all_samples()) {
    for (const SymmetryCellMesh& cell : {sample.cell, elevate_to_quadratic(sample.cell)}) {
      for (const VtuEncoding encoding : kEncodings) {
        const auto mesh = read_vtu(written(cell, MeshPart::kCell, MeshFormat::kVtu, {encoding}));
        ASSERT_TRUE(mesh) << sample.name << ": " << mesh.error().message;
        EXPECT_EQ(mesh->fold, cell.fold);
        EXPECT_EQ(mesh->order, cell.order);
        EXPECT_EQ(mesh->axis_origin, cell.axis_origin);
        EXPECT_EQ(mesh->axis_direction, cell.axis_direction);
        EXPECT_EQ(mesh->elements, cell.elements);
        EXPECT_EQ(mesh->regions, cell.regions);
        EXPECT_EQ(mesh->lower_to_higher, cell.lower_to_higher);
        EXPECT_TRUE(mesh->sectors.empty());
        const FullMeshView view(cell);
        for (std::size_t i = 0; i < cell.nodes.size(); ++i) {
          EXPECT_EQ(mesh->points[i], view.cell_node_position(i));
        }
      }
    }
  }
}

TEST(Vtu, FullMeshReadsBackAlikeFromEveryEncoding) {
  for (const test::Sample& sample : test::all_samples()) {
    const FullMeshView view(sample.cell);
    for (const VtuEncoding encoding : kEncodings) {
      const auto mesh =
          read_vtu(written(sample.cell, MeshPart::kFull, MeshFormat::kVtu, {encoding}));
      ASSERT_TRUE(mesh) << sample.name << ": " << mesh.error().message;
      ASSERT_EQ(mesh->points.size(), static_cast<std::size_t>(view.node_count()));
      ASSERT_EQ(mesh->element_count(), static_cast<std::size_t>(view.element_count()));
      for (std::size_t i = 0; i < mesh->points.size(); ++i) {
        EXPECT_EQ(mesh->points[i], view.position(view.node(static_cast<std::int64_t>(i))));
      }
      EXPECT_EQ(mesh->sectors.back(), sample.cell.fold - 1);
      EXPECT_TRUE(mesh->lower_to_higher.empty());
    }
  }
}

TEST(Vtu, TypesAreThoseOfTheInterface) {
  const std::string text =
      written(test::disc_cell(5, 2, {0, 0}), MeshPart::kCell, MeshFormat::kVtu);
  for (const char* element :
       {"type=\"Int64\" Name=\"lower_to_higher\"", "type=\"Int32\" Name=\"marker\"",
        "type=\"Int32\" Name=\"region\"", "type=\"Int32\" Name=\"fold\"",
        "type=\"Float64\" Name=\"axis_origin\" NumberOfComponents=\"3\"",
        "type=\"Float64\" Name=\"axis_direction\" NumberOfComponents=\"3\"",
        "type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\""}) {
    EXPECT_NE(text.find(element), std::string::npos) << element;
  }
}

// Larger than the compressor's blocks, and the block sizes must not matter.
TEST(Vtu, ManyBlocks) {
  const SymmetryCellMesh cell = test::ring_cell({.fold = 50, .steps = 20, .layers = 30});
  const std::string raw = written(cell, MeshPart::kFull, MeshFormat::kVtu);
  const std::string packed =
      written(cell, MeshPart::kFull, MeshFormat::kVtu, {VtuEncoding::kAppendedZlib});
  EXPECT_LT(packed.size(), raw.size() / 2);
  const auto a = read_vtu(raw);
  const auto b = read_vtu(packed);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->elements, b->elements);
  EXPECT_EQ(a->points, b->points);
}

TEST(VtuReader, NoCutFileIsTaken) {
  for (const VtuEncoding encoding : kEncodings) {
    const std::string whole =
        written(test::disc_cell(5, 2, {0, 0}), MeshPart::kCell, MeshFormat::kVtu, {encoding});
    for (std::size_t size = 0; size + 3 < whole.size(); size += 7) {
      EXPECT_FALSE(read_vtu(whole.substr(0, size))) << size;
    }
  }
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(VtuReader, LiesAreTold) {
  const std::string text =
      written(test::disc_cell(5, 2, {0, 0}), MeshPart::kCell, MeshFormat::kVtu);
  const auto code = [](const std::string& bytes) {
    const auto mesh = read_vtu(bytes);
    EXPECT_FALSE(mesh);
    return mesh ? ErrorCode::kInternal : mesh.error().code;
  };
  EXPECT_EQ(code(replaced(text, "NumberOfPoints=\"4\"", "NumberOfPoints=\"2147483647\"")),
            ErrorCode::kCountMismatch);
  EXPECT_EQ(code(replaced(text, "NumberOfPoints=\"4\"", "NumberOfPoints=\"99999999999\"")),
            ErrorCode::kTooLarge);
  EXPECT_EQ(code(replaced(text, "offset=\"0\"", "offset=\"999999999\"")), ErrorCode::kTruncated);
  EXPECT_EQ(code(replaced(text, "\"LittleEndian\"", "\"BigEndian\"")), ErrorCode::kUnknownFormat);
  EXPECT_EQ(code(replaced(text, "Name=\"fold\"", "Name=\"gold\"")), ErrorCode::kMissingField);
  EXPECT_EQ(code(replaced(text, "type=\"UInt8\" Name=\"types\"", "type=\"Int64\" Name=\"types\"")),
            ErrorCode::kCountMismatch);
  EXPECT_EQ(code("<html></html>"), ErrorCode::kUnknownFormat);
  EXPECT_EQ(code("solid"), ErrorCode::kUnknownFormat);
  EXPECT_EQ(code(""), ErrorCode::kEmptyFile);
}

}  // namespace
}  // namespace symcell
