// What other programs make of our files: the independent checker beside the tree, and Gmsh.
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "api/formats/pslg_json.hpp"
#include "api/schema/statistics_json.hpp"
#include "core/cell/measure_cell.hpp"
#include "core/cell/quadratic.hpp"
#include "tests/support/extruded_cells.hpp"
#include "tests/support/sample_cells.hpp"
#include "tests/support/test_files.hpp"
#include "tests/support/written_mesh.hpp"

namespace symcell {
namespace {

using test::written;

struct Outcome {
  int status;
  std::string output;
};

Outcome run(const std::string& command, const test::TemporaryFolder& folder) {
  const auto log = folder / "output.txt";
  const int status = std::system((command + " > " + log.string() + " 2>&1").c_str());
  return {status, test::read_file(log)};
}

TEST(SharedData, IndependentCheckerPassesVtuFiles) {
  const auto shared = test::shared_folder();
  if (!shared) GTEST_SKIP() << "../shared is absent";
  const test::TemporaryFolder folder;
  for (const test::Sample& sample : test::all_samples()) {
    test::write_file(folder / "model.json", write_pslg_json(sample.model));
    for (const SymmetryCellMesh& mesh : {sample.cell, elevate_to_quadratic(sample.cell)}) {
      for (const VtuEncoding encoding :
           {VtuEncoding::kAppendedRaw, VtuEncoding::kAppendedZlib, VtuEncoding::kAscii}) {
        for (const auto& [part, name] :
             {std::pair{MeshPart::kCell, "cell.vtu"}, std::pair{MeshPart::kFull, "full.vtu"}}) {
          test::write_file(folder / name, written(mesh, part, MeshFormat::kVtu, {encoding}));
        }
        const std::string at = folder.path().string() + "/";
        const Outcome check =
            run("/usr/bin/python3 " + (*shared / "tools/meshcheck.py").string() + " " + at +
                    "cell.vtu --full " + at + "full.vtu --model " + at + "model.json --quiet",
                folder);
        EXPECT_EQ(check.status, 0) << sample.name << " order " << mesh.order << "\n"
                                   << check.output;
      }
    }
  }
}

std::string plc_json(const Plc& model) {
  const auto point = [](const Point3& p) { return nlohmann::json({p.x, p.y, p.z}); };
  nlohmann::json json{{"type", "plc"}};
  for (const Point3& p : model.vertices) json["vertices"].push_back(point(p));
  for (const PlcFacet& facet : model.facets) {
    nlohmann::json entry{{"polygons", facet.polygons}, {"marker", facet.marker}};
    for (const Point3& hole : facet.holes) entry["holes"].push_back(point(hole));
    json["facets"].push_back(entry);
  }
  for (const PlcRegion& region : model.regions) {
    json["regions"].push_back({{"point", point(region.point)}, {"attribute", region.attribute}});
  }
  return json.dump();
}

TEST(SharedData, IndependentCheckerPassesSolids) {
  const auto shared = test::shared_folder();
  if (!shared) GTEST_SKIP() << "../shared is absent";
  const test::TemporaryFolder folder;
  for (const test::SolidSample& sample : test::solid_samples()) {
    test::write_file(folder / "model.json", plc_json(sample.model));
    for (const SymmetryCellMesh& mesh : {sample.cell, elevate_to_quadratic(sample.cell)}) {
      for (const auto& [part, name] :
           {std::pair{MeshPart::kCell, "cell.vtu"}, std::pair{MeshPart::kFull, "full.vtu"}}) {
        test::write_file(folder / name, written(mesh, part, MeshFormat::kVtu));
      }
      Statistics statistics;
      measure_cell_3(mesh, statistics);
      test::write_file(folder / "stats.json",
                       statistics_to_json(statistics, {}, ModelKind::kPlc).dump());
      const std::string at = folder.path().string() + "/";
      const Outcome check = run("/usr/bin/python3 " + (*shared / "tools/meshcheck.py").string() +
                                    " " + at + "cell.vtu --full " + at + "full.vtu --model " + at +
                                    "model.json --stats " + at + "stats.json --quiet",
                                folder);
      EXPECT_EQ(check.status, 0) << sample.name << " order " << mesh.order << "\n" << check.output;
    }
  }
}

// What follows the line "$name".
std::istringstream section(const std::string& msh, const std::string& name) {
  const std::size_t at = msh.find("$" + name + "\n");
  return std::istringstream(at == std::string::npos ? "" : msh.substr(at + name.size() + 2));
}

// Groups, nodes, elements.
std::array<std::size_t, 3> counts(const std::string& msh) {
  std::array<std::size_t, 3> result{};
  section(msh, "PhysicalNames") >> result[0];
  std::size_t blocks = 0;
  section(msh, "Nodes") >> blocks >> result[1];
  section(msh, "Elements") >> blocks >> result[2];
  return result;
}

std::set<std::pair<std::size_t, std::size_t>> periodic_pairs(const std::string& msh) {
  std::set<std::pair<std::size_t, std::size_t>> pairs;
  std::istringstream in = section(msh, "Periodic");
  std::size_t links = 0;
  in >> links;
  for (std::size_t link = 0; link < links; ++link) {
    int dimension = 0, slave = 0, master = 0, size = 0;
    in >> dimension >> slave >> master >> size;
    double entry = 0;
    for (int i = 0; i < size; ++i) in >> entry;
    std::size_t count = 0;
    in >> count;
    for (std::size_t i = 0; i < count; ++i) {
      std::pair<std::size_t, std::size_t> pair;
      in >> pair.first >> pair.second;
      pairs.insert(pair);
    }
  }
  return pairs;
}

// Debian's Gmsh lacks a library that it would like for any affine map, and says so.
bool has_warning(const std::string& output) {
  std::istringstream in(output);
  std::string line;
  while (std::getline(in, line)) {
    if (line.starts_with("Warning") && line.find("ANN support") == std::string::npos) return true;
  }
  return false;
}

TEST(ForeignReaders, GmshKeepsNodesElementsGroupsAndPeriodicity) {
  if (std::system("command -v gmsh > /dev/null 2>&1") != 0) GTEST_SKIP() << "no gmsh here";
  const test::TemporaryFolder folder;
  std::vector<std::pair<std::string, SymmetryCellMesh>> samples;
  for (const test::Sample& sample : test::all_samples()) {
    samples.emplace_back(sample.name, sample.cell);
  }
  for (const test::SolidSample& sample : test::solid_samples()) {
    samples.emplace_back(std::string("solid ") + sample.name, sample.cell);
  }
  for (const auto& [name, linear] : samples) {
    for (const SymmetryCellMesh& mesh : {linear, elevate_to_quadratic(linear)}) {
      for (const MeshPart part : {MeshPart::kCell, MeshPart::kFull}) {
        const std::string at = folder.path().string() + "/";
        const std::string ours = written(mesh, part, MeshFormat::kMsh);
        test::write_file(folder / "in.msh", ours);
        const Outcome gmsh =
            run("gmsh -v 3 -save -format msh41 -o " + at + "out.msh " + at + "in.msh", folder);
        EXPECT_EQ(gmsh.status, 0) << gmsh.output;
        EXPECT_EQ(gmsh.output.find("Error"), std::string::npos) << gmsh.output;
        EXPECT_FALSE(has_warning(gmsh.output)) << gmsh.output;
        const std::string theirs = test::read_file(folder / "out.msh");
        EXPECT_EQ(counts(theirs), counts(ours)) << name;
        EXPECT_EQ(periodic_pairs(theirs), periodic_pairs(ours)) << name;
      }
    }
  }
}

}  // namespace
}  // namespace symcell
