// STEP and IGES files that tests/cad/make_cad_parts.cpp writes, and damaged ones.
#include "api/formats/cad.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>
#include <string>

#include "api/formats/model_reader.hpp"
#include "api/schema/statistics_json.hpp"
#include "core/cell/full_mesh.hpp"
#include "core/mesh_model.hpp"
#include "tests/support/test_files.hpp"

namespace symcell {
namespace {

using Json = nlohmann::ordered_json;
constexpr double kPi = std::numbers::pi;

std::string part(const std::string& name) {
  return test::read_file(std::string(SYMCELL_BINARY_DIR) + "/tests/cad/parts/" + name);
}

class Cad : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    ::setenv("SYMCELL_CAD_MODULE", SYMCELL_BINARY_DIR "/symcell_cad.so", 1);
  }

  static TriangleSurface read(const std::string& name) {
    auto model = read_model(part(name), std::nullopt);
    EXPECT_TRUE(model) << name << ": " << (model ? "" : model.error().message);
    return model ? std::get<TriangleSurface>(std::move(*model)) : TriangleSurface{};
  }

  static Json inspected(const std::string& name) {
    ExecutionContext context;
    const auto found = inspect_model(read(name), {}, context);
    EXPECT_TRUE(found) << name << ": " << (found ? "" : found.error().message);
    return found ? inspection_to_json(*found) : Json();
  }

  static std::string replaced(std::string text, const std::string& what, const std::string& by) {
    for (std::size_t at = text.find(what); at != std::string::npos;
         at = text.find(what, at + by.size())) {
      text.replace(at, what.size(), by);
    }
    return text;
  }
};

double volume_of(const TriangleSurface& s) {
  double six = 0;
  for (const auto& [a, b, c] : s.triangles) {
    const auto at = [&](std::int32_t i) { return s.vertices[static_cast<std::size_t>(i)]; };
    six += dot(at(a), cross(at(b), at(c)));
  }
  return six / 6;
}

// Every edge once each way: vertices are shared, and all triangles look outwards.
bool is_closed(const TriangleSurface& s) {
  std::set<std::pair<std::int32_t, std::int32_t>> edges;
  for (const auto& t : s.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (!edges.insert({t[i], t[(i + 1) % 3]}).second) return false;
    }
  }
  return std::all_of(edges.begin(), edges.end(), [&](const auto& e) {
    return edges.contains({e.second, e.first});
  });
}

std::set<std::string> warnings_of(const Json& document) {
  std::set<std::string> codes;
  for (const auto& w : document["warnings"]) codes.insert(w["code"]);
  return codes;
}

std::map<std::string, double> areas_of(const Json& document) {
  std::map<std::string, double> areas;
  for (const auto& g : document["groups"]) areas[g["name"]] = g["area"];
  return areas;
}

const double kDisc = kPi * 10 * (50.0 * 50 - 10 * 10 - 6 * 6 * 6);

TEST_F(Cad, PartsAreClosedAndHaveTheirVolume) {
  const std::map<std::string, double> volumes = {
      {"disc.step", kDisc},
      {"disc_solid.igs", kDisc},
      {"disc_faces.igs", kDisc},
      {"nut.step", 8 * (1.5 * std::sqrt(3.0) * 100 - kPi * 25)},
      {"bracket.step", 8 * (80 * 30 + kPi * 15 * 15 - 2 * kPi * 49 - 200)},
      {"two_solids.step", 40 * 40 * 10 + kPi * 64 * 15},
      {"overlap.step", kPi * (400.0 * 20 + 100 * 20)},
      {"inch_plate.step", std::pow(25.4, 3) * (4 * 2 * 0.5 - kPi * 0.25 * 0.5)}};
  for (const auto& [name, volume] : volumes) {
    const TriangleSurface surface = read(name);
    EXPECT_TRUE(is_closed(surface)) << name;
    EXPECT_NEAR(volume_of(surface) / volume, 1, 2e-3) << name;
    EXPECT_EQ(surface.cad_face.size(), surface.triangles.size()) << name;
  }
}

