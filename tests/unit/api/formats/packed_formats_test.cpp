// Packed JSON says what JSON says; GLB shows the mesh where it is.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>

#include "core/cell/boundary_faces.hpp"
#include "core/cell/full_mesh.hpp"
#include "core/cell/quadratic.hpp"
#include "tests/support/extruded_cells.hpp"
#include "tests/support/sample_cells.hpp"
#include "tests/support/written_mesh.hpp"

namespace symcell {
namespace {

using Json = nlohmann::ordered_json;
using test::written;

std::vector<SymmetryCellMesh> meshes() {
  test::Extrusion how;
  how.layers = 2;
  how.height = 1.5;
  how.frame.origin = {3, -1, 2};
  std::vector<SymmetryCellMesh> all{test::disc_cell(4, 1, {3, -1}), test::disc_cell(5, 2, {0, 0})};
  const std::size_t planar = all.size();
  for (std::size_t i = 0; i < planar; ++i) all.push_back(test::extruded_cell(all[i], how));
  const std::size_t linear = all.size();
  for (std::size_t i = 0; i < linear; ++i) all.push_back(elevate_to_quadratic(all[i]));
  // Labels that differ between sectors, and do not fit a byte.
  all.push_back(all[1]);
  SymmetryCellMesh& varied = all.back();
  for (std::size_t i = 0; i < varied.element_count() * static_cast<std::size_t>(varied.fold); ++i) {
    varied.sector_regions.push_back(static_cast<std::int32_t>(i) - 3);
  }
  for (std::size_t i = 0; i < varied.facet_count() * static_cast<std::size_t>(varied.fold); ++i) {
    varied.sector_boundary_markers.push_back(300 + static_cast<std::int32_t>(i));
  }
  return all;
}

std::string decode_base64(const std::string& text) {
  const std::string alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int held = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6U | static_cast<std::uint32_t>(alphabet.find(c));
    held += 6;
    if (held < 8) continue;
    held -= 8;
    bytes += static_cast<char>(bits >> static_cast<unsigned>(held) & 0xFFU);
  }
  return bytes;
}

// Any packed array as flat numbers.
std::vector<double> unpack(const Json& array) {
  std::size_t count = 1;
  for (const auto& extent : array["shape"]) count *= extent.get<std::size_t>();
  if (array.contains("value")) return std::vector<double>(count, array["value"].get<double>());
  const std::string bytes = decode_base64(array["data"].get<std::string>());
  const std::string type = array["type"];
  const std::size_t size = type == "float64" || type == "int64" ? 8
                           : type.ends_with("32")               ? 4
                           : type == "uint24"                   ? 3
                           : type == "uint16"                   ? 2
                                                                : 1;
  EXPECT_EQ(bytes.size(), size * count);
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) {
    const char* at = bytes.data() + i * size;
    if (type == "float32") {
      float value = 0;
      std::memcpy(&value, at, size);
      values.push_back(double{value});
    } else if (type == "float64") {
      double value = 0;
      std::memcpy(&value, at, size);
      values.push_back(value);
    } else if (type == "int32") {
      std::int32_t value = 0;
      std::memcpy(&value, at, size);
      values.push_back(value);
    } else {
      std::uint64_t value = 0;
      std::memcpy(&value, at, size);
      values.push_back(static_cast<double>(value));
    }
  }
  return values;
}

void flatten(const Json& json, std::vector<double>& values) {
  if (json.is_array()) {
    for (const Json& part : json) flatten(part, values);
  } else {
    values.push_back(json.get<double>());
  }
}
std::vector<double> flat(const Json& json) {
  std::vector<double> values;
  flatten(json, values);
  return values;
}

TEST(PackedJson, SaysWhatJsonSays) {
  WriteOptions exact;
  exact.packed = PackedReals::kFloat64;
  for (const SymmetryCellMesh& cell : meshes()) {
    for (const MeshPart part : {MeshPart::kCell, MeshPart::kFull}) {
      const Json text = Json::parse(written(cell, part, MeshFormat::kJson));
      const Json packed = Json::parse(written(cell, part, MeshFormat::kJson, exact));
      for (const char* name : {"dimension", "order", "fold", "axis"}) {
        EXPECT_EQ(packed[name], text[name]) << name;
      }
      for (const char* name : {"nodes", "elements", "regions", "markers", "lower", "higher",
                               "lower_facets", "higher_facets"}) {
        EXPECT_EQ(unpack(packed[name]), flat(text[name])) << name;
      }
      std::vector<double> nodes, markers;
      for (const Json& facet : text["boundary"]) {
        flatten(facet["nodes"], nodes);
        markers.push_back(facet["marker"].get<double>());
      }
      EXPECT_EQ(unpack(packed["boundary"]), nodes);
      EXPECT_EQ(unpack(packed["boundary_markers"]), markers);
      if (part == MeshPart::kFull) {
        EXPECT_EQ(packed["cell_elements"], cell.element_count());
      }
    }
  }
}

