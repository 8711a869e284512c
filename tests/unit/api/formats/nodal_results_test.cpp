// Vectors of a cell on the full mesh: a wave that is known everywhere comes back everywhere.
#include "api/formats/nodal_results.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "api/formats/vtu_reader.hpp"
#include "core/cell/full_mesh.hpp"
#include "tests/support/extruded_cells.hpp"
#include "tests/support/sample_cells.hpp"

namespace symcell {
namespace {

constexpr double kPi = std::numbers::pi;

SymmetryCellMesh solid_cell(std::int32_t fold) {
  test::Extrusion how;
  how.layers = 2;
  how.height = 1.5;
  how.frame = AxisFrame::of_axis({3, -1, 2}, {1, 2, 2});
  return test::extruded_cell(test::disc_cell(fold, 1, {0, 0}), how);
}

// In cylinder coordinates about the axis all components go with exp(i k phi): a wave of k diameters.
struct Wave {
  Point3 real, imaginary;
};
Wave wave_at(const SymmetryCellMesh& cell, Point3 p, std::int32_t k) {
  const auto& m = cell.frame;
  const Point3 d = p - cell.axis_origin;
  const Point3 q{m[0] * d.x + m[3] * d.y + m[6] * d.z, m[1] * d.x + m[4] * d.y + m[7] * d.z,
                 m[2] * d.x + m[5] * d.y + m[8] * d.z};
  const double r = std::hypot(q.x, q.y), phi = std::atan2(q.y, q.x);
  const Point3 radial{std::cos(phi), std::sin(phi), 0}, round{-std::sin(phi), std::cos(phi), 0};
  // Nothing on the axis, where directions have no meaning.
  const Point3 real = r * radial + (0.3 * r * q.z) * round, imaginary{0, 0, r * r};
  const double c = std::cos(k * phi), s = std::sin(k * phi);
  const auto to_model = [&](Point3 v) {
    return Point3{m[0] * v.x + m[1] * v.y + m[2] * v.z, m[3] * v.x + m[4] * v.y + m[5] * v.z,
                  m[6] * v.x + m[7] * v.y + m[8] * v.z};
  };
  return {to_model(c * real - s * imaginary), to_model(s * real + c * imaginary)};
}

NodalResult of_cell(const SymmetryCellMesh& cell, std::int32_t k) {
  NodalResult result;
  const FullMeshView view(cell);
  for (std::size_t i = 0; i < cell.nodes.size(); ++i) {
    const Wave w = wave_at(cell, view.cell_node_position(i), k);
    result.real.push_back(w.real);
    result.imaginary.push_back(w.imaginary);
  }
  return result;
}

std::string full_of(const SymmetryCellMesh& cell,
                    const NodalResult& result,
                    std::int32_t k,
                    double phase) {
  std::string text;
  EXPECT_TRUE(write_full_result(cell, result, k, phase, "displacement", VtuEncoding::kAppendedRaw,
                                [&](std::string_view piece) {
                                  text += piece;
                                  return true;
                                }));
  return text;
}

TEST(NodalResults, AWaveComesBackOnTheFullMesh) {
  for (const std::int32_t fold : {2, 5, 8}) {
    const SymmetryCellMesh cell = solid_cell(fold);
    for (std::int32_t k = -fold / 2; k <= fold / 2; ++k) {
      const NodalResult result = of_cell(cell, k);
      const NodalDiameter found = find_nodal_diameter(cell, result, std::nullopt);
      EXPECT_LT(found.mismatch, 1e-12);
      // Half the fold either way is the same.
      if (2 * std::abs(k) != fold) {
        EXPECT_EQ(found.signed_diameter, k) << fold;
      }
      for (const double phase : {0.0, 1.0}) {
        const std::string text = full_of(cell, result, found.signed_diameter, phase);
        const auto mesh = read_vtu(text);
        const auto vectors = read_vtu_vectors(text, "displacement");
        ASSERT_TRUE(mesh && vectors);
        ASSERT_EQ(vectors->size(), mesh->points.size());
        for (std::size_t i = 0; i < vectors->size(); ++i) {
          const Wave w = wave_at(cell, mesh->points[i], k);
          const Point3 wanted = std::cos(phase) * w.real - std::sin(phase) * w.imaginary;
          EXPECT_LT(distance((*vectors)[i], wanted), 1e-9) << fold << ", " << k;
        }
      }
    }
  }
}

TEST(NodalResults, AnotherNodalDiameterDoesNotFit) {
  const SymmetryCellMesh cell = solid_cell(8);
  EXPECT_GT(find_nodal_diameter(cell, of_cell(cell, 2), 3).mismatch, 0.1);
  NodalResult real = of_cell(cell, 2);
  real.imaginary.clear();
  EXPECT_GT(find_nodal_diameter(cell, real, 2).mismatch, 0.1);
}

TEST(NodalResults, FrdPairsRealAndImaginaryParts) {
  const std::string head =
      "    1C\n    1PHID                          2\n"
      "  100CL  101 1.25000E+02           2                     2    1MODAL      1\n";
  const auto block = [](const char* name) {
    return std::string(" -4  ") + name +
           "        4    1\n -5  D1          1    2    1    0\n -5  D2          1    2    2    0\n"
           " -5  D3          1    2    3    0\n -5  ALL         1    2    0    0    1ALL\n"
           " -1         1 1.00000E+00-2.00000E+00 3.00000E-01\n"
           " -1         2-1.00000E+00 2.50000E+00 4.00000E+02\n -3\n";
  };
  const auto results =
      read_frd(head + block("DISP ") + head + block("DISPI") + head + block("DISP "), 2);
  ASSERT_TRUE(results) << results.error().message;
  ASSERT_EQ(results->size(), 2U);
  EXPECT_EQ(results->at(0).nodal_diameter, 2);
  EXPECT_EQ(results->at(0).value, 125);
  EXPECT_EQ(results->at(0).real.at(1), (Point3{-1, 2.5, 400}));
  EXPECT_EQ(results->at(0).imaginary.size(), 2U);
  EXPECT_TRUE(results->at(1).imaginary.empty());
  EXPECT_EQ(read_frd(head + block("DISP "), 3).error().code, ErrorCode::kCountMismatch);
  EXPECT_EQ(read_frd(head + block("DISP "), 1).error().code, ErrorCode::kCountMismatch);
  EXPECT_EQ(read_frd(head, 2).error().code, ErrorCode::kSyntax);
  EXPECT_EQ(read_frd("", 2).error().code, ErrorCode::kSyntax);
}

TEST(NodalResults, FrdWithOtherNodesOrNumbersIsRefused) {
  const auto refused = [](const std::string& nodes, const char* why) {
    const auto results = read_frd(
        " -4  DISP        4    1\n -5  D1\n -5  D2\n -5  D3\n -5  ALL\n" + nodes + " -3\n", 2);
    ASSERT_FALSE(results) << nodes;
    EXPECT_NE(results.error().message.find(why), std::string::npos) << results.error().message;
    EXPECT_NE(results.error().message.find("line "), std::string::npos) << results.error().message;
  };
  const std::string first = " -1         1 1.00000E+00-2.00000E+00 3.00000E-01\n";
  // As many as there are, but one of them twice.
  refused(first + first, "node 1 stands here for the second time");
  refused(first, "DISP has 1 nodes");
  refused(first + " -1         2         NaN 2.50000E+00 4.00000E+02\n", "node 2");
  refused(first + " -1         2 1.00000E+00    Infinity 4.00000E+02\n", "node 2");
  refused(first + " -1         2 1.00000E+00-2.00000E+00        -inf\n", "node 2");
}

TEST(NodalResults, VtuWithNumbersThatAreNoneIsRefused) {
  const auto file = [](const std::string& numbers) {
    return "<?xml version=\"1.0\"?><VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
           "byte_order=\"LittleEndian\"><UnstructuredGrid><Piece NumberOfPoints=\"2\" "
           "NumberOfCells=\"0\"><PointData><DataArray type=\"Float64\" Name=\"U\" "
           "NumberOfComponents=\"3\" format=\"ascii\">" +
           numbers + "</DataArray></PointData></Piece></UnstructuredGrid></VTKFile>";
  };
  ASSERT_TRUE(read_vtu_result(file("1 2 3 4 5 6"), 2, "U", ""));
  for (const char* numbers : {"1 2 3 4 nan 6", "1 2 3 4 5 inf", "1 2 3 -inf 5 6"}) {
    const auto result = read_vtu_result(file(numbers), 2, "U", "");
    ASSERT_FALSE(result) << numbers;
    EXPECT_EQ(result.error().code, ErrorCode::kNonFinite) << result.error().message;
    EXPECT_NE(result.error().message.find("node 1"), std::string::npos) << result.error().message;
  }
}

}  // namespace
}  // namespace symcell