// Chords share vertices with the arc, so a finer one is nearer by its square.
TEST_F(Cad, ChordErrorIsAShareOfTheRadius) {
  const std::string text = part("disc.step");
  ExecutionContext context;
  for (const double error : {1e-2, 1e-3, 1e-4}) {
    const auto surface = read_cad(text, CadFormat::kStep, error, context);
    ASSERT_TRUE(surface) << surface.error().message;
    double off = 0, off_vertex = 0;
    for (std::size_t t = 0; t < surface->triangles.size(); ++t) {
      const CadFace& face = surface->cad_faces[static_cast<std::size_t>(surface->cad_face[t])];
      const auto& c = surface->triangles[t];
      for (std::size_t i = 0; i < 3; ++i) {
        const Point3 a = surface->vertices[static_cast<std::size_t>(c[i])];
        const Point3 b = surface->vertices[static_cast<std::size_t>(c[(i + 1) % 3])];
        const Point3 middle = 0.5 * (a + b);
        off_vertex = std::max(off_vertex, distance(a, project_onto(face.surface, a)));
        if (face.surface.kind == FaceKind::kPlane) continue;
        off = std::max(off,
                       distance(middle, project_onto(face.surface, middle)) / face.surface.radius);
      }
    }
    EXPECT_LT(off, 1.01 * error);
    EXPECT_LT(off_vertex, 1e-9);
  }
}

TEST_F(Cad, FacesAreGroupsWithTheAreasOfTheModel) {
  for (const char* file : {"disc.step", "disc_solid.igs", "disc_faces.igs"}) {
    const Json document = inspected(file);
    EXPECT_EQ(document["fold"], 6) << file;
    EXPECT_TRUE(warnings_of(document).empty()) << file << document["warnings"];
    const std::map<std::string, double> areas = areas_of(document);
    const std::map<std::string, double> expected = {{"bore", 2 * kPi * 10 * 10},
                                                    {"rim", 2 * kPi * 50 * 10},
                                                    {"hole_r6_1", 6 * 2 * kPi * 6 * 10},
                                                    {"plane_1", kDisc / 10},
                                                    {"plane_2", kDisc / 10}};
    ASSERT_EQ(areas.size(), expected.size()) << file << document["groups"];
    for (const auto& [name, area] : expected) {
      ASSERT_TRUE(areas.contains(name)) << file << " " << name;
      EXPECT_NEAR(areas.at(name) / area, 1, 2e-3) << file << " " << name;
    }
  }
}

TEST_F(Cad, FoldsAreFound) {
  const std::map<std::string, int> folds = {{"flange.step", 8},
                                            {"bracket.step", 2},
                                            {"nut.step", 6},
                                            {"two_solids.step", 4},
                                            {"inch_plate.step", 2}};
  for (const auto& [name, fold] : folds) EXPECT_EQ(inspected(name)["fold"], fold) << name;
}

TEST_F(Cad, KindsAreThoseOfTheFile) {
  const Json document = inspected("flange.step");
  bool cone = false;
  for (const auto& g : document["groups"]) {
    if (g["kind"] != "cone") continue;
    cone = true;
    EXPECT_NEAR(g["half_angle_deg"].get<double>(), 45, 1e-9);
    EXPECT_EQ(g["faces"], 8);
    EXPECT_TRUE(g["concave"].get<bool>());
  }
  EXPECT_TRUE(cone) << document["groups"];
}

TEST_F(Cad, NamesAndColoursOfFaces) {
  const Json document = inspected("coloured.step");
  EXPECT_EQ(document["fold"], 6);
  std::map<std::string, std::string> colours;
  for (const auto& g : document["groups"]) {
    colours[g["name"]] = g.contains("color") ? g["color"].get<std::string>() : "";
  }
  ASSERT_TRUE(colours.contains("shaft seat")) << document["groups"];
  EXPECT_EQ(colours["shaft seat"], "#ff0000");
  EXPECT_EQ(colours["rim"], "#0000ff");
  EXPECT_EQ(colours["plane_1"], "");
}

// What is on both solids, four pieces, is named as the first one's faces are, every time.
TEST_F(Cad, NamesOfFacesInOnePlaneAreThoseOfTheFirstSolid) {
  const TriangleSurface surface = read("named_overlap.step");
  std::map<std::string, double> areas;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto [a, b, c] = surface.triangles[t];
    const auto at = [&](std::int32_t i) { return surface.vertices[static_cast<std::size_t>(i)]; };
    const std::string& name = surface.cad_faces[static_cast<std::size_t>(surface.cad_face[t])].name;
    areas[name.substr(0, name.find(' '))] += length(cross(at(b) - at(a), at(c) - at(a))) / 2;
  }
  EXPECT_NEAR(areas["first"], 20 * (2 * 20 + 2 * 10) + 20 * 10, 1e-9);
  EXPECT_NEAR(areas["second"], 10 * (2 * 20 + 2 * 10) + 20 * 10, 1e-9);
  EXPECT_EQ(areas.size(), 2U);
}

