// Laws of meshes of models that are symmetric in shape only: as good as any, near the model both
// ways, and not larger for their symmetry.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "api/formats/vtu_reader.hpp"
#include "core/geometry/segment_index.hpp"
#include "core/mesh_model.hpp"
#include "core/verify/verify_mesh.hpp"
#include "tests/property/random_case.hpp"
#include "tests/property/restored_mesh.hpp"
#include "tests/support/shape_models.hpp"
#include "tests/support/written_mesh.hpp"

namespace symcell {
namespace {

// By how much the whole mesh may exceed that without symmetry.
constexpr double kMostGrowth = 1.15;
// Cells of a handful of triangles cannot come as near.
constexpr double kFewTriangles = 4;

Result<MeshOutcome> mesh(const Pslg& model, const MeshOptions& options) {
  ExecutionContext context;
  context.set_max_elements(200'000);
  return mesh_model(model, options, context);
}

double diameter_of(const Pslg& pslg) {
  Point2 low = pslg.vertices.front(), high = low;
  for (const Point2 p : pslg.vertices) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  return distance(low, high);
}

// Largest distance of points along the segments from the other's, by samples.
double farthest(const std::vector<IndexedSegment>& from, const SegmentIndex& to) {
  constexpr int kSamples = 16;  // along a segment
  double worst = 0;
  for (const IndexedSegment& s : from) {
    for (int i = 0; i <= kSamples; ++i) {
      const Point2 p = s.a + (static_cast<double>(i) / kSamples) * (s.b - s.a);
      worst = std::max(worst, to.nearest(p, 1e9).distance);
    }
  }
  return worst;
}

void expect_near(const test::ShapeModel& model, const SymmetryCellMesh& cell) {
  std::vector<IndexedSegment> given, meshed;
  for (const PslgSegment& s : model.pslg.segments) {
    given.push_back({model.pslg.vertices[static_cast<std::size_t>(s.a)],
                     model.pslg.vertices[static_cast<std::size_t>(s.b)]});
  }
  const RotationTable rotations(cell.fold);
  const auto place = [&](std::int32_t node, std::int32_t k) {
    const OrbitVertex v = cell.nodes[static_cast<std::size_t>(node)];
    const Point3 p = rotations.rotate(cell.orbit_points[static_cast<std::size_t>(v.orbit)],
                                      rotations.add(v.exponent, k));
    return Point2{p.x + cell.axis_origin.x, p.y + cell.axis_origin.y};
  };
  for (std::size_t f = 0; f < cell.facet_count(); ++f) {
    for (std::int32_t k = 0; k < cell.fold; ++k) {
      meshed.push_back({place(cell.boundary[2 * f], k), place(cell.boundary[2 * f + 1], k)});
    }
  }
  const double tolerance = 1.0001 * model.tolerance_rel * diameter_of(model.pslg);
  EXPECT_LE(farthest(given, SegmentIndex(meshed)), tolerance) << model.description;
  EXPECT_LE(farthest(meshed, SegmentIndex(given)), tolerance) << model.description;
}

std::string failures(const VerifyReport& report) {
  std::string names;
  for (const Check& c : report.checks) {
    if (c.status == Check::Status::kFail) names += c.name + " (" + c.detail + ") ";
  }
  return names;
}

TEST(MeshShapeProperty, OneSectorIsMadeExact) {
  const SeedRange seeds = property_seeds(120);
  for (std::uint64_t seed = seeds.begin; seed < seeds.end; ++seed) {
    const test::ShapeModel model = test::make_shape_model(seed);
    SCOPED_TRACE(model.description);
    MeshOptions options;
    options.symmetry_tolerance_rel = model.tolerance_rel;
    const auto outcome = mesh(model.pslg, options);
    ASSERT_TRUE(outcome) << outcome.error().message;
    EXPECT_EQ(outcome->mesh.fold % model.fold, 0) << outcome->mesh.fold;
    expect_near(model, outcome->mesh);

    const MeshData cell =
        read_vtu(test::written(outcome->mesh, MeshPart::kCell, MeshFormat::kVtu)).value();
    const Model given = model.pslg;
    const VerifyReport report = verify_mesh(cell, nullptr, &given, {});
    EXPECT_TRUE(report.ok()) << failures(report);

    MeshOptions plain;
    plain.fold = 1;
    const auto whole = mesh(model.pslg, plain);
    ASSERT_TRUE(whole) << whole.error().message;
    const auto fold = static_cast<double>(outcome->mesh.fold);
    const double most = kMostGrowth * static_cast<double>(whole->mesh.element_count());
    EXPECT_LE(fold * static_cast<double>(outcome->mesh.element_count()),
              most + kFewTriangles * fold);
  }
}

// What there was before: every vertex and all its images are nodes.
TEST(MeshShapeProperty, VerticesAreKeptOnRequest) {
  const SeedRange seeds = property_seeds(20);
  for (std::uint64_t seed = seeds.begin; seed < seeds.end; ++seed) {
    const test::ShapeModel model = test::make_shape_model(seed);
    SCOPED_TRACE(model.description);
    MeshOptions options;
    options.symmetry_tolerance_rel = model.tolerance_rel;
    options.keep_vertices = true;
    const auto outcome = mesh(model.pslg, options);
    if (!outcome) continue;  // copies that stand too near others may be refused
    const std::vector<Point3> points = [&] {
      std::vector<Point3> all;
      const RestoredMesh full = restore(outcome->mesh);
      for (const Point2 p : full.points) all.push_back({p.x, p.y, 0});
      return all;
    }();
    for (const Point2 v : model.pslg.vertices) {
      const bool found = std::ranges::any_of(points, [&](const Point3& p) {
        return distance(Point2{p.x, p.y}, v) <= 2 * model.tolerance_rel * diameter_of(model.pslg);
      });
      EXPECT_TRUE(found);
    }
  }
}

}  // namespace
}  // namespace symcell
