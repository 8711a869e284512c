#include "core/plane/symmetry/chain_orbits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <string>

#include "core/base/index.hpp"
#include "core/geometry/point_tree.hpp"
#include "core/model/describe.hpp"

namespace symcell::plane {
namespace {

constexpr double kParts[] = {0.25, 0.5, 0.75};  // of a chain's length: places that are compared

class Matcher {
 public:
  Matcher(const PreparedPslg& prepared,
          const SegmentIndex& index,
          const Chains& chains,
          std::int32_t fold,
          Point2 centre,
          std::int32_t centre_point,
          double reach)
      : prepared_(prepared),
        index_(index),
        chains_(chains),
        fold_(fold),
        centre_(centre),
        centre_point_(centre_point),
        reach_(reach),
        cosine_(std::cos(2 * std::numbers::pi / fold)),
        sine_(std::sin(2 * std::numbers::pi / fold)) {}

  Result<ChainOrbits> run() {
    image_of_.assign(prepared_.points.size(), -1);
    if (centre_point_ >= 0) image_of_[at(centre_point_)] = centre_point_;
    SYMCELL_TRY(match_points(chains_.junctions));
    SYMCELL_TRY(match_points(chains_.lone));
    SYMCELL_TRY(match_chains());
    SYMCELL_TRY(list_point_orbits());
    SYMCELL_TRY(list_chain_orbits());
    return std::move(result_);
  }

 private:
  [[nodiscard]] Point2 image(Point2 p) const {
    const Point2 q = p - centre_;
    return {centre_.x + cosine_ * q.x - sine_ * q.y, centre_.y + sine_ * q.x + cosine_ * q.y};
  }

  [[nodiscard]] Failure no_image(std::int32_t point) const {
    const std::int32_t vertex = prepared_.input_vertex[at(point)];
    return fail(ErrorCode::kNotSymmetric,
                "vertex " + std::to_string(vertex) + " at " +
                    describe_point(prepared_.points[at(point)]) +
                    ", where segments meet or change their kind, has no counterpart in each sector",
                {vertex}, "/vertices/" + std::to_string(vertex));
  }

  [[nodiscard]] Failure no_image(const Chain& chain) const {
    return fail(ErrorCode::kNotSymmetric,
                "segment " + std::to_string(chain.kind.segment) +
                    " belongs to an outline that has no counterpart in each sector",
                {chain.kind.segment}, "/segments/" + std::to_string(chain.kind.segment));
  }

  Result<void> match_points(const std::vector<std::int32_t>& points) {
    std::vector<Point3> places;
    places.reserve(points.size());
    for (const std::int32_t p : points) {
      places.push_back({prepared_.points[at(p)].x, prepared_.points[at(p)].y, 0});
    }
    const PointTree tree(places);
    std::vector<char> taken(points.size(), 0);
    for (const std::int32_t p : points) {
      if (p == centre_point_) continue;
      const Point2 q = image(prepared_.points[at(p)]);
      const PointTree::Hit hit = tree.nearest({q.x, q.y, 0});
      const bool found = hit.point >= 0 && hit.distance <= reach_ && taken[at(hit.point)] == 0;
      if (!found) return no_image(p);
      const std::int32_t other = points[at(hit.point)];
      if (other == centre_point_ || chains_.degree[at(other)] != chains_.degree[at(p)]) {
        return no_image(p);
      }
      taken[at(hit.point)] = 1;
      image_of_[at(p)] = other;
    }
    return {};
  }

  [[nodiscard]] bool alike(const PreparedEdge& s, const PreparedEdge& t, bool reversed) const {
    if (s.marker != t.marker && !prepared_.ignore_markers) return false;
    return reversed ? s.left == t.right && s.right == t.left
                    : s.left == t.left && s.right == t.right;
  }

  [[nodiscard]] std::vector<Point2> parts_of(const Chain& chain) const {
    std::vector<double> ends;
    double whole = 0;
    for (std::size_t i = 1; i < chain.points.size(); ++i) {
      whole += distance(prepared_.points[at(chain.points[i - 1])],
                        prepared_.points[at(chain.points[i])]);
      ends.push_back(whole);
    }
    std::vector<Point2> result;
    for (const double part : kParts) {
      const auto end = std::lower_bound(ends.begin(), ends.end() - 1, part * whole);
      const auto i = static_cast<std::size_t>(end - ends.begin());
      const double before = i > 0 ? ends[i - 1] : 0;
      const Point2 a = prepared_.points[at(chain.points[i])];
      const Point2 b = prepared_.points[at(chain.points[i + 1])];
      const double share = ends[i] > before ? (part * whole - before) / (ends[i] - before) : 0;
      result.push_back(a + share * (b - a));
    }
    return result;
  }

  Result<void> match_chains() {
    std::map<std::pair<std::int32_t, std::int32_t>, std::vector<std::int32_t>> between;
    parts_.resize(chains_.chains.size());
    for (std::size_t c = 0; c < chains_.chains.size(); ++c) {
      const Chain& chain = chains_.chains[c];
      if (chain.loop) continue;
      parts_[c] = parts_of(chain);
      between[std::minmax(chain.first(), chain.last())].push_back(static_cast<std::int32_t>(c));
    }
    chain_of_edge_points();
    images_.resize(chains_.chains.size());
    std::vector<char> taken(chains_.chains.size(), 0);
    for (std::size_t c = 0; c < chains_.chains.size(); ++c) {
      const Chain& chain = chains_.chains[c];
      ChainCopy found{-1, false};
      if (chain.loop) {
        found.chain = loop_at(chain);
      } else {
        const std::int32_t a = image_of_[at(chain.first())];
        const std::int32_t b = image_of_[at(chain.last())];
        const auto candidates = between.find(std::minmax(a, b));
        if (candidates != between.end()) found = nearest(c, a, candidates->second);
      }
      if (found.chain < 0 || taken[at(found.chain)] != 0) return no_image(chain);
      taken[at(found.chain)] = 1;
      images_[c] = found;
    }
    return {};
  }