TEST_F(Cad, OtherUnitsAreConvertedAndTold) {
  const Json document = inspected("inch_plate.step");
  EXPECT_TRUE(warnings_of(document).contains("units_converted")) << document["warnings"];
  EXPECT_NEAR(document["bounding_box"]["max"][0].get<double>(), 50.8, 1e-6);
}

TEST_F(Cad, SolidsThatTouchAreOneWithoutTheFaceBetween) {
  const Json document = inspected("two_solids.step");
  EXPECT_TRUE(warnings_of(document).contains("solids_united")) << document["warnings"];
  EXPECT_EQ(document["shells"], 1);
  EXPECT_EQ(read("two_solids.step").cad_notes->inner_faces, 1U);
}

TEST_F(Cad, AreMeshedWithTheirGroups) {
  for (const char* file : {"disc.step", "nut.step", "disc_faces.igs"}) {
    ExecutionContext context;
    const auto outcome = mesh_model(read(file), {}, context);
    ASSERT_TRUE(outcome) << file << ": " << outcome.error().message;
    EXPECT_EQ(outcome->mesh.fold, 6) << file;
    std::set<std::string> names;
    for (const auto& n : outcome->mesh.marker_names) names.insert(n.name);
    EXPECT_TRUE(names.contains("plane_1")) << file;
    EXPECT_TRUE(names.contains("bore")) << file;
    EXPECT_EQ(
        std::count(outcome->mesh.boundary_markers.begin(), outcome->mesh.boundary_markers.end(), 0),
        0)
        << file;
  }
}

// Farthest that nodes and mid-side nodes on the group of a marker's facets are from a cylinder about
// an axis along z.
double beside_cylinder(const SymmetryCellMesh& cell,
                       std::int32_t marker,
                       Point2 centre,
                       double radius) {
  const FullMeshView full(cell);
  const auto k = static_cast<std::size_t>(cell.nodes_per_facet);
  double off = 0;
  for (std::size_t f = 0; f < cell.facet_count(); ++f) {
    if (cell.boundary_markers[f] != marker) continue;
    for (std::size_t i = 0; i < k; ++i) {
      const Point3 p = full.cell_node_position(static_cast<std::size_t>(cell.boundary[k * f + i]));
      off = std::max(off, std::abs(distance({p.x, p.y}, centre) - radius));
    }
  }
  return off;
}

std::int32_t marker_of(const SymmetryCellMesh& cell, const std::string& name) {
  for (const MarkerName& n : cell.marker_names) {
    if (n.name == name) return n.marker;
  }
  ADD_FAILURE() << "no group " << name;
  return 0;
}

TEST_F(Cad, VerticesLieOnTheFaces) {
  for (const std::int32_t order : {1, 2}) {
    MeshOptions options;
    options.order = order;
    ExecutionContext context;
    const auto outcome = mesh_model(read("disc.step"), options, context);
    ASSERT_TRUE(outcome) << outcome.error().message;
    const SymmetryCellMesh& cell = outcome->mesh;
    EXPECT_LT(beside_cylinder(cell, marker_of(cell, "bore"), {0, 0}, 10), 1e-9);
    EXPECT_LT(beside_cylinder(cell, marker_of(cell, "rim"), {0, 0}, 50), 1e-9);
    ASSERT_TRUE(outcome->statistics.curving);
    EXPECT_EQ(outcome->statistics.curving->left, 0U);
    EXPECT_EQ(outcome->statistics.curving->straightened, 0U);
    EXPECT_EQ(outcome->statistics.curving->other_faces, 0U);
  }
}

