// Quotient meshes of small models, and what tests ask of any quotient mesh.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "core/base/execution_context.hpp"
#include "core/plane/initial/initial_triangulation.hpp"
#include "core/plane/quotient/validate.hpp"
#include "core/plane/symmetry/symmetrise.hpp"
#include "tests/support/pslg_builders.hpp"

namespace symcell::plane::test {

struct QuotientSample {
  SymmetricPslg pslg;
  InitialTriangulation start;
  [[nodiscard]] QuotientTriangulation& mesh() { return start.mesh; }
};

// Requires: a valid model; fails the test and throws otherwise.
inline QuotientSample triangulated(const Pslg& model, std::int32_t fold) {
  ExecutionContext context;
  MeshOptions options;
  options.fold = fold;
  auto symmetric = symmetrise(model, options, context);
  EXPECT_TRUE(symmetric) << symmetric.error().message;
  auto start = triangulate_initial(symmetric.value(), context);
  EXPECT_TRUE(start) << start.error().message;
  return {std::move(symmetric.value()), std::move(start.value())};
}

inline QuotientSample random_sample(std::uint64_t seed, std::int32_t fold) {
  return triangulated(random_symmetric_pslg(seed, fold, nullptr), fold);
}

// A polygon of `fold` sides about its centre: one triangle (o, a, Ra) with `spokes` on its sides.
inline QuotientSample wheel(std::int32_t fold, bool spokes) {
  SectorBuilder builder(fold);
  const auto rim = builder.add_vertex({1, 0});
  builder.add_loop({rim}, 1);
  const auto centre = builder.add_centre();
  if (spokes) builder.add_segment(rim, centre, 2);
  return triangulated(builder.pslg(), fold);
}

// Several small squares off the centre, one a sector: the pieces do not wrap round it.
inline QuotientSample pads(std::int32_t fold) {
  SectorBuilder builder(fold);
  const double side = 1.0 / fold;
  const auto a = builder.add_vertex({1, -side}), b = builder.add_vertex({1 + side, -side}),
             c = builder.add_vertex({1 + side, side}), d = builder.add_vertex({1, side});
  builder.add_closed({a, b, c, d}, 1);
  return triangulated(builder.pslg(), fold);
}

inline void expect_delaunay(const QuotientTriangulation& mesh) {
  const auto ok = validate(mesh, ValidationLevel::kDelaunay);
  EXPECT_TRUE(ok) << ok.error().message;
}

inline std::vector<TriangleId> live_triangles(const QuotientTriangulation& mesh) {
  std::vector<TriangleId> result;
  for (TriangleId t = 0; t < mesh.triangle_slots(); ++t) {
    if (mesh.alive(t)) result.push_back(t);
  }
  return result;
}

inline std::size_t live_subsegments(const QuotientTriangulation& mesh) {
  std::size_t count = 0;
  for (std::size_t s = 0; s < mesh.subsegment_slots(); ++s) {
    count += mesh.subsegment(static_cast<SubsegmentId>(s)).alive ? 1 : 0;
  }
  return count;
}

inline double area(const QuotientTriangulation& mesh) {
  double sum = 0;
  for (const TriangleId t : live_triangles(mesh)) {
    const Triangle& tri = mesh.triangle(t);
    const Point2 a = mesh.corner_point(tri, 0), b = mesh.corner_point(tri, 1),
                 c = mesh.corner_point(tri, 2);
    sum += 0.5 * cross(b - a, c - a);
  }
  return sum;
}

// Everything that a mesh means: corners, neighbours, subsegments; no scratch.
inline bool same_content(const QuotientTriangulation& a, const QuotientTriangulation& b) {
  if (a.triangle_slots() != b.triangle_slots() || a.vertex_slots() != b.vertex_slots() ||
      a.subsegment_slots() != b.subsegment_slots() || a.triangle_count() != b.triangle_count()) {
    return false;
  }
  for (TriangleId t = 0; t < a.triangle_slots(); ++t) {
    const Triangle &x = a.triangle(t), &y = b.triangle(t);
    if (x.face != y.face) return false;
    if (x.face < 0) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      if (x.v[i] != y.v[i] || x.k[i] != y.k[i] || x.nb[i] != y.nb[i] || x.off[i] != y.off[i] ||
          x.seg[i] != y.seg[i]) {
        return false;
      }
    }
  }
  for (std::size_t i = 0; i < a.vertex_slots(); ++i) {
    const auto v = static_cast<VertexId>(i);
    if (a.kind(v) != b.kind(v)) return false;
    if (a.kind(v) == VertexKind::kDeleted) continue;
    if (!(a.point(v) == b.point(v)) || a.corner_of(v) != b.corner_of(v)) return false;
  }
  for (std::size_t i = 0; i < a.subsegment_slots(); ++i) {
    const Subsegment &x = a.subsegment(static_cast<SubsegmentId>(i)),
                     &y = b.subsegment(static_cast<SubsegmentId>(i));
    if (x.alive != y.alive) return false;
    if (x.alive && (x.half_edge != y.half_edge || x.parent != y.parent)) return false;
  }
  return true;
}

// Random choices among the parts of a mesh; the same seed gives the same ones.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(engine_() % n); }
  TriangleId triangle(const QuotientTriangulation& mesh) {
    const std::vector<TriangleId> live = live_triangles(mesh);
    return live[below(live.size())];
  }
  Point2 point_in(const QuotientTriangulation& mesh, TriangleId t) {
    const double u = uniform(0.1, 0.8), v = uniform(0.1, 0.9 - u);
    const Triangle& tri = mesh.triangle(t);
    return u * mesh.corner_point(tri, 0) + v * mesh.corner_point(tri, 1) +
           (1 - u - v) * mesh.corner_point(tri, 2);
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace symcell::plane::test
