#include "core/verify/model_as_meshed.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/base/index.hpp"
#include "core/geometry/arc.hpp"
#include "core/geometry/point_tree.hpp"
#include "core/plane/input/arc_chains.hpp"
#include "core/plane/input/planar_input.hpp"
#include "core/plane/input/validate_pslg.hpp"

namespace symcell::internal {
namespace {

// Of the diameter: as far as symmetrising moves vertices without being asked to.
constexpr double kOnArcRel = kExactSymmetryToleranceRel;
constexpr double kSameCircleRel = 1e-9;
// Radians: a little more than the coarsest chord that can be asked for.
constexpr double kCoarsest = 1.06;

// A node of an arc may be off it by the asymmetry of the arc's ends and by as much again where it was
// averaged, on either side, and an arc's middle moves with both of its ends.
constexpr double kArcAsymmetries = 8;
// Of an arc's radius: a node that is farther off it is of another one.
constexpr double kMostOfRadius = 0.02;
// Of the diameter: what is farther from the nearest copy has none.
constexpr double kNearMissOfArcsRel = 1e-3;

double diameter_of(const std::vector<Point2>& points) {
  Point2 low = points.front(), high = low;
  for (const Point2 p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  return distance(low, high);
}

// How far ends of arcs are from the nearest end that is turned onto them, at most.
double asymmetry_of_arcs(const Pslg& pslg,
                         const std::function<Point3(const Point3&)>& rotate,
                         double near) {
  std::vector<Point3> ends;
  for (std::size_t s = 0; s < pslg.segments.size(); ++s) {
    if (pslg.bulge(s) == 0) continue;
    for (const std::int32_t v : {pslg.segments[s].a, pslg.segments[s].b}) {
      ends.push_back({pslg.vertices[at(v)].x, pslg.vertices[at(v)].y, 0});
    }
  }
  const PointTree tree(ends);
  double worst = 0;
  for (const Point3& p : ends) {
    const double miss = tree.nearest(rotate(p)).distance;
    if (miss < near) worst = std::max(worst, miss);
  }
  return worst;
}

class ArcsAtNodes {
 public:
  ArcsAtNodes(Pslg pslg,
              std::span<const Point3> corners,
              double least_tolerance,
              double tolerance,
              double same_circle)
      : pslg_(std::move(pslg)),
        corners_(corners),
        tree_(corners),
        least_tolerance_(least_tolerance),
        tolerance_(tolerance) {
    std::vector<char> is_node(pslg_.vertices.size());
    for (std::size_t v = 0; v < is_node.size(); ++v) {
      const Point2 p = pslg_.vertices[v];
      is_node[v] = tree_.nearest({p.x, p.y, 0}).distance <= tolerance ? 1 : 0;
    }
    arcs_ = plane::chain_arcs(pslg_, same_circle, is_node);
  }

  ModelAsMeshed run() {
    copy_what_stays();
    for (const plane::ArcChain& chain : arcs_.chains) add(chain);
    return std::move(result_);
  }

 private:
  void copy_what_stays() {
    Pslg& out = result_.pslg;
    number_.assign(pslg_.vertices.size(), -1);
    for (std::size_t v = 0; v < number_.size(); ++v) {
      if (arcs_.is_joint[v] != 0) continue;
      number_[v] = static_cast<std::int32_t>(out.vertices.size());
      out.vertices.push_back(pslg_.vertices[v]);
    }
    for (std::size_t s = 0; s < pslg_.segments.size(); ++s) {
      if (pslg_.bulge(s) != 0) continue;
      const PslgSegment& segment = pslg_.segments[s];
      out.segments.push_back({number_[at(segment.a)], number_[at(segment.b)], segment.marker});
    }
    out.holes = pslg_.holes;
    out.regions = pslg_.regions;
  }

  // Nodes on the chain but for its ends, by their angle from its beginning.
  [[nodiscard]] std::vector<std::pair<double, Point2>> nodes_on(const plane::ArcChain& chain,
                                                                Point2 begin) const {
    std::vector<std::pair<double, Point2>> nodes;
    // Small arcs need not be found as far off as large ones may have been moved.
    const double tolerance =
        std::max(least_tolerance_, std::min(tolerance_, kMostOfRadius * chain.radius));
    const double side = chain.radius + tolerance;
    const Point2 c = chain.centre, u = begin - c;
    const double margin = 2 * tolerance / chain.radius;
    tree_.within_box({c.x - side, c.y - side, 0}, {c.x + side, c.y + side, 0},
                     [&](std::int32_t node) {
                       const Point2 p{corners_[at(node)].x, corners_[at(node)].y};
                       if (std::abs(distance(p, c) - chain.radius) > tolerance) return;
                       const double sense = std::copysign(1, chain.angle);
                       double turn = sense * std::atan2(cross(u, p - c), dot(u, p - c));
                       if (turn < 0) turn += 2 * std::numbers::pi;
                       if (turn > margin && turn < std::abs(chain.angle) - margin) {
                         nodes.emplace_back(turn, p);
                       }
                     });
    std::sort(nodes.begin(), nodes.end(),
              [](const auto& x, const auto& y) { return x.first < y.first; });
    const auto same = [&](const auto& x, const auto& y) { return y.first - x.first <= margin; };
    nodes.erase(std::unique(nodes.begin(), nodes.end(), same), nodes.end());
    return nodes;
  }

  void add(const plane::ArcChain& chain) {
    Pslg& out = result_.pslg;
    Point2 begin;
    std::int32_t first = -1;
    if (chain.whole()) {
      const Point2 any = pslg_.vertices[at(chain.joints.front())];
      const auto nodes = nodes_on(chain, any);
      if (nodes.empty()) return note_coarse(chain);
      begin = nodes.front().second;
      first = static_cast<std::int32_t>(out.vertices.size());
      out.vertices.push_back(begin);
    } else {
      begin = pslg_.vertices[at(chain.a)];
      first = number_[at(chain.a)];
    }
    const double sense = std::copysign(1, chain.angle);
    std::int32_t last = first;
    double from = 0;
    const auto add_chord = [&](std::int32_t v, double to) {
      if (to - from > kCoarsest) note_coarse(chain);
      out.segments.push_back({last, v, chain.marker});
      const Point2 mid = arc_middle(out.vertices[at(last)], out.vertices[at(v)],
                                    bulge_of_angle(sense * (to - from)));
      result_.arc_middles.push_back({mid.x, mid.y, 0});
      last = v;
      from = to;
    };
    for (const auto& [turn, p] : nodes_on(chain, begin)) {
      out.vertices.push_back(p);
      add_chord(static_cast<std::int32_t>(out.vertices.size() - 1), turn);
    }
    add_chord(chain.whole() ? first : number_[at(chain.b)], std::abs(chain.angle));
  }

  void note_coarse(const plane::ArcChain& chain) {
    if (!result_.coarse.empty()) return;
    result_.coarse =
        "the arc of segment " + std::to_string(chain.segments.front()) + " has too few nodes";
  }

  Pslg pslg_;
  std::span<const Point3> corners_;
  PointTree tree_;
  double least_tolerance_;
  double tolerance_;
  plane::ArcChains arcs_;
  std::vector<std::int32_t> number_;
  ModelAsMeshed result_;
};

}  // namespace

Result<std::optional<ModelAsMeshed>> model_as_meshed(
    const Pslg& model,
    std::span<const Point3> corners,
    const std::function<Point3(const Point3&)>& rotate,
    const VerifyOptions& options) {
  MeshOptions asked;
  asked.sector = options.sector;
  asked.center = options.center;
  asked.repair = options.repair;
  asked.symmetry_tolerance_rel = options.symmetry_tolerance_rel;
  ExecutionContext context;
  auto input = plane::prepare_input(model, asked, context);
  if (!input) return error_of(input);
  const bool arcs = *input ? (*input)->pslg.has_arcs() : model.has_arcs();
  if (!*input && !arcs) return std::optional<ModelAsMeshed>{};
  Pslg pslg;
  if (*input) {
    pslg = std::move((*input)->pslg);
  } else {
    pslg = model;
  }
  if (!arcs || !plane::check_entities(pslg)) {
    ModelAsMeshed result;
    result.pslg = std::move(pslg);
    return std::optional<ModelAsMeshed>{std::move(result)};
  }
  const double diameter = diameter_of(pslg.vertices);
  const double least = std::max(kOnArcRel, options.model_tolerance_rel.value_or(0)) * diameter;
  double tolerance = least;
  if (rotate && !options.model_tolerance_rel) {
    tolerance =
        std::max(tolerance,
                 kArcAsymmetries * asymmetry_of_arcs(pslg, rotate, kNearMissOfArcsRel * diameter));
  }
  ArcsAtNodes arcs_at_nodes(std::move(pslg), corners, least, tolerance, kSameCircleRel * diameter);
  return std::optional<ModelAsMeshed>{arcs_at_nodes.run()};
}

}  // namespace symcell::internal