TEST_F(Cad, VolumeOfADiscAtOrderTwo) {
  MeshOptions options;
  options.order = 2;
  options.symmetry_tolerance_rel = 2e-3;  // as coarse as to have fewer than 10,000 tetrahedra
  for (const char* file : {"disc.step", "disc_faces.igs"}) {
    ExecutionContext context;
    const auto outcome = mesh_model(read(file), options, context);
    ASSERT_TRUE(outcome) << outcome.error().message;
    const Statistics& statistics = outcome->statistics;
    EXPECT_LE(statistics.full.elements, 10'000U);
    const double volume = 6 * statistics.cell.measure;
    EXPECT_LT(std::abs(volume / kDisc - 1), 1e-5) << file << ", " << statistics.full.elements;
  }
  options.curved = false;
  ExecutionContext context;
  const auto straight = mesh_model(read("disc.step"), options, context);
  ASSERT_TRUE(straight) << straight.error().message;
  EXPECT_GT(std::abs(6 * straight->statistics.cell.measure / kDisc - 1), 3e-4);
  EXPECT_FALSE(straight->statistics.curving);
}

// Chamfers, fillets, balls: cones, tori and spheres, some meeting without an angle.
TEST_F(Cad, OtherPartsAtOrderTwo) {
  const double flange = kPi * (60.0 * 60 * 12 + 30.0 * 30 * 25 - 20.0 * 20 * 37 - 8 * 25 * 12 -
                               8 * (2.0 / 3 * (49 + 35 + 25) - 2 * 25));
  for (const auto& [file, volume] : std::map<std::string, double>{
           {"flange.step", flange},
           {"bracket.step", 8 * (80 * 30 + kPi * 15 * 15 - 2 * kPi * 49 - 200)},
           {"nut.step", 8 * (1.5 * std::sqrt(3.0) * 100 - kPi * 25)}}) {
    MeshOptions options;
    options.order = 2;
    ExecutionContext context;
    const auto outcome = mesh_model(read(file), options, context);
    ASSERT_TRUE(outcome) << file << ": " << outcome.error().message;
    const Statistics& statistics = outcome->statistics;
    EXPECT_LT(std::abs(outcome->mesh.fold * statistics.cell.measure / volume - 1), 3e-4)
        << file << ", " << statistics.full.elements;
    ASSERT_TRUE(statistics.curving) << file;
    EXPECT_LT(statistics.curving->straightened, statistics.curving->sides / 20 + 1) << file;
  }
}

// A sheet bounds nothing: the surface's own repair has to say so.
TEST_F(Cad, WhatIsOpenIsRefusedAsAnySurface) {
  ExecutionContext context;
  const auto outcome = mesh_model(read("sheet.step"), {}, context);
  ASSERT_FALSE(outcome);
  EXPECT_EQ(outcome.error().code, ErrorCode::kNotWatertight) << outcome.error().message;
}

TEST_F(Cad, DamagedFilesAreErrors) {
  const std::string step = part("disc.step");
  const std::string iges = part("disc_faces.igs");
  const auto refused = [](const std::string& text, std::optional<ModelFormat> format) {
    const auto model = read_model(text, format);
    EXPECT_FALSE(model);
    if (model) return std::string();
    EXPECT_NE(model.error().code, ErrorCode::kInternal) << model.error().message;
    EXPECT_GT(model.error().message.size(), 20U);
    return model.error().message;
  };
  std::string noise = "ISO-10303-21;\n";
  for (int i = 0; i < 20'000; ++i) noise += static_cast<char>((i * 7919 + i / 13) % 251);
  refused(step.substr(0, step.size() / 2), std::nullopt);
  refused(step.substr(0, 200), std::nullopt);
  refused("ISO-10303-21;\n", std::nullopt);
  refused(noise, std::nullopt);
  refused("nothing of that kind", ModelFormat::kStep);
  refused("nothing of that kind", ModelFormat::kIges);
  refused("", ModelFormat::kStep);
  refused(iges.substr(0, iges.size() / 2), std::nullopt);
  refused(iges.substr(0, 82) + noise, std::nullopt);
  // Numbers beyond all bounds, radii that are none, entities that refer to themselves.
  refused(replaced(step, "CARTESIAN_POINT('',(", "CARTESIAN_POINT('',(1.E300,"), std::nullopt);
  refused(replaced(step, ",50.);", ",1.E200);"), std::nullopt);
  refused(replaced(replaced(step, ",50.);", ",0.);"), ",6.);", ",-6.);"), std::nullopt);
  const std::size_t data = step.find("DATA;");
  refused(step.substr(0, data) + "DATA;\nENDSEC;\nEND-ISO-10303-21;\n", std::nullopt);
  std::string circular = step;
  for (std::size_t at = circular.find(" = AXIS2_PLACEMENT_3D('',"); at != std::string::npos;
       at = circular.find(" = AXIS2_PLACEMENT_3D('',", at + 1)) {
    const std::size_t begin = circular.rfind('#', at);
    const std::string own = circular.substr(begin, at - begin);
    const std::size_t first = circular.find('#', at);
    circular.replace(first, circular.find(',', first) - first, own);
  }
  refused(circular, std::nullopt);
}

TEST_F(Cad, WithoutItsModuleTheProgramSaysSo) {
  ::setenv("SYMCELL_CAD_MODULE", "/nowhere/symcell_cad.so", 1);
  const auto model = read_model(part("disc.step"), std::nullopt);
  SetUpTestSuite();
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().code, ErrorCode::kUnsupportedModel);
}

}  // namespace
}  // namespace symcell
