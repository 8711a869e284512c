#include "core/plane/quotient/validate.hpp"

#include <string>

#include "core/geometry/tolerances.hpp"
#include "core/plane/quotient/lifted_predicates.hpp"

namespace symcell::plane {
namespace {

Result<void> broken(const char* layer, TriangleId t, std::uint32_t j, const char* what) {
  return fail(ErrorCode::kInternal,
              std::string("mesh check '") + layer + "': triangle " + std::to_string(t) + ", edge " +
                  std::to_string(j) + ": " + what,
              {static_cast<std::int64_t>(t)});
}

Result<void> check_elements(const QuotientTriangulation& mesh, TriangleId t) {
  const Triangle& tri = mesh.triangle(t);
  for (std::uint32_t i = 0; i < 3; ++i) {
    const VertexId v = tri.v[i];
    if (v < 0 || static_cast<std::size_t>(v) >= mesh.vertex_slots() ||
        mesh.kind(v) == VertexKind::kDeleted) {
      return broken("elements", t, i, "corner is no vertex");
    }
    if (tri.k[i] < 0 || tri.k[i] >= mesh.fold() || tri.off[i] < 0 || tri.off[i] >= mesh.fold()) {
      return broken("elements", t, i, "exponent out of range");
    }
    if (v == mesh.centre() && tri.k[i] != 0) return broken("elements", t, i, "centre exponent");
    const std::uint32_t n = next3(i);
    if (v == tri.v[n] && tri.k[i] == tri.k[n]) return broken("elements", t, i, "corners repeat");
  }
  return {};
}

Result<void> check_incidence(const QuotientTriangulation& mesh, TriangleId t) {
  const Triangle& tri = mesh.triangle(t);
  for (std::uint32_t j = 0; j < 3; ++j) {
    if (tri.seg[j] != kNoSubsegment && !mesh.subsegment(tri.seg[j]).alive) {
      return broken("incidence", t, j, "subsegment is not alive");
    }
    const HalfEdge g = tri.nb[j];
    if (g == kNoHalfEdge) {
      if (tri.seg[j] == kNoSubsegment) return broken("incidence", t, j, "open edge, no subsegment");
      continue;
    }
    if (triangle_of(g) >= mesh.triangle_slots() || !mesh.alive(triangle_of(g))) {
      return broken("incidence", t, j, "neighbour is not alive");
    }
    const Triangle& other = mesh.triangle(triangle_of(g));
    const std::uint32_t i = local_of(g);
    if (other.nb[i] != 3 * t + j) return broken("incidence", t, j, "neighbour does not point back");
    if (mesh.add(tri.off[j], other.off[i]) != 0) return broken("incidence", t, j, "exponents");
    if (tri.seg[j] != other.seg[i]) return broken("incidence", t, j, "subsegments differ");
    const std::uint32_t mine[2] = {next3(j), prev3(j)}, theirs[2] = {prev3(i), next3(i)};
    for (int c = 0; c < 2; ++c) {
      const VertexId v = tri.v[mine[c]];
      if (v != other.v[theirs[c]] ||
          tri.k[mine[c]] != mesh.shift(v, other.k[theirs[c]], tri.off[j])) {
        return broken("incidence", t, j, "corners differ across the edge");
      }
    }
  }
  return {};
}

Result<void> check_embedding(const QuotientTriangulation& mesh, TriangleId t) {
  const Triangle& tri = mesh.triangle(t);
  const Point2 a = mesh.corner_point(tri, 0), b = mesh.corner_point(tri, 1),
               c = mesh.corner_point(tri, 2);
  if (orientation(a, b, c) != Sign::kPositive) {
    return broken("embedding", t, 0, "not positively oriented");
  }
  return {};
}

Result<void> check_delaunay(const QuotientTriangulation& mesh, TriangleId t) {
  const Triangle& tri = mesh.triangle(t);
  for (std::uint32_t j = 0; j < 3; ++j) {
    const HalfEdge g = tri.nb[j];
    if (g == kNoHalfEdge || tri.seg[j] != kNoSubsegment || triangle_of(g) == t) continue;
    const Triangle& other = mesh.triangle(triangle_of(g));
    const std::uint32_t i = local_of(g);
    const OrbitVertex q{other.v[i], mesh.shift(other.v[i], other.k[i], tri.off[j])};
    if (in_circle(mesh, {tri.v[0], tri.k[0]}, {tri.v[1], tri.k[1]}, {tri.v[2], tri.k[2]}, q,
                  kTieSlack) == Sign::kPositive) {
      return broken("delaunay", t, j, "not locally Delaunay");
    }
  }
  return {};
}

}  // namespace

Result<void> validate(const QuotientTriangulation& mesh, ValidationLevel level) {
  using Check = Result<void> (*)(const QuotientTriangulation&, TriangleId);
  // In the order of ValidationLevel.
  constexpr Check kLayers[] = {check_elements, check_incidence, check_embedding, check_delaunay};
  for (std::size_t layer = 0; layer <= static_cast<std::size_t>(level); ++layer) {
    for (TriangleId t = 0; t < mesh.triangle_slots(); ++t) {
      if (!mesh.alive(t)) continue;
      SYMCELL_TRY(kLayers[layer](mesh, t));
    }
  }
  return {};
}

}  // namespace symcell::plane
