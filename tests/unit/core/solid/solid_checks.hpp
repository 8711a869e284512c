// What the tests of edits of solid meshes share: checks that nothing broke, and that nothing
// changed.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/solid/delaunay/editor.hpp"
#include "core/solid/quotient/validate.hpp"
#include "core/solid/refine/criteria.hpp"
#include "tests/support/solid_samples.hpp"

namespace symcell::solid::test {

using namespace symcell::test;  // what all tests share

inline double quotient_volume(const QuotientTetrahedralization& mesh) {
  double sum = 0;
  for (TetId t = 0; t < mesh.tet_slots(); ++t) {
    if (!mesh.alive(t)) continue;
    sum += six_volumes(mesh.corner_point(t, 0), mesh.corner_point(t, 1), mesh.corner_point(t, 2),
                       mesh.corner_point(t, 3)) /
           6;
  }
  return sum;
}

// A mesh with the volume it had before.
[[nodiscard]] inline bool is_valid(const QuotientTetrahedralization& mesh, double volume) {
  const auto report = validate(mesh, ValidationLevel::kEmbedding, volume);
  EXPECT_TRUE(report) << report.error().message;
  if (!report) return false;
  EXPECT_NEAR(report->volume, volume, 1e-9 * volume);
  return std::abs(report->volume - volume) <= 1e-9 * volume;
}

// Inserts p, of the kind that its place asks for; kNoVertex if it is refused.
inline VertexId insert_point(Editor& editor, const Location& where, Point3 p) {
  const QuotientTetrahedralization& mesh = editor.mesh();
  Cavity cavity;
  if (!editor.find_cavity(p, where, cavity)) return Editor::kNoVertex;
  VertexKind kind = VertexKind::kFree;
  std::int32_t parent = -1;
  bool axis = false;
  if (where.kind == Location::Kind::kOnSubfacet) {
    kind = VertexKind::kFacet;
    parent = mesh.tet(where.at.t).facet[where.face];
  } else if (where.kind == Location::Kind::kOnEdge) {
    parent = mesh.segment_of(where.edge[0], where.edge[1]);
    axis = mesh.on_axis(where.edge[0].orbit) && mesh.on_axis(where.edge[1].orbit);
    kind = VertexKind::kSegment;
    if (parent == kNoSegment) {
      kind = cavity.outline.empty() ? VertexKind::kFree : VertexKind::kFacet;
      parent = cavity.outline.empty() ? -1 : cavity.outline.front().facet;
    }
  }
  return editor.insert(cavity, kind, parent, axis);
}

inline std::vector<TetId> live_tets(const QuotientTetrahedralization& mesh) {
  std::vector<TetId> all;
  for (TetId t = 0; t < mesh.tet_slots(); ++t) {
    if (mesh.alive(t)) all.push_back(t);
  }
  return all;
}

// The place and the point in the middle of a face.
inline std::pair<Location, Point3> middle_of_face(const QuotientTetrahedralization& mesh,
                                                  TetId t,
                                                  std::uint32_t face) {
  Point3 p;
  for (const std::uint32_t k : kFaceCorners[face]) p = p + mesh.corner_point(t, k);
  return {{Location::Kind::kOnSubfacet, {t, 0}, face, {}}, (1.0 / 3) * p};
}

// Of an edge.
inline std::pair<Location, Point3> middle_of_edge(const QuotientTetrahedralization& mesh,
                                                  TetId t,
                                                  std::size_t edge) {
  const OrbitVertex a = mesh.corner(t, kEdgeCorners[edge][0]),
                    b = mesh.corner(t, kEdgeCorners[edge][1]);
  return {{Location::Kind::kOnEdge, {t, 0}, 0, {a, b}}, 0.5 * (mesh.lift(a) + mesh.lift(b))};
}

// Equal for meshes that are the same slot by slot; free slots count for nothing.
inline std::vector<double> fingerprint(const QuotientTetrahedralization& mesh) {
  std::vector<double> all;
  for (std::size_t i = 0; i < mesh.vertex_slots(); ++i) {
    const auto v = static_cast<VertexId>(i);
    if (mesh.kind(v) == VertexKind::kDeleted) continue;
    const Point3 p = mesh.point(v);
    all.insert(all.end(), {static_cast<double>(i), p.x, p.y, p.z, static_cast<double>(mesh.kind(v)),
                           static_cast<double>(mesh.parent(v))});
  }
  for (TetId t = 0; t < mesh.tet_slots(); ++t) {
    if (!mesh.alive(t)) continue;
    const Tet& x = mesh.tet(t);
    all.push_back(t);
    all.push_back(x.region);
    for (std::size_t i = 0; i < 4; ++i) {
      all.insert(all.end(), {static_cast<double>(x.v[i]), static_cast<double>(x.k[i]),
                             static_cast<double>(x.nb[i]), static_cast<double>(x.facet[i])});
      if (x.nb[i] != kNoHalfFace) all.push_back(x.off[i]);
    }
  }
  all.push_back(static_cast<double>(mesh.edges().size()));
  return all;
}

// Tetrahedra over a bound; `ratio_too`: the ratio counts, where nothing exempts it.
inline std::size_t count_bad(const Editor& editor,
                             const Criteria& criteria,
                             bool ratio_too = true) {
  const QuotientTetrahedralization& mesh = editor.mesh();
  std::size_t bad = 0;
  for (TetId t = 0; t < mesh.tet_slots(); ++t) {
    if (!mesh.alive(t)) continue;
    const Exemption exempt =
        ratio_too ? criteria.exemption(mesh, mesh.tet(t)) : Exemption::kSmallInputAngle;
    // Measured anew: what the editor keeps must agree.
    const TetMeasures m = editor.measure(t);
    EXPECT_EQ(m.volume, editor.measures(t).volume);
    bad += criteria.is_bad(m, mesh.tet(t).region, exempt) ? 1 : 0;
  }
  return bad;
}

// A prism of about as many sides whatever the fold.
inline PrismShape prism_shape(std::int32_t fold, double bore = 0) {
  PrismShape s;
  s.fold = fold;
  s.steps = fold >= 4 ? 1 : (fold == 1 ? 6 : 6 / fold);
  s.rings = 2;
  s.layers = 2;
  s.inner_radius = bore;
  return s;
}

}  // namespace symcell::solid::test