  // Of the chains between the images of both junctions, that which runs where the image does.
  [[nodiscard]] ChainCopy nearest(std::size_t c,
                                  std::int32_t first,
                                  const std::vector<std::int32_t>& candidates) const {
    const Chain& chain = chains_.chains[c];
    ChainCopy best{-1, false};
    double least = std::numeric_limits<double>::infinity();
    for (const std::int32_t other : candidates) {
      const Chain& candidate = chains_.chains[at(other)];
      for (const bool reversed : {false, true}) {
        if ((reversed ? candidate.last() : candidate.first()) != first) continue;
        if (!alike(chain.kind, candidate.kind, reversed)) continue;
        double off = 0;
        for (std::size_t i = 0; i < std::size(kParts); ++i) {
          const std::size_t j = reversed ? std::size(kParts) - 1 - i : i;
          off += distance(image(parts_[c][i]), parts_[at(other)][j]);
        }
        if (off >= least) continue;
        least = off;
        best = {other, reversed};
      }
    }
    return best;
  }

  void chain_of_edge_points() {
    std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> chain_of;
    for (std::size_t c = 0; c < chains_.chains.size(); ++c) {
      const Chain& chain = chains_.chains[c];
      if (!chain.loop) continue;
      for (std::size_t i = 0; i < chain.points.size(); ++i) {
        const std::int32_t next = chain.points[(i + 1) % chain.points.size()];
        chain_of[std::minmax(chain.points[i], next)] = static_cast<std::int32_t>(c);
      }
    }
    loop_of_edge_.assign(prepared_.edges.size(), -1);
    for (std::size_t e = 0; e < prepared_.edges.size(); ++e) {
      const auto found = chain_of.find(std::minmax(prepared_.edges[e].a, prepared_.edges[e].b));
      if (found != chain_of.end()) loop_of_edge_[e] = found->second;
    }
  }

  // The loop that the image of a loop's first vertex lies on. Both run counterclockwise.
  [[nodiscard]] std::int32_t loop_at(const Chain& chain) const {
    const auto likely = [&](std::int32_t e) {
      const std::int32_t other = loop_of_edge_[at(e)];
      return other >= 0 && alike(chain.kind, chains_.chains[at(other)].kind, false);
    };
    const Point2 q = image(prepared_.points[at(chain.points.front())]);
    const SegmentIndex::Hit hit = index_.nearest(q, reach_, likely);
    return hit.segment < 0 ? -1 : loop_of_edge_[at(hit.segment)];
  }

  Result<void> list_point_orbits() {
    std::vector<char> seen(prepared_.points.size(), 0);
    for (const auto* points : {&chains_.junctions, &chains_.lone}) {
      for (const std::int32_t p : *points) {
        if (seen[at(p)] != 0 || p == centre_point_) continue;
        std::vector<std::int32_t> orbit;
        for (std::int32_t q = p; seen[at(q)] == 0; q = image_of_[at(q)]) {
          seen[at(q)] = 1;
          orbit.push_back(q);
        }
        if (std::ssize(orbit) != fold_) return no_image(p);
        result_.points.push_back(std::move(orbit));
      }
    }
    return {};
  }

  Result<void> list_chain_orbits() {
    std::vector<char> seen(chains_.chains.size(), 0);
    for (std::size_t c = 0; c < seen.size(); ++c) {
      if (seen[c] != 0) continue;
      std::vector<ChainCopy> orbit;
      ChainCopy copy{static_cast<std::int32_t>(c), false};
      while (seen[at(copy.chain)] == 0) {
        seen[at(copy.chain)] = 1;
        orbit.push_back(copy);
        const ChainCopy& next = images_[at(copy.chain)];
        copy = {next.chain, copy.reversed != next.reversed};
      }
      const bool round = chains_.chains[c].loop && orbit.size() == 1;
      if ((std::ssize(orbit) != fold_ && !round) || copy.reversed) {
        return no_image(chains_.chains[c]);
      }
      result_.chains.push_back(std::move(orbit));
    }
    return {};
  }

  const PreparedPslg& prepared_;
  const SegmentIndex& index_;
  const Chains& chains_;
  std::int32_t fold_;
  Point2 centre_;
  std::int32_t centre_point_;
  double reach_;
  double cosine_;
  double sine_;
  std::vector<std::int32_t> image_of_;      // per point; of junctions and lone vertices
  std::vector<ChainCopy> images_;           // per chain
  std::vector<std::vector<Point2>> parts_;  // per chain that is no loop: its places
  std::vector<std::int32_t> loop_of_edge_;  // -1: of no loop
  ChainOrbits result_;
};

}  // namespace

Result<ChainOrbits> find_chain_orbits(const PreparedPslg& prepared,
                                      const SegmentIndex& index,
                                      const Chains& chains,
                                      std::int32_t fold,
                                      Point2 centre,
                                      std::int32_t centre_point,
                                      double reach) {
  return Matcher(prepared, index, chains, fold, centre, centre_point, reach).run();
}

}  // namespace symcell::plane
