#include "core/plane/delaunay/insert.hpp"
#include "core/plane/quotient/lifted_predicates.hpp"

namespace symcell::plane {

// Whether the other triangle's corner i lies inside the circle of the first, whose edge j they
// share.
bool Editor::must_flip(const Triangle& tri,
                       std::uint32_t j,
                       const Triangle& other,
                       std::uint32_t i) const {
  const std::uint32_t jn = next3(j), jp = prev3(j);
  // In one frame the sign is exact, and a point inside the circle beyond the edge makes the
  // quadrilateral strictly convex.
  if ((tri.k[0] | tri.k[1] | tri.k[2] | other.k[i] | tri.off[j]) == 0) {
    return in_circle(mesh_.point(tri.v[j]), mesh_.point(tri.v[jn]), mesh_.point(tri.v[jp]),
                     mesh_.point(other.v[i])) == Sign::kPositive;
  }
  const OrbitVertex p{tri.v[j], tri.k[j]}, a{tri.v[jn], tri.k[jn]}, b{tri.v[jp], tri.k[jp]};
  const OrbitVertex q{other.v[i], mesh_.shift(other.v[i], other.k[i], tri.off[j])};
  return in_circle(mesh_, p, a, b, q) == Sign::kPositive &&
         orientation(mesh_, p, a, q) == Sign::kPositive &&
         orientation(mesh_, q, b, p) == Sign::kPositive;
}

void Editor::legalise() {
  // Every flip strictly lowers the lifted surface (lifted_predicates.hpp), so this ends.
  while (!edges_.empty()) {
    const HalfEdge h = edges_.back();
    edges_.pop_back();
    const TriangleId t = triangle_of(h);
    const Triangle& tri = mesh_.triangle(t);
    const std::uint32_t j = local_of(h);
    if (tri.face < 0 || tri.seg[j] != kNoSubsegment || tri.nb[j] == kNoHalfEdge) continue;
    const TriangleId u = triangle_of(tri.nb[j]);
    if (u == t) continue;  // (o, a, Ra) is always locally Delaunay
    const Triangle& other = mesh_.triangle(u);
    const std::uint32_t i = local_of(tri.nb[j]);
    if (!must_flip(tri, j, other, i)) continue;
    if (tri.off[j] != 0) ++counters_.crossings;
    ++counters_.flips;
    mesh_.flip(h);
    created_.push_back(t);
    created_.push_back(u);
    edges_.push_back(3 * t + 0);
    edges_.push_back(3 * t + 2);
    edges_.push_back(3 * u + 0);
    edges_.push_back(3 * u + 2);
  }
}

}  // namespace symcell::plane
