// Every format on hand-made cells of solids.
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "api/formats/cell_archive.hpp"
#include "api/formats/stl.hpp"
#include "api/formats/vtu_reader.hpp"
#include "core/cell/boundary_faces.hpp"
#include "core/cell/full_mesh.hpp"
#include "core/cell/measure_cell.hpp"
#include "core/cell/quadratic.hpp"
#include "core/solid/surface/clean_surface.hpp"
#include "tests/support/extruded_cells.hpp"
#include "tests/support/sample_cells.hpp"
#include "tests/support/written_mesh.hpp"

namespace symcell {
namespace {

using Json = nlohmann::json;
using test::written;

std::vector<SymmetryCellMesh> meshes() {
  std::vector<SymmetryCellMesh> all;
  for (const test::SolidSample& sample : test::solid_samples()) {
    all.push_back(sample.cell);
    all.push_back(elevate_to_quadratic(sample.cell));
  }
  return all;
}

TEST(SolidVtu, ReadsBack) {
  for (const SymmetryCellMesh& cell : meshes()) {
    const FullMeshView view(cell);
    for (const VtuEncoding encoding :
         {VtuEncoding::kAppendedRaw, VtuEncoding::kAppendedZlib, VtuEncoding::kAscii}) {
      const auto mesh = read_vtu(written(cell, MeshPart::kCell, MeshFormat::kVtu, {encoding}));
      ASSERT_TRUE(mesh) << mesh.error().message;
      EXPECT_EQ(mesh->dimension, 3);
      EXPECT_EQ(mesh->order, cell.order);
      EXPECT_EQ(mesh->axis_origin, cell.axis_origin);
      EXPECT_EQ(mesh->axis_direction, cell.axis_direction);
      EXPECT_EQ(mesh->elements, cell.elements);
      EXPECT_EQ(mesh->regions, cell.regions);
      EXPECT_EQ(mesh->lower_to_higher, cell.lower_to_higher);
      for (std::size_t i = 0; i < cell.nodes.size(); ++i) {
        EXPECT_EQ(mesh->points[i], view.cell_node_position(i));
      }
      const auto full = read_vtu(written(cell, MeshPart::kFull, MeshFormat::kVtu, {encoding}));
      ASSERT_TRUE(full) << full.error().message;
      ASSERT_EQ(full->points.size(), static_cast<std::size_t>(view.node_count()));
      EXPECT_EQ(full->element_count(), static_cast<std::size_t>(view.element_count()));
    }
  }
}

TEST(SolidJson, HasPointsOfSpace) {
  for (const SymmetryCellMesh& cell : meshes()) {
    const FullMeshView view(cell);
    const Json json = Json::parse(written(cell, MeshPart::kCell, MeshFormat::kJson));
    EXPECT_EQ(json["dimension"], 3);
    ASSERT_EQ(json["nodes"].size(), cell.nodes.size());
    const Point3 p = view.cell_node_position(cell.nodes.size() - 1);
    EXPECT_EQ(json["nodes"].back(), Json({p.x, p.y, p.z}));
    EXPECT_EQ(json["elements"][0].size(), cell.order == 1 ? 4U : 10U);
    EXPECT_EQ(json["boundary"][0]["nodes"].size(), cell.order == 1 ? 3U : 6U);
    EXPECT_EQ(json["lower"].size(), json["higher"].size());
    const Json full = Json::parse(written(cell, MeshPart::kFull, MeshFormat::kJson));
    EXPECT_EQ(full["nodes"].size(), static_cast<std::size_t>(view.node_count()));
    EXPECT_EQ(full["elements"].size(), static_cast<std::size_t>(view.element_count()));
    EXPECT_EQ(full["boundary"].size(), cell.facet_count() * static_cast<std::size_t>(cell.fold));
  }
}

TEST(SolidJson, RegionsAndMarkersMayDifferBetweenSectors) {
  test::Extrusion one;
  one.layers = 1;
  SymmetryCellMesh cell = test::extruded_cell(test::disc_cell(3, 1, {0, 0}), one);
  for (std::int32_t i = 0; i < 9; ++i) cell.sector_regions.push_back(100 + i);
  for (std::size_t b = 0; b < cell.facet_count(); ++b) {
    for (std::int32_t s = 0; s < 3; ++s) {
      cell.sector_boundary_markers.push_back(10 * static_cast<std::int32_t>(b) + s);
    }
  }
  const Json json = Json::parse(written(cell, MeshPart::kFull, MeshFormat::kJson));
  EXPECT_EQ(json["regions"], Json({100, 103, 106, 101, 104, 107, 102, 105, 108}));
  EXPECT_EQ(json["boundary"][cell.facet_count() + 1]["marker"], 11);
  const std::string msh = written(cell, MeshPart::kFull, MeshFormat::kMsh);
  EXPECT_NE(msh.find("\"region_108\""), std::string::npos);
}

TEST(SolidMsh, PeriodicMapTakesLowerToHigherAboutAnyAxis) {
  for (const SymmetryCellMesh& cell : meshes()) {
    if (cell.fold == 1) continue;
    const std::string text = written(cell, MeshPart::kCell, MeshFormat::kMsh);
    std::istringstream in(text.substr(text.find("$Periodic\n") + 10));
    int links = 0, dimension = 0, slave = 0, master = 0, size = 0;
    in >> links >> dimension >> slave >> master >> size;
    EXPECT_EQ(links, 1);
    EXPECT_EQ(dimension, 2);
    ASSERT_EQ(size, 16);
    double map[16];
    for (double& entry : map) in >> entry;
    std::size_t pairs = 0;
    in >> pairs;
    ASSERT_GT(pairs, 0U);
    const FullMeshView view(cell);
    const double tolerance = 1e-15 * (1 + length(cell.axis_origin)) * 16;
    for (std::size_t i = 0; i < pairs; ++i) {
      std::size_t higher = 0, lower = 0;
      in >> higher >> lower;
      const Point3 p = view.cell_node_position(lower - 1);
      const Point3 q = view.cell_node_position(higher - 1);
      EXPECT_NEAR(map[0] * p.x + map[1] * p.y + map[2] * p.z + map[3], q.x, tolerance);
      EXPECT_NEAR(map[4] * p.x + map[5] * p.y + map[6] * p.z + map[7], q.y, tolerance);
      EXPECT_NEAR(map[8] * p.x + map[9] * p.y + map[10] * p.z + map[11], q.z, tolerance);
    }
  }
}

// A line of an element block begins with the tag; the block of type 11 has Gmsh's order.
TEST(SolidMsh, QuadraticElementsHaveGmshsOrder) {
  const SymmetryCellMesh cell = elevate_to_quadratic(test::solid_samples().front().cell);
  std::istringstream in(written(cell, MeshPart::kCell, MeshFormat::kMsh));
  std::string line;
  const std::string block = " 11 " + std::to_string(cell.element_count());
  while (std::getline(in, line) && !line.ends_with(block)) continue;
  std::size_t tag = 0;
  in >> tag;
  for (const std::size_t i : {0, 1, 2, 3, 4, 5, 6, 7, 9, 8}) {
    std::int32_t node = 0;
    in >> node;
    EXPECT_EQ(node, cell.elements[i] + 1);
  }
}

struct Stl {
  std::vector<std::array<float, 12>> triangles;  // normal and corners
};

Stl read_binary(const std::string& bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, 4);
  EXPECT_EQ(bytes.size(), 84 + 50 * std::size_t{count});
  Stl stl;
  stl.triangles.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::memcpy(&stl.triangles[i], bytes.data() + 84 + 50 * i, 48);
  }
  return stl;
}

