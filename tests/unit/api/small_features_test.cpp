// Models with features that are small beside them: gaps as narrow as coordinates tell. Their meshes
// are what the input asks for, and verify_mesh has to see that.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "api/formats/vtu_reader.hpp"
#include "core/mesh_model.hpp"
#include "core/verify/verify_mesh.hpp"
#include "tests/support/written_mesh.hpp"

namespace symcell {
namespace {

using Polygon = std::vector<Point2>;

// A square with a slot as wide as told, from the middle of a side to the centre.
Polygon slotted(double width) {
  return {{-1, -1}, {1, -1}, {1, 0}, {0, 0}, {0, width}, {1, width}, {1, 1}, {-1, 1}};
}

// A square with a notch from the middle of a side to the centre, as wide at the side as told.
Polygon notched(double width) {
  return {{0, 0}, {1, -width / 2}, {1, -1}, {-1, -1}, {-1, 1}, {1, 1}, {1, width / 2}};
}

// A regular polygon with one vertex moved far along the x axis.
Polygon with_far_vertex(double far) {
  Polygon polygon;
  for (int i = 0; i < 12; ++i) {
    const double angle = std::numbers::pi * i / 6;
    polygon.push_back({std::cos(angle), std::sin(angle)});
  }
  polygon[0].x = far;
  return polygon;
}

Pslg planar_model(const Polygon& polygon) {
  Pslg model;
  model.vertices = polygon;
  const auto count = static_cast<std::int32_t>(polygon.size());
  for (std::int32_t i = 0; i < count; ++i) model.segments.push_back({i, (i + 1) % count, 0});
  return model;
}

Plc prism_over(const Polygon& polygon) {
  Plc model;
  const auto count = static_cast<std::int32_t>(polygon.size());
  for (const double z : {0.0, 1.0}) {
    for (const Point2 p : polygon) model.vertices.push_back({p.x, p.y, z});
  }
  PlcFacet bottom, top;
  bottom.polygons.emplace_back();
  top.polygons.emplace_back();
  for (std::int32_t i = 0; i < count; ++i) {
    const std::int32_t next = (i + 1) % count;
    bottom.polygons[0].push_back(count - 1 - i);
    top.polygons[0].push_back(count + i);
    PlcFacet side;
    side.polygons = {{i, next, count + next, count + i}};
    model.facets.push_back(side);
  }
  model.facets.push_back(bottom);
  model.facets.push_back(top);
  return model;
}

void expect_verified(const Model& model, const MeshOptions& options) {
  ExecutionContext context;
  const auto made = mesh_model(model, options, context);
  ASSERT_TRUE(made) << made.error().message;
  const auto read = [&](MeshPart part) {
    return read_vtu(test::written(made->mesh, part, MeshFormat::kVtu)).value();
  };
  const MeshData cell = read(MeshPart::kCell), full = read(MeshPart::kFull);
  for (const Check& check : verify_mesh(cell, &full, &model, {}).checks) {
    EXPECT_NE(check.status, Check::Status::kFail)
        << "fold " << cell.fold << ", " << check.name << ": " << check.detail;
  }
}

// `make(polygon)` of slots and notches of all widths.
template <class Make>
void expect_narrow_gaps_verified(const Make& make, const MeshOptions& options) {
  for (const double width : {1e-6, 1e-8, 1e-9, 1e-10, 1e-11}) {
    SCOPED_TRACE(width);
    expect_verified(make(slotted(width)), options);
    expect_verified(make(notched(width)), options);
  }
}

TEST(SmallFeatures, InThePlane) {
  MeshOptions options;
  options.min_angle_deg = 20;
  expect_narrow_gaps_verified(planar_model, options);
  for (const double far : {1e7, 1e8, 2.7e8}) {
    SCOPED_TRACE(far);
    expect_verified(planar_model(with_far_vertex(far)), options);
  }
}

TEST(SmallFeatures, InSpaceWithoutSymmetry) {
  MeshOptions options;
  options.fold = 1;
  expect_narrow_gaps_verified(prism_over, options);
}

// The axis runs along the notch, between its two sides and nearer to them than the tolerance of the
// symmetry, and neither side may be taken for a facet that contains it.
TEST(SmallFeatures, BesideTheAxis) {
  ExecutionContext context;
  for (const double width : {2e-3, 2e-5, 6e-6, 2e-6, 2e-7, 2e-8}) {
    SCOPED_TRACE(width);
    const Model model = prism_over(notched(width));
    const auto made = mesh_model(model, {}, context);
    if (!made) {
      EXPECT_NE(made.error().code, ErrorCode::kInternal) << made.error().message;
      continue;
    }
    expect_verified(model, {});
  }
}

}  // namespace
}  // namespace symcell
