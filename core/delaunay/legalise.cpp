#include "core/delaunay/insert.hpp"
#include "core/delaunay/lifted_predicates.hpp"

namespace symcell {

void DelaunayEditor::legalise() {
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
    const Corner p{tri.v[j], tri.k[j]};
    const Corner a{tri.v[next3(j)], tri.k[next3(j)]}, b{tri.v[prev3(j)], tri.k[prev3(j)]};
    const Corner q{other.v[i], mesh_.shift(other.v[i], other.k[i], tri.off[j])};
    if (in_circle(mesh_, p, a, b, q) != Sign::kPositive) continue;
    if (orientation(mesh_, p, a, q) != Sign::kPositive ||
        orientation(mesh_, q, b, p) != Sign::kPositive) {
      continue;
    }
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

}  // namespace symcell
