// Every check sees the damage it is there for.
#include "core/solid/quotient/validate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/solid_samples.hpp"

namespace symcell::solid {
namespace {

test::PrismShape shape() {
  test::PrismShape s;
  s.fold = 5;
  s.rings = 3;
  s.layers = 3;
  return s;
}

std::string complaint(const QuotientTetrahedralization& mesh, double volume = 0) {
  const auto report = validate(mesh, ValidationLevel::kDelaunay, volume);
  return report ? "" : report.error().message;
}

bool has(const std::string& text, const char* part) {
  return text.find(part) != std::string::npos;
}

// The first tetrahedron with an inner face, and that face.
std::pair<TetId, std::uint32_t> inner_face(const QuotientTetrahedralization& mesh) {
  for (TetId t = 0; t < mesh.tet_slots(); ++t) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      if (mesh.tet(t).nb[i] != kNoHalfFace) return {t, i};
    }
  }
  return {0, 0};
}

TEST(ValidateTetrahedra, SeesDamage) {
  const auto solid = test::prism(shape());
  const auto [t, i] = inner_face(solid.mesh);
  EXPECT_EQ(complaint(solid.mesh), "");
  {
    auto mesh = solid.mesh;
    std::swap(mesh.tet(3).v[0], mesh.tet(3).v[1]);
    std::swap(mesh.tet(3).k[0], mesh.tet(3).k[1]);
    EXPECT_TRUE(has(complaint(mesh), "positively oriented"));
  }
  {
    auto mesh = solid.mesh;
    mesh.tet(3).k[0] = 5;
    EXPECT_TRUE(has(complaint(mesh), "exponent out of range"));
  }
  {
    auto mesh = solid.mesh;
    const VertexId axis = 0;
    ASSERT_TRUE(mesh.on_axis(axis));
    mesh.move_vertex(axis, {1e-9, 0, 0});
    EXPECT_TRUE(has(complaint(mesh), "off the axis"));
  }
  {
    auto mesh = solid.mesh;
    mesh.tet(t).off[i] = static_cast<std::int16_t>(mesh.add(mesh.tet(t).off[i], 1));
    EXPECT_TRUE(has(complaint(mesh), "exponents"));
    Tet& other = mesh.tet(tet_of(mesh.tet(t).nb[i]));
    const std::uint32_t j = face_of(mesh.tet(t).nb[i]);
    other.off[j] = static_cast<std::int16_t>(mesh.subtract(other.off[j], 1));
    EXPECT_TRUE(has(complaint(mesh), "corners differ"));
  }
  {
    auto mesh = solid.mesh;
    mesh.tet(t).nb[i] = kNoHalfFace;
    EXPECT_TRUE(has(complaint(mesh), "open face"));
    mesh.tet(t).facet[i] = 0;
    EXPECT_NE(complaint(mesh), "");
  }
  {
    auto mesh = solid.mesh;
    mesh.tet(t).facet[i] = 1;
    EXPECT_TRUE(has(complaint(mesh), "facets differ"));
  }
  {
    auto mesh = solid.mesh;
    mesh.tet(t).region = 1;
    EXPECT_TRUE(has(complaint(mesh), "regions differ"));
  }
  {
    auto mesh = solid.mesh;
    mesh.set_segment({0, static_cast<VertexId>(mesh.vertex_slots()) - 1, 0}, 1);
    EXPECT_TRUE(has(complaint(mesh), "subsegments"));
  }
  for (std::size_t v = 0; v < solid.mesh.vertex_slots(); ++v) {
    auto mesh = solid.mesh;
    const auto id = static_cast<VertexId>(v);
    if (mesh.kind(id) == VertexKind::kFree) {
      mesh.set_kind(id, VertexKind::kFacet, 0);
      EXPECT_TRUE(has(complaint(mesh), "on no face of its facet"));
    } else {
      mesh.set_kind(id, VertexKind::kFree, 0);
      EXPECT_NE(complaint(mesh), "");
    }
  }
}

TEST(ValidateTetrahedra, MeasuresTheVolume) {
  const auto solid = test::prism(shape());
  const double volume = test::prism_volume(shape()) / shape().fold;
  const auto report = validate(solid.mesh, ValidationLevel::kEmbedding, volume);
  ASSERT_TRUE(report);
  EXPECT_NEAR(report->volume, volume, 1e-12 * volume);
  EXPECT_TRUE(has(complaint(solid.mesh, 1.001 * volume), "volume"));
}

