// Theorem 1 of the paper: the restored mesh is the constrained Delaunay triangulation that
// inserting whole orbits into the full model gives. Ties, polygons that are cocircular within
// rounding, may be cut by other diagonals.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <map>

#include "api/formats/model_reader.hpp"
#include "core/mesh_model.hpp"
#include "tests/property/orbit_insertion_reference.hpp"
#include "tests/property/random_case.hpp"
#include "tests/property/restored_mesh.hpp"
#include "tests/support/test_files.hpp"

namespace symcell {
namespace {

// Sine of the angle by which opposite angles miss 180 degrees, for four points on one circle.
constexpr double kTie = 1e-7;

// Both apexes of an edge's triangles, of the restored mesh.
using Apexes = std::map<NodePair, std::vector<std::int32_t>>;

Apexes apexes_of(const RestoredMesh& mesh) {
  Apexes result;
  for (std::size_t h = 0; h < 3 * mesh.triangles.size(); ++h) {
    const std::int32_t a = mesh.from(h), b = mesh.to(h);
    result[{std::min(a, b), std::max(a, b)}].push_back(mesh.apex(h));
  }
  return result;
}

bool is_tie(const RestoredMesh& mesh, const NodePair& edge, const std::vector<std::int32_t>& apex) {
  if (apex.size() != 2) return false;
  const Point2 a = mesh.at(edge.first), b = mesh.at(edge.second);
  double sum = 0;
  for (const std::int32_t v : apex) {
    const Point2 p = a - mesh.at(v), q = b - mesh.at(v);
    sum += std::atan2(std::abs(cross(p, q)), dot(p, q));
  }
  return std::abs(std::sin(sum)) <= kTie;
}

void expect_equal_to_reference(const Pslg& model, const SymmetryCellMesh& cell) {
  const RestoredMesh mesh = restore(cell);
  const Apexes apexes = apexes_of(mesh);
  const OrbitInsertionReference reference = insert_orbits(cell, model.holes);
  EXPECT_EQ(reference.triangles, mesh.triangles.size());
  EXPECT_EQ(reference.edges.size(), apexes.size());
  std::size_t in_both = 0;
  for (const auto& [edge, apex] : apexes) {
    if (std::binary_search(reference.edges.begin(), reference.edges.end(), edge)) {
      ++in_both;
    } else {
      EXPECT_TRUE(is_tie(mesh, edge, apex))
          << "edge " << edge.first << " " << edge.second << " is not in the reference";
    }
  }
  // With equal counts and every differing edge of ours a tie, the reference's others cut the same
  // polygons.
  EXPECT_GT(2 * in_both, apexes.size()) << "most edges are no ties";
}

TEST(OrbitInsertion, RandomModels) {
  const SeedRange seeds = property_seeds(150);
  for (std::uint64_t seed = seeds.begin; seed < seeds.end; ++seed) {
    const RandomCase c = make_random_case(seed);
    ExecutionContext context;
    context.set_max_elements(c.options.max_elements);
    const auto outcome = mesh_model(c.model, c.options, context);
    if (!outcome) continue;  // MeshPslgProperty judges these
    std::ostringstream told;
    told << c;
    SCOPED_TRACE(told.str());
    expect_equal_to_reference(c.model, outcome->mesh);
  }
}

void expect_equal_for_file(const std::filesystem::path& path) {
  SCOPED_TRACE(path.filename().string());
  const auto model = read_model(test::read_file(path), ModelFormat::kPslgJson);
  ASSERT_TRUE(model) << model.error().message;
  for (const double angle : {0.0, 20.0, 30.0, 35.0}) {
    MeshOptions options;
    options.min_angle_deg = angle;
    options.ignore_markers = true;
    options.symmetry_tolerance_rel = 2e-4;
    ExecutionContext context;
    const auto outcome = mesh_model(std::get<Pslg>(*model), options, context);
    ASSERT_TRUE(outcome) << outcome.error().message;
    expect_equal_to_reference(std::get<Pslg>(*model), outcome->mesh);
  }
}

TEST(OrbitInsertion, ModelsOfTheTests) {
  for (const char* name : {"p2_01_star_n5_tip12deg", "p2_08_yinyang_n2_segment_through_centre",
                           "p2_10_heptagon_ring_coarse_n7"}) {
    expect_equal_for_file(test::data_file(std::string("models/") + name + ".json"));
  }
}

TEST(SharedData, TheoremOneOnTheCorpus) {
  const auto shared = test::shared_folder();
  if (!shared) GTEST_SKIP() << "../shared is absent";
  for (const auto& entry : std::filesystem::directory_iterator(*shared / "corpus" / "2d")) {
    if (entry.path().extension() == ".json") expect_equal_for_file(entry.path());
  }
}

}  // namespace
}  // namespace symcell
