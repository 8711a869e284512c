// Sharp features, the axis, volumes of regions, longest edges.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/unit/core/solid/solid_checks.hpp"

namespace symcell::solid {
namespace {

constexpr double kDeg = std::numbers::pi / 180;

// A convex solid of few tetrahedra, every hull face a facet of its own where `facets` says so, all
// of `segments` in order.
InitialTetrahedralization make(const std::vector<Point3>& points,
                               const std::vector<std::array<VertexId, 4>>& tets,
                               const std::vector<std::array<VertexId, 2>>& segments) {
  InitialTetrahedralization solid;
  for (const Point3& p : points) solid.mesh.add_vertex(p, VertexKind::kInput, false);
  std::vector<NewTet> made;
  std::int32_t facet = 0;
  const auto holds = [&](const std::array<VertexId, 4>& t, VertexId v) {
    return t[0] == v || t[1] == v || t[2] == v || t[3] == v;
  };
  for (const auto& t : tets) {
    NewTet n;
    for (std::size_t i = 0; i < 4; ++i) {
      n.c[i] = {t[i], 0};
      int shared = 0;
      for (const auto& u : tets) {
        bool has = true;
        for (std::size_t j = 0; j < 4; ++j) has = has && (j == i || holds(u, t[j]));
        shared += has ? 1 : 0;
      }
      if (shared == 1) n.facet[i] = facet++;
    }
    made.push_back(n);
  }
  EXPECT_TRUE(solid.mesh.build(made));
  solid.subdomains = {{0, kInfinity}};
  solid.facet_markers.assign(static_cast<std::size_t>(facet), 0);
  solid.segment_markers.assign(segments.size(), 0);
  std::int32_t s = 0;
  for (const auto& e : segments) {
    solid.mesh.set_segment(solid.mesh.edge_key({e[0], 0}, {e[1], 0}), s++);
  }
  return solid;
}

// A triangular prism with this angle at its first upright edge, which is the only segment.
InitialTetrahedralization wedge(double deg) {
  const double c = std::cos(deg * kDeg), s = std::sin(deg * kDeg);
  return make({{0, 0, 0}, {1, 0, 0}, {c, s, 0}, {0, 0, 1}, {1, 0, 1}, {c, s, 1}},
              {{0, 1, 2, 3}, {1, 2, 3, 4}, {2, 4, 3, 5}}, {{0, 3}});
}

// Three edges from an apex with this angle between each two.
InitialTetrahedralization corner(double deg) {
  const double c = std::cos(deg * kDeg);
  // Unit vectors at equal angles to the z axis.
  const double z = std::sqrt((1 + 2 * c) / 3), r = std::sqrt(1 - z * z);
  std::vector<Point3> p = {{0, 0, 0}};
  for (int i = 0; i < 3; ++i) {
    p.push_back({r * std::cos(120 * i * kDeg), r * std::sin(120 * i * kDeg), z});
  }
  return make(p, {{0, 1, 2, 3}}, {{0, 1}, {0, 2}, {0, 3}});
}

TEST(SolidCriteria, SegmentsAreSharpBelowSeventyDegrees) {
  for (const double deg : {20.0, 69.0}) {
    const auto solid = wedge(deg);
    const Criteria criteria(solid, {});
    EXPECT_TRUE(criteria.sharp_segment(0)) << deg;
    EXPECT_TRUE(criteria.sharp_vertex(solid.mesh, 0));
    EXPECT_TRUE(criteria.sharp_vertex(solid.mesh, 3));
    EXPECT_FALSE(criteria.sharp_vertex(solid.mesh, 1));
    EXPECT_EQ(criteria.exemption(solid.mesh, solid.mesh.tet(0)), Exemption::kSmallInputAngle);
  }
  for (const double deg : {71.0, 120.0}) {
    const auto solid = wedge(deg);
    const Criteria criteria(solid, {});
    EXPECT_FALSE(criteria.sharp_segment(0)) << deg;
    EXPECT_FALSE(criteria.sharp_vertex(solid.mesh, 0));
  }
}

// The dihedral angles at these corners are above 70 degrees, the face angles not always.
TEST(SolidCriteria, VerticesAreSharpByFaceAnglesUnlessTessellated) {
  for (const double deg : {69.0, 71.0}) {
    auto solid = corner(deg);
    const Criteria criteria(solid, {});
    for (std::int32_t s = 0; s < 3; ++s) EXPECT_FALSE(criteria.sharp_segment(s));
    EXPECT_EQ(criteria.sharp_vertex(solid.mesh, 0), deg < 70);
    EXPECT_EQ(criteria.acute_vertex(solid.mesh, 0), deg < 70);
    solid.tessellated = true;
    const Criteria of_tessellation(solid, {});
    EXPECT_FALSE(of_tessellation.sharp_vertex(solid.mesh, 0));
    // Not exempt, but segments are divided in shells there all the same.
    EXPECT_EQ(of_tessellation.acute_vertex(solid.mesh, 0), deg < 70);
  }
  // Sharp edges exempt in tessellated models too.
  auto solid = wedge(60);
  solid.tessellated = true;
  EXPECT_TRUE(Criteria(solid, {}).sharp_vertex(solid.mesh, 0));
}

TEST(SolidCriteria, SharpSegmentsAcrossCopies) {
  // Upright edges of a triangle: 60 degrees; of a square and a hexagon: more.
  for (const std::int32_t fold : {3, 4, 6}) {
    test::PrismShape s = test::prism_shape(fold);
    s.steps = 1;
    auto solid = test::prism(s);
    test::shuffle_gauge(solid.mesh, 1);
    const Criteria criteria(solid, {});
    for (std::size_t v = 0; v < solid.mesh.vertex_slots(); ++v) {
      const auto id = static_cast<VertexId>(v);
      const Point3 p = solid.mesh.point(id);
      const bool rim = std::hypot(p.x, p.y) > 0.99 * s.outer_radius;
      EXPECT_EQ(criteria.sharp_vertex(solid.mesh, id), fold == 3 && rim) << fold << ' ' << v;
    }
  }
}

TEST(SolidCriteria, TheAxisExcusesAboveSixfold) {
  for (const std::int32_t fold : {6, 7, 64}) {
    const auto solid = test::prism(test::prism_shape(fold));
    const Criteria criteria(solid, {});
    std::size_t exempt = 0;
    for (TetId t = 0; t < solid.mesh.tet_slots(); ++t) {
      bool at_axis = false;
      for (const VertexId v : solid.mesh.tet(t).v) at_axis = at_axis || solid.mesh.on_axis(v);
      const auto e = criteria.exemption(solid.mesh, solid.mesh.tet(t));
      EXPECT_EQ(e, at_axis && fold > 6 ? Exemption::kAxis : Exemption::kNone);
      // As far as the sector forces it, and no farther.
      const TetMeasures m =
          measure_tet(solid.mesh.corner_point(t, 0), solid.mesh.corner_point(t, 1),
                      solid.mesh.corner_point(t, 2), solid.mesh.corner_point(t, 3));
      const double narrowing = e == Exemption::kAxis ? 2 * std::sin(std::numbers::pi / fold) : 1;
      EXPECT_NEAR(criteria.excess(m, 0, e), narrowing * narrowing * criteria.ratio_excess(m),
                  1e-12 * criteria.ratio_excess(m));
      exempt += e == Exemption::kAxis ? 1 : 0;
    }
    EXPECT_EQ(exempt > 0, fold > 6);
  }
}

TEST(SolidCriteria, BoundsOfRegionsAndEdges) {
  test::PrismShape s = test::prism_shape(6);
  s.inner_facet = true;
  auto solid = test::prism(s);
  solid.subdomains[0].max_volume = 0.01;
  MeshOptions options;
  options.max_volume = 0.05;
  options.max_edge = 0.5;
  const Criteria criteria(solid, options);
  EXPECT_NEAR(criteria.max_volume(0), 0.01, 1e-9);
  EXPECT_LT(criteria.max_volume(0), 0.01);
  EXPECT_NEAR(criteria.max_volume(1), 0.05, 1e-9);
  TetMeasures m;
  m.shortest2 = m.longest2 = 0.2;
  m.radius2 = 0.1;
  m.volume = 0.02;
  EXPECT_NEAR(criteria.size_excess2(m, 0), std::pow(2, 2.0 / 3), 1e-6);
  EXPECT_NEAR(criteria.size_excess2(m, 1), 0.8, 1e-6);
  EXPECT_TRUE(criteria.is_bad(m, 0, Exemption::kSmallInputAngle));
  EXPECT_FALSE(criteria.is_bad(m, 1, Exemption::kNone));
  m.longest2 = 0.26;
  EXPECT_TRUE(criteria.is_bad(m, 1, Exemption::kSmallInputAngle));
  m.longest2 = 0.2;
  m.radius2 = 0.41;  // ratio 1.43
  EXPECT_TRUE(criteria.is_bad(m, 1, Exemption::kNone));
  EXPECT_FALSE(criteria.is_bad(m, 1, Exemption::kSmallInputAngle));
}

}  // namespace
}  // namespace symcell::solid