// A layer that is wound twice round the axis passes all but the angles: exponents doubled.
TEST(ValidateTetrahedra, SeesAMeshThatWindsTwice) {
  QuotientTetrahedralization mesh(5);
  // The prism axis, v, R^2 v: 144 degrees, whose five copies cover the disc twice.
  const VertexId foot = mesh.add_vertex({0, 0, 0}, VertexKind::kInput, true);
  const VertexId head = mesh.add_vertex({0, 0, 1}, VertexKind::kInput, true);
  const VertexId v = mesh.add_vertex({1, 0, 0.5}, VertexKind::kInput, false);
  NewTet t;
  t.c[0] = {foot, 0};
  t.c[1] = {v, 0};
  t.c[2] = {v, 2};
  t.c[3] = {head, 0};
  for (std::int32_t& f : t.facet) f = 0;
  t.facet[1] = t.facet[2] = kNoFacet;  // glued to its own copies
  ASSERT_TRUE(mesh.build(std::array{t}));
  EXPECT_TRUE(validate(mesh, ValidationLevel::kIncidence));
  EXPECT_TRUE(has(complaint(mesh), "dihedral"));
}

// Tetrahedra round the edge from (0, 0, 0) to (0, 0, 1), each turned on by `step_deg`; the last one
// adjoins the first one or the row stays open.
QuotientTetrahedralization fan(int count, double step_deg, bool closed) {
  QuotientTetrahedralization mesh(1);
  const VertexId foot = mesh.add_vertex({0, 0, 0}, VertexKind::kInput, false);
  const VertexId head = mesh.add_vertex({0, 0, 1}, VertexKind::kInput, false);
  std::vector<VertexId> rim;
  for (int i = 0; i < count + (closed ? 0 : 1); ++i) {
    const double angle = i * step_deg * std::numbers::pi / 180;
    rim.push_back(
        mesh.add_vertex({std::cos(angle), std::sin(angle), 0.5}, VertexKind::kInput, false));
  }
  std::vector<NewTet> tets(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < tets.size(); ++i) {
    NewTet& t = tets[i];
    t.c[0] = {foot, 0};
    t.c[1] = {rim[i], 0};
    t.c[2] = {rim[(i + 1) % rim.size()], 0};
    t.c[3] = {head, 0};
    t.facet[0] = t.facet[3] = 0;
    if (!closed && i == 0) t.facet[2] = 0;
    if (!closed && i + 1 == tets.size()) t.facet[1] = 0;
  }
  EXPECT_TRUE(mesh.build(tets));
  return mesh;
}

TEST(ValidateTetrahedra, SeesEdgesThatAreGoneRoundTwice) {
  EXPECT_TRUE(validate(fan(4, 90, true), ValidationLevel::kEmbedding));
  EXPECT_TRUE(validate(fan(3, 120, true), ValidationLevel::kEmbedding));
  EXPECT_TRUE(validate(fan(40, 9, true), ValidationLevel::kEmbedding));
  EXPECT_TRUE(has(complaint(fan(6, 120, true)), "dihedral"));
  EXPECT_TRUE(has(complaint(fan(8, 90, true)), "dihedral"));
  EXPECT_TRUE(has(complaint(fan(80, 9, true)), "dihedral"));
  EXPECT_TRUE(has(complaint(fan(9, 120, true)), "dihedral"));
  // Flat, up to all round where two facets touch, beyond that, and twice round.
  for (const double step : {1.0, 60.0, 90.0, 120.0}) {
    EXPECT_TRUE(validate(fan(1, step, false), ValidationLevel::kEmbedding));
    EXPECT_TRUE(validate(fan(2, step, false), ValidationLevel::kEmbedding));
    EXPECT_TRUE(validate(fan(3, step, false), ValidationLevel::kEmbedding));
  }
  EXPECT_TRUE(validate(fan(4, 90, false), ValidationLevel::kEmbedding));
  EXPECT_TRUE(validate(fan(360, 1, false), ValidationLevel::kEmbedding));
  EXPECT_TRUE(validate(fan(359, 1, false), ValidationLevel::kEmbedding));
  for (const int count : {365, 540, 719, 720}) {
    EXPECT_TRUE(has(complaint(fan(count, 1, false)), "dihedral")) << count;
  }
  EXPECT_TRUE(has(complaint(fan(3, 140, false)), "dihedral"));
  EXPECT_TRUE(has(complaint(fan(3, 175, false)), "dihedral"));
  EXPECT_TRUE(has(complaint(fan(5, 90, false)), "dihedral"));
}

TEST(ValidateTetrahedra, CountsWhatIsNotDelaunay) {
  auto solid = test::prism(shape());
  const auto before = validate(solid.mesh, ValidationLevel::kDelaunay);
  ASSERT_TRUE(before);
  EXPECT_GT(before->free_faces, 0U);
  ASSERT_GT(test::random_flips(solid.mesh, 400, 1), 0);
  test::jitter(solid.mesh, 0.3, 2);
  const auto after = validate(solid.mesh, ValidationLevel::kDelaunay);
  ASSERT_TRUE(after);
  EXPECT_GT(after->certain_flips, 0U);
  EXPECT_LT(after->certain_flips, after->free_faces);
}

}  // namespace
}  // namespace symcell::solid
