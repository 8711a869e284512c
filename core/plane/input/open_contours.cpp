#include "core/plane/input/open_contours.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "core/base/index.hpp"
#include "core/base/union_find.hpp"
#include "core/model/describe.hpp"

namespace symcell::plane {
namespace {

// Ends of what hangs together all but meet if they are nearer to each other than this share of its length: a
// C of three equal strokes is none, an outline without one of forty teeth is. Ends of two parts must be
// nearer: centre lines and hatches lie side by side.
constexpr double kOpenShare = 0.05;
constexpr double kOpenShareOfTwo = 0.002;
// Pairs of ends that are looked at: a drawing with more is a hatching, whose ends mean nothing.
constexpr std::size_t kMostPairs = 10'000'000;

struct Part {
  double length = 0;
  std::vector<std::int32_t> ends;
  bool meshed = false;
};

}  // namespace

std::string describe_loose_ends(const Pslg& pslg, const LooseEnds& ends) {
  const auto vertex = [&](std::int32_t v) {
    return std::to_string(v) + " at " + describe_point(pslg.vertices[at(v)]);
  };
  return "vertices " + vertex(ends.a) + " and " + vertex(ends.b) + ", which are " +
         describe_rounded(ends.apart) + " apart";
}

OpenContours find_open_contours(const Pslg& pslg, const Subdomains& subdomains) {
  const PlanarMap& map = subdomains.map;
  OpenContours found;
  std::vector<std::int32_t> degree(pslg.vertices.size(), 0);
  UnionFind joined(pslg.vertices.size());
  std::vector<std::size_t> hanging;
  for (std::size_t p = 0; p < map.pieces.size(); ++p) {
    const PlanarPiece& piece = map.pieces[p];
    ++degree[at(piece.a)];
    ++degree[at(piece.b)];
    if (map.face[2 * p] != map.face[2 * p + 1]) continue;
    hanging.push_back(p);
    joined.join(piece.a, piece.b);
  }
  std::map<std::int32_t, Part> parts;
  for (const std::size_t p : hanging) {
    const PlanarPiece& piece = map.pieces[p];
    Part& part = parts[joined.root(piece.a)];
    part.length += distance(pslg.vertices[at(piece.a)], pslg.vertices[at(piece.b)]);
    part.meshed = subdomains.left_of(static_cast<std::int32_t>(2 * p)).meshed;
    for (const std::int32_t v : {piece.a, piece.b}) {
      if (degree[at(v)] == 1) part.ends.push_back(v);
    }
    if (part.meshed) continue;
    if (found.left_out++ == 0) found.left_out_at = pslg.vertices[at(piece.a)];
  }
  // By x: of each end the ends beside it that are near enough to matter.
  struct End {
    std::int32_t vertex;
    const Part* part;
  };
  std::vector<End> ends;
  double longest = 0;
  for (const auto& [root, part] : parts) {
    for (const std::int32_t v : part.ends) ends.push_back({v, &part});
    longest = std::max(longest, part.length);
  }
  const auto place = [&](const End& end) { return pslg.vertices[at(end.vertex)]; };
  std::sort(ends.begin(), ends.end(), [&](const End& p, const End& q) {
    return std::pair(place(p).x, p.vertex) < std::pair(place(q).x, q.vertex);
  });
  std::size_t looked_at = 0;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    for (std::size_t j = i + 1; j < ends.size() && looked_at < kMostPairs; ++j, ++looked_at) {
      const End &p = ends[i], &q = ends[j];
      if (place(q).x - place(p).x > kOpenShare * p.part->length &&
          place(q).x - place(p).x > kOpenShareOfTwo * longest) {
        break;
      }
      const double apart = distance(place(p), place(q));
      const double most = p.part == q.part
                              ? kOpenShare * p.part->length
                              : kOpenShareOfTwo * std::min(p.part->length, q.part->length);
      if (!(apart <= most)) continue;
      const LooseEnds pair{p.vertex, q.vertex, apart};
      if (p.part->meshed) {
        found.inside.push_back(pair);
      } else if (!found.outside || apart < found.outside->apart) {
        found.outside = pair;
      }
    }
  }
  return found;
}

}  // namespace symcell::plane