double enclosed(const Stl& stl, Point3 origin) {
  double six = 0;
  for (const auto& t : stl.triangles) {
    const auto corner = [&](std::size_t i) {
      return Point3{t[3 * i], t[3 * i + 1], t[3 * i + 2]} - origin;
    };
    const Point3 n = cross(corner(2) - corner(1), corner(3) - corner(1));
    EXPECT_NEAR(dot(Point3{t[0], t[1], t[2]}, n), length(n), 2e-2 * length(n));
    six += dot(cross(corner(1), corner(2)), corner(3));
  }
  return six / 6;
}

TEST(Stl, CellHasBothBoundsAndTheFullMeshNone) {
  for (const test::SolidSample& sample : test::solid_samples()) {
    const SymmetryCellMesh& cell = sample.cell;
    const auto n = static_cast<std::size_t>(cell.fold);
    std::size_t inside = 0;
    for (const std::int32_t m : cell.boundary_markers) inside += m == test::kPlateMarker ? 1 : 0;
    const std::size_t outer = cell.facet_count() - inside;
    const std::string part = written(cell, MeshPart::kCell, MeshFormat::kStl);
    EXPECT_FALSE(part.starts_with("solid"));
    const Stl of_cell = read_binary(part);
    EXPECT_EQ(of_cell.triangles.size(), outer + 2 * cell.lower_facets.size() / 3);
    const Stl of_full = read_binary(written(cell, MeshPart::kFull, MeshFormat::kStl));
    EXPECT_EQ(of_full.triangles.size(), outer * n);
    // Single precision, relative to the distance from the origin.
    const double rounding = 1e-6 * (1 + length(cell.axis_origin));
    EXPECT_NEAR(enclosed(of_cell, cell.axis_origin) * cell.fold, sample.volume,
                rounding * 20 * cell.fold);
    EXPECT_NEAR(enclosed(of_full, cell.axis_origin), sample.volume, rounding * 20);
  }
}

