#include "core/plane/input/arc_chains.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/index.hpp"
#include "core/geometry/arc.hpp"
#include "core/geometry/point_tree.hpp"

namespace symcell::plane {
namespace {

// From vertex to vertex, with none between.
struct Piece {
  std::int32_t a = 0;
  std::int32_t b = 0;
  std::int32_t segment = 0;
  Point2 centre;
  double radius = 0;
  double angle = 0;
};

class Chainer {
 public:
  Chainer(const Pslg& pslg, double tolerance, const std::vector<char>& keeps)
      : pslg_(pslg), tolerance_(tolerance), keeps_(keeps) {}

  ArcChains run() {
    cut_at_vertices();
    find_joints();
    used_.assign(pieces_.size(), 0);
    // From ends first; what is left are circles.
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
      if (result_.is_joint[at(pieces_[p].a)] == 0) follow(static_cast<std::int32_t>(p), false);
    }
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
      if (result_.is_joint[at(pieces_[p].b)] == 0) follow(static_cast<std::int32_t>(p), true);
    }
    for (std::size_t p = 0; p < pieces_.size(); ++p) follow(static_cast<std::int32_t>(p), false);
    return std::move(result_);
  }

 private:
  void cut_at_vertices() {
    std::vector<Point3> places;
    places.reserve(pslg_.vertices.size());
    for (const Point2 p : pslg_.vertices) places.push_back({p.x, p.y, 0});
    const PointTree tree(places);
    for (std::size_t s = 0; s < pslg_.segments.size(); ++s) {
      if (pslg_.bulge(s) == 0) continue;
      cut(static_cast<std::int32_t>(s), tree);
    }
  }

  void cut(std::int32_t s, const PointTree& tree) {
    const PslgSegment& segment = pslg_.segments[at(s)];
    const Point2 a = pslg_.vertices[at(segment.a)], b = pslg_.vertices[at(segment.b)];
    const double bulge = pslg_.bulge(at(s));
    const Point2 centre = arc_centre(a, b, bulge);
    const double radius = arc_radius(a, b, bulge), angle = angle_of_bulge(bulge);
    // The box of a shallow arc is far smaller than its circle's.
    Point2 low{std::min(a.x, b.x), std::min(a.y, b.y)},
        high{std::max(a.x, b.x), std::max(a.y, b.y)};
    const double side = std::abs(angle) < std::numbers::pi / 2
                            ? std::abs(bulge) * distance(a, b) / 2 + tolerance_
                            : 2 * radius + tolerance_;
    std::vector<std::pair<double, std::int32_t>> cuts;  // angle from a, vertex
    tree.within_box({low.x - side, low.y - side, 0}, {high.x + side, high.y + side, 0},
                    [&](std::int32_t v) {
                      if (v == segment.a || v == segment.b) return;
                      const Point2 p = pslg_.vertices[at(v)];
                      if (std::abs(distance(p, centre) - radius) > tolerance_) return;
                      const double turn = angle_between(a - centre, p - centre, angle);
                      const double margin = tolerance_ / radius;
                      if (turn <= margin || turn >= std::abs(angle) - margin) return;
                      cuts.emplace_back(turn, v);
                    });
    std::sort(cuts.begin(), cuts.end());
    double from = 0;
    std::int32_t last = segment.a;
    cuts.emplace_back(std::abs(angle), segment.b);
    for (const auto& [turn, v] : cuts) {
      pieces_.push_back({last, v, s, centre, radius, std::copysign(turn - from, angle)});
      last = v;
      from = turn;
    }
  }

  // From u to v in the sense of `sense`, in [0, 2 pi).
  static double angle_between(Point2 u, Point2 v, double sense) {
    const double angle = std::copysign(1, sense) * std::atan2(cross(u, v), dot(u, v));
    return angle < 0 ? angle + 2 * std::numbers::pi : angle;
  }

  void find_joints() {
    std::vector<std::int32_t> degree(pslg_.vertices.size(), 0);
    ends_.assign(pslg_.vertices.size(), {-1, -1});
    const auto meet = [&](std::int32_t v, std::int32_t piece) {
      if (degree[at(v)] < 2) ends_[at(v)][at(degree[at(v)])] = piece;
      ++degree[at(v)];
    };
    for (std::size_t s = 0; s < pslg_.segments.size(); ++s) {
      if (pslg_.bulge(s) != 0) continue;
      meet(pslg_.segments[s].a, -1);
      meet(pslg_.segments[s].b, -1);
    }
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
      meet(pieces_[p].a, static_cast<std::int32_t>(p));
      meet(pieces_[p].b, static_cast<std::int32_t>(p));
    }
    result_.is_joint.assign(pslg_.vertices.size(), 0);
    for (std::size_t v = 0; v < degree.size(); ++v) {
      const auto [p, q] = ends_[v];
      if (degree[v] != 2 || p < 0 || q < 0 || p == q || keeps_[v] != 0) continue;
      result_.is_joint[v] = goes_on(piece(p), piece(q), static_cast<std::int32_t>(v)) ? 1 : 0;
    }
  }

  [[nodiscard]] bool goes_on(const Piece& p, const Piece& q, std::int32_t v) const {
    if (pslg_.segments[at(p.segment)].marker != pslg_.segments[at(q.segment)].marker) return false;
    if (distance(p.centre, q.centre) > tolerance_) return false;
    if (std::abs(p.radius - q.radius) > tolerance_) return false;
    // One ends where the other begins, seen in one sense.
    const double p_sense = p.b == v ? p.angle : -p.angle;
    const double q_sense = q.a == v ? q.angle : -q.angle;
    return p_sense * q_sense > 0;
  }

  // The chain that begins with a piece, turned about if it is entered at its end.
  void follow(std::int32_t first, bool backwards) {
    if (used_[at(first)] != 0) return;
    ArcChain chain;
    const Piece& start = piece(first);
    chain.centre = start.centre;
    chain.radius = start.radius;
    chain.marker = pslg_.segments[at(start.segment)].marker;
    chain.a = backwards ? start.b : start.a;
    const std::int32_t begin = chain.a;
    std::int32_t p = first, v = begin;
    while (true) {
      used_[at(p)] = 1;
      const Piece& own = piece(p);
      chain.angle += own.a == v ? own.angle : -own.angle;
      if (chain.segments.empty() || chain.segments.back() != own.segment) {
        chain.segments.push_back(own.segment);
      }
      v = own.a == v ? own.b : own.a;
      if (result_.is_joint[at(v)] == 0 || v == begin) break;
      chain.joints.push_back(v);
      const auto [x, y] = ends_[at(v)];
      p = x == p ? y : x;
    }
    chain.b = v;
    if (v == begin && result_.is_joint[at(v)] != 0) {
      chain.joints.insert(chain.joints.begin(), v);
      chain.a = chain.b = -1;
    }
    result_.chains.push_back(std::move(chain));
  }

  [[nodiscard]] const Piece& piece(std::int32_t p) const { return pieces_[at(p)]; }

  const Pslg& pslg_;
  double tolerance_;
  const std::vector<char>& keeps_;
  std::vector<Piece> pieces_;
  std::vector<std::array<std::int32_t, 2>> ends_;  // per vertex: the first two pieces, -1: straight
  std::vector<char> used_;                         // per piece
  ArcChains result_;
};

}  // namespace

ArcChains chain_arcs(const Pslg& pslg, double tolerance, const std::vector<char>& keeps) {
  return Chainer(pslg, tolerance, keeps).run();
}

}  // namespace symcell::plane
