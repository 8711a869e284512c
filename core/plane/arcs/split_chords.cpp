#include "core/plane/arcs/split_chords.hpp"

#include <algorithm>
#include <limits>
#include <tuple>
#include <vector>

#include "core/plane/symmetry/split_segment.hpp"

namespace symcell::plane {
namespace {

struct Split {
  std::int32_t segment = 0;
  VertexId vertex = 0;
  double share = 0;  // of the chord, from a

  [[nodiscard]] auto key() const { return std::tie(segment, vertex); }
};

// Of the copy that lies on the segment.
double share_of(Point2 x, Point2 a, Point2 b, const RotationTable& rotations) {
  const Point2 d = b - a;
  double share = 0.5, best = std::numeric_limits<double>::infinity();
  for (std::int32_t k = 0; k < rotations.fold(); ++k) {
    const Point2 q = rotations.rotate(x, k) - a;
    const double t = std::clamp(dot(q, d) / squared_length(d), 0.0, 1.0);
    const double off = squared_distance(q, t * d);
    if (off >= best) continue;
    best = off;
    share = t;
  }
  return share;
}

std::vector<Split> find_splits(const SymmetricPslg& pslg, const QuotientTriangulation& mesh) {
  std::vector<Split> splits;
  for (TriangleId t = 0; t < mesh.triangle_slots(); ++t) {
    if (!mesh.alive(t)) continue;
    const Triangle& tri = mesh.triangle(t);
    for (std::uint32_t j = 0; j < 3; ++j) {
      if (tri.seg[j] == kNoSubsegment) continue;
      const std::int32_t parent = mesh.subsegment(tri.seg[j]).parent;
      if (pslg.bulges[static_cast<std::size_t>(parent)] == 0) continue;
      for (const std::uint32_t i : {next3(j), prev3(j)}) {
        if (mesh.kind(tri.v[i]) == VertexKind::kSegment) splits.push_back({parent, tri.v[i], 0});
      }
    }
  }
  const auto by_key = [](const Split& x, const Split& y) { return x.key() < y.key(); };
  std::sort(splits.begin(), splits.end(), by_key);
  const auto same = [](const Split& x, const Split& y) { return x.key() == y.key(); };
  splits.erase(std::unique(splits.begin(), splits.end(), same), splits.end());
  return splits;
}

void measure_shares(const SymmetricPslg& pslg,
                    const QuotientTriangulation& mesh,
                    std::vector<Split>& splits) {
  for (Split& split : splits) {
    const SymmetricSegment& segment = pslg.segments[static_cast<std::size_t>(split.segment)];
    split.share = share_of(mesh.point(split.vertex), place_of(pslg, mesh.rotations(), segment.a),
                           place_of(pslg, mesh.rotations(), segment.b), mesh.rotations());
  }
  std::sort(splits.begin(), splits.end(), [](const Split& x, const Split& y) {
    return std::tie(x.segment, x.share, x.vertex) < std::tie(y.segment, y.share, y.vertex);
  });
}

}  // namespace

std::optional<SymmetricPslg> split_chords(const SymmetricPslg& pslg,
                                          const QuotientTriangulation& mesh) {
  if (pslg.bulges.empty()) return std::nullopt;
  std::vector<Split> splits = find_splits(pslg, mesh);
  if (splits.empty()) return std::nullopt;
  measure_shares(pslg, mesh, splits);
  SymmetricPslg result = pslg;
  std::vector<double> shares;
  for (std::size_t i = 0; i < splits.size();) {
    const auto s = static_cast<std::size_t>(splits[i].segment);
    shares.clear();
    for (; i < splits.size() && static_cast<std::size_t>(splits[i].segment) == s; ++i) {
      const double from = shares.empty() ? 0 : shares.back();
      if (splits[i].share > from && splits[i].share < 1) shares.push_back(splits[i].share);
    }
    split_segment(result, mesh.rotations(), s, shares);
  }
  return result;
}

std::size_t vertices_on_chords(const SymmetricPslg& pslg, const QuotientTriangulation& mesh) {
  return pslg.bulges.empty() ? 0 : find_splits(pslg, mesh).size();
}

}  // namespace symcell::plane