TEST(PackedJson, SinglePrecisionCountsFromTheAxis) {
  WriteOptions single;
  single.packed = PackedReals::kFloat32;
  for (const SymmetryCellMesh& cell : meshes()) {
    const Json text = Json::parse(written(cell, MeshPart::kCell, MeshFormat::kJson));
    const Json packed = Json::parse(written(cell, MeshPart::kCell, MeshFormat::kJson, single));
    const std::vector<double> from = flat(packed["origin"]), near = unpack(packed["nodes"]);
    const std::vector<double> right = flat(text["nodes"]);
    ASSERT_EQ(near.size(), right.size());
    for (std::size_t i = 0; i < right.size(); ++i) {
      EXPECT_NEAR(near[i] + from[i % from.size()], right[i], 1e-6);
    }
    EXPECT_EQ(unpack(packed["elements"]), flat(text["elements"]));
  }
}

// As much of a GLB as is needed to measure what it shows.
class Picture {
 public:
  explicit Picture(const std::string& glb) {
    const std::uint32_t length = number(glb, 12);
    json_ = Json::parse(glb.substr(20, length));
    binary_ = glb.substr(28 + length);
    EXPECT_EQ(number(glb, 20 + length), binary_.size());
  }

  [[nodiscard]] const Json& json() const { return json_; }

  // Sum of the areas of the triangles that `mesh` shows in materials that `counts` takes.
  template <class F>
  double area(std::size_t mesh, F counts) const {
    double sum = 0;
    for (const Json& primitive : json_["meshes"][mesh]["primitives"]) {
      if (primitive["mode"] != 4) continue;
      if (!counts(json_["materials"][primitive["material"].get<std::size_t>()]["name"])) continue;
      const std::size_t positions = offset(primitive["attributes"]["POSITION"]);
      const std::size_t indices = offset(primitive["indices"]);
      const auto count = json_["accessors"][primitive["indices"].get<std::size_t>()]["count"];
      for (std::size_t i = 0; i < count; i += 3) {
        std::array<Point3, 3> p;
        for (std::size_t c = 0; c < 3; ++c) {
          const std::size_t at = positions + 12 * number(binary_, indices + 4 * (i + c));
          p[c] = {real(at), real(at + 4), real(at + 8)};
        }
        sum += length(cross(p[1] - p[0], p[2] - p[0])) / 2;
      }
    }
    return sum;
  }

 private:
  static std::uint32_t number(const std::string& bytes, std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
  }
  [[nodiscard]] double real(std::size_t at) const {
    float value = 0;
    std::memcpy(&value, binary_.data() + at, sizeof value);
    return double{value};
  }
  [[nodiscard]] std::size_t offset(const Json& accessor) const {
    const auto view = json_["accessors"][accessor.get<std::size_t>()]["bufferView"];
    return json_["bufferViews"][view.get<std::size_t>()]["byteOffset"];
  }

  Json json_;
  std::string binary_;
};

double face_area(const SymmetryCellMesh& cell, bool outer_only) {
  const FullMeshView view(cell);
  const auto triangle = [&](const std::int32_t* nodes) {
    std::array<Point3, 3> p;
    for (std::size_t i = 0; i < 3; ++i) {
      p[i] = view.cell_node_position(static_cast<std::size_t>(nodes[i]));
    }
    return length(cross(p[1] - p[0], p[2] - p[0])) / 2;
  };
  double sum = 0;
  if (cell.dimension == 2) {
    for (std::size_t e = 0; e < cell.element_count(); ++e) {
      sum += triangle(&cell.elements[e * static_cast<std::size_t>(cell.nodes_per_element)]);
    }
    return sum;
  }
  for (const BoundaryFace& face : boundary_faces(cell)) {
    if (face.outer || !outer_only) sum += triangle(face.corners.data());
  }
  return sum;
}

TEST(Glb, ShowsTheSurfaceOfTheCellAndOfTheFullMesh) {
  const auto any = [](const std::string&) { return true; };
  const auto bound = [](const std::string& name) { return name.ends_with("bound"); };
  for (const SymmetryCellMesh& cell : meshes()) {
    const Picture one(written(cell, MeshPart::kCell, MeshFormat::kGlb));
    EXPECT_NEAR(one.area(0, any), face_area(cell, false), 1e-5);
    const Picture all(written(cell, MeshPart::kFull, MeshFormat::kGlb));
    EXPECT_NEAR(all.area(0, any), face_area(cell, true), 1e-5);
    EXPECT_EQ(all.area(0, bound), 0);
    if (cell.dimension == 3) {
      EXPECT_NEAR(one.area(0, any) - one.area(0, bound), face_area(cell, true), 1e-5);
    }
    // The root, the axis and a node a sector; one mesh, unless sectors differ.
    EXPECT_EQ(all.json()["nodes"].size(), 2 + static_cast<std::size_t>(cell.fold));
    EXPECT_EQ(all.json()["meshes"].size(),
              cell.sector_regions.empty() ? 1U : static_cast<std::size_t>(cell.fold));
  }
}

TEST(Glb, OfThousandsOfSectorsIsSmall) {
  test::RingShape shape;
  shape.fold = 30'000;
  const SymmetryCellMesh cell = test::extruded_cell(test::ring_cell(shape), {});
  const std::string glb = written(cell, MeshPart::kFull, MeshFormat::kGlb);
  EXPECT_LT(glb.size(), 5'000'000U);
}

}  // namespace
}  // namespace symcell