TEST(Stl, AsciiKeepsAllDigits) {
  const test::SolidSample sample = test::solid_samples().back();
  std::istringstream in(
      written(sample.cell, MeshPart::kFull, MeshFormat::kStl, {VtuEncoding::kAscii}));
  const FullMeshView view(sample.cell);
  std::set<std::array<double, 3>> nodes;
  for (std::int64_t i = 0; i < view.node_count(); ++i) {
    const Point3 p = view.position(view.node(i));
    nodes.insert({p.x, p.y, p.z});
  }
  std::string word;
  std::size_t vertices = 0;
  in >> word;
  EXPECT_EQ(word, "solid");
  while (in >> word) {
    if (word != "vertex") continue;
    std::array<double, 3> p{};
    in >> p[0] >> p[1] >> p[2];
    EXPECT_TRUE(nodes.contains(p));
    ++vertices;
  }
  EXPECT_EQ(vertices, std::size_t{9} * sample.cell.facet_count());
}

// What we write is a model that we would take.
TEST(Stl, IsClosedAndNeedsNoRepair) {
  for (const test::SolidSample& sample : test::solid_samples()) {
    for (const MeshPart part : {MeshPart::kCell, MeshPart::kFull}) {
      for (const bool ascii : {true, false}) {
        const auto surface =
            read_stl(written(sample.cell, part, MeshFormat::kStl,
                             {ascii ? VtuEncoding::kAscii : VtuEncoding::kAppendedRaw}));
        ASSERT_TRUE(surface) << surface.error().message;
        ExecutionContext context;
        const auto clean = solid::clean_surface(*surface, context);
        ASSERT_TRUE(clean) << clean.error().message;
        EXPECT_FALSE(clean->problem) << sample.name << ": " << clean->problem->message;
        EXPECT_TRUE(clean->repairs.empty()) << sample.name << ": " << clean->repairs.front();
        const double copies = part == MeshPart::kCell ? sample.cell.fold : 1;
        EXPECT_NEAR(clean->volume * copies, sample.volume, 1e-3 * sample.volume);
      }
    }
  }
}

TEST(SolidFormats, PicturesAndPlanarStlAreRefused) {
  const auto refused = [](const SymmetryCellMesh& cell, MeshFormat format) {
    const auto done = write_mesh(cell, MeshPart::kCell, format, {}, [](std::string_view) {
      ADD_FAILURE() << "nothing is written";
      return true;
    });
    EXPECT_FALSE(done);
    return done ? ErrorCode::kInternal : done.error().code;
  };
  EXPECT_EQ(refused(test::solid_samples().front().cell, MeshFormat::kSvg),
            ErrorCode::kUnsupportedModel);
  EXPECT_EQ(refused(test::square_cell(), MeshFormat::kStl), ErrorCode::kUnsupportedModel);
}

TEST(SolidFormats, ArchiveReadsBack) {
  for (const SymmetryCellMesh& mesh : meshes()) {
    std::string bytes;
    ASSERT_TRUE(write_cell_archive(mesh, [&](std::string_view piece) {
      bytes += piece;
      return true;
    }));
    EXPECT_EQ(cell_archive_dimension(bytes).value(), 3);
    const auto back = read_cell_archive(bytes);
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->frame, mesh.frame);
    for (const MeshPart part : {MeshPart::kCell, MeshPart::kFull}) {
      for (const MeshFormat format :
           {MeshFormat::kJson, MeshFormat::kMsh, MeshFormat::kInp, MeshFormat::kStl}) {
        EXPECT_EQ(written(*back, part, format), written(mesh, part, format));
      }
    }
  }
}

// Over a million tetrahedra from a cell of 36: as arrays they would take 17 MB.
TEST(SolidFormats, FullMeshesTakeNoMemory) {
  test::RingShape shape;
  shape.fold = 30'000;
  const SymmetryCellMesh cell = test::extruded_cell(test::ring_cell(shape), {});
  const std::uint64_t before = peak_memory_bytes();
  for (const MeshFormat format :
       {MeshFormat::kJson, MeshFormat::kVtu, MeshFormat::kMsh, MeshFormat::kMsh2, MeshFormat::kInp,
        MeshFormat::kBdf, MeshFormat::kCdb, MeshFormat::kVtp, MeshFormat::kStl}) {
    std::uint64_t bytes = 0;
    ASSERT_TRUE(write_mesh(cell, MeshPart::kFull, format, {}, [&](std::string_view piece) {
      bytes += piece.size();
      return true;
    }));
    EXPECT_GT(bytes, 10'000'000U);
  }
  EXPECT_LT(peak_memory_bytes() - before, 8U << 20);
}

TEST(SolidFormats, StopWithTheirReceiver) {
  test::RingShape shape;
  shape.fold = 2000;
  const SymmetryCellMesh cell = test::extruded_cell(test::ring_cell(shape), {});
  for (const MeshFormat format :
       {MeshFormat::kJson, MeshFormat::kVtu, MeshFormat::kMsh, MeshFormat::kMsh2, MeshFormat::kInp,
        MeshFormat::kBdf, MeshFormat::kCdb, MeshFormat::kVtp, MeshFormat::kStl}) {
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
