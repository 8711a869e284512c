// The symmetry pairs of a cell and its two bounds.
#include <algorithm>
#include <array>
#include <limits>

#include "core/base/index.hpp"
#include "core/geometry/point_tree.hpp"
#include "core/verify/symmetry.hpp"

namespace symcell::internal {
namespace {

std::string node_name(std::size_t node) {
  return "node " + std::to_string(node);
}

class PairChecker {
 public:
  PairChecker(const MeshData& cell, const Turns& turns, const PairTolerances& tolerances)
      : cell_(cell), pairs_(cell.lower_to_higher), turns_(turns), tolerances_(tolerances) {}

  bool run(Checks& checks) {
    if (pairs_.size() != cell_.points.size()) {
      return checks.add("cell.pairs", false, "lower_to_higher is missing");
    }
    if (!look_at_pairs(checks)) return false;
    if (turns_.fold() == 1) return true;
    bool ok = look_at_images(checks);
    ok &= look_at_axis(checks);
    look_for_missing(checks);
    return ok;
  }

 private:
  bool look_at_pairs(Checks& checks) const {
    Flaws flaws;
    double worst = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      const std::int32_t j = pairs_[i];
      if (j == -1) continue;
      if (j < 0 || at(j) >= pairs_.size()) {
        flaws.note([&] { return node_name(i) + " is paired with a node that does not exist"; });
        continue;
      }
      if (turns_.fold() == 1) {
        flaws.note([&] { return node_name(i) + " has a pair although the fold is 1"; });
      }
      ++count;
      const double off = distance(turns_.rotated(cell_.points[i], 1), cell_.points[at(j)]);
      worst = std::max(worst, off);
      if (off <= tolerances_.paired) continue;
      flaws.note([&] { return node_name(i) + " is off its pair by " + shown(off); });
    }
    return flaws.report(checks, "cell.pairs",
                        std::to_string(count) + " pairs, worst off by " + shown(worst));
  }

  bool look_at_images(Checks& checks) const {
    Flaws flaws;
    std::vector<char> taken(pairs_.size(), 0);
    for (const std::int32_t j : pairs_) {
      if (j < 0 || taken[at(j)]++ == 0) continue;
      flaws.note([&] { return node_name(at(j)) + " is the pair of two nodes"; });
    }
    return flaws.report(checks, "cell.pairs_injective");
  }

  [[nodiscard]] bool own_pair(std::size_t node) const {
    return pairs_[node] >= 0 && at(pairs_[node]) == node;
  }
  [[nodiscard]] bool on_axis(std::size_t node) const {
    return turns_.from_axis(cell_.points[node]) <=
           (own_pair(node) ? tolerances_.paired : tolerances_.unpaired);
  }

  bool look_at_axis(Checks& checks) const {
    Flaws flaws;
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      const bool itself = own_pair(i);
      if (on_axis(i) == itself) continue;
      flaws.note([&] {
        return node_name(i) + (itself ? " is its own pair but not on the axis"
                                      : " is on the axis but not its own pair");
      });
    }
    return flaws.report(checks, "cell.axis_self");
  }

  // A node whose image is a node of the cell must say so.
  void look_for_missing(Checks& checks) const {
    const PointTree tree(cell_.points);
    Flaws flaws;
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      if (on_axis(i)) continue;
      const auto hit = tree.nearest(turns_.rotated(cell_.points[i], 1));
      if (hit.distance > tolerances_.unpaired || pairs_[i] == hit.point) continue;
      // Half a turn goes both ways.
      if (turns_.fold() == 2 && at(pairs_[at(hit.point)]) == i) continue;
      flaws.note([&] {
        return "the image of " + node_name(i) + " is " + node_name(at(hit.point)) +
               ", but lower_to_higher does not say so";
      });
    }
    flaws.report(checks, "cell.pairs_complete");
  }

  const MeshData& cell_;
  const std::vector<std::int32_t>& pairs_;
  const Turns& turns_;
  PairTolerances tolerances_;
};

class BoundFinder {
 public:
  BoundFinder(const FacetedMesh& cell, const Turns& turns)
      : cell_(cell), pairs_(cell.mesh.lower_to_higher), turns_(turns) {}

  CellBounds run(Checks& checks) {
    find_images();
    choose_lower();
    Flaws flaws = std::move(overlaps_);
    std::vector<char> role(cell_.group_count(), 0);
    for (const std::size_t g : lower_) role[g] = 1;
    CellBounds bounds;
    for (const std::size_t g : lower_) {
      const std::size_t to = image_[g];
      if (role[to] != 0) {
        flaws.note([&] {
          return facet_name(cell_.first(to).nodes) +
                 (role[to] == 1 ? " is on both bounds" : " is the image of two facets");
        });
      }
      if (role[to] == 0) role[to] = 2;
      bounds.lower.push_back(g);
      bounds.higher.push_back(to);
    }
    flaws.report(checks, "cell.bounds", std::to_string(lower_.size()) + " facets on a bound");
    return bounds;
  }

  // Groups that each go to the other, as half a turn allows: either bound may be theirs.
  [[nodiscard]] const std::vector<std::size_t>& mutual() const { return mutual_; }

 private:
  // Boundary facets whose image is a boundary facet seen from the other side; one seen from the
  // same side would overlap it in the full mesh.
  void find_images() {
    image_.assign(cell_.group_count(), cell_.group_count());
    for (std::size_t g = 0; g < cell_.group_count(); ++g) {
      if (cell_.sides(g) != 1) continue;
      const HalfFacet& f = cell_.first(g);
      std::array<std::int32_t, 3> image{-1, -1, -1};
      bool paired = true;
      for (std::size_t i = 0; i < static_cast<std::size_t>(cell_.mesh.dimension); ++i) {
        image[i] = pairs_[at(f.nodes[i])];
        paired = paired && image[i] >= 0;
      }
      if (!paired) continue;
      const bool even = sort_facet(image, cell_.mesh.dimension);
      const std::size_t to = cell_.find(image);
      if (to == cell_.group_count() || cell_.sides(to) != 1 || to == g) continue;
      if (cell_.first(to).even == (f.even == even)) {
        overlaps_.note(
            [&] { return facet_name(f.nodes) + " and its image have the cell on one side"; });
        continue;
      }
      image_[g] = to;
      lower_.push_back(g);
    }
  }

  void choose_lower() {
    if (turns_.fold() != 2) return;
    for (const std::size_t g : lower_) {
      const std::size_t to = image_[g];
      if (image_[to] == g) mutual_.push_back(g);
    }
    // Of two that go to each other one is called lower; if all do, no bound was given at all.
    if (mutual_.size() == lower_.size()) return;
    std::erase_if(lower_, [&](std::size_t g) { return image_[image_[g]] == g && image_[g] < g; });
  }

  const FacetedMesh& cell_;
  const std::vector<std::int32_t>& pairs_;
  const Turns& turns_;
  std::vector<std::size_t> image_;  // per group; group_count(): none
  std::vector<std::size_t> lower_, mutual_;
  Flaws overlaps_;
};

// f(node) for the corners and mid nodes of a facet.
template <class F>
void each_facet_node(const MeshData& mesh, const HalfFacet& facet, const F& f) {
  const auto k = static_cast<std::size_t>(mesh.nodes_per_element);
  const auto corners = static_cast<std::size_t>(mesh.dimension) + 1;
  const auto opposite = static_cast<std::size_t>(facet.opposite);
  const std::int32_t* nodes = &mesh.elements[at(facet.element) * k];
  for (std::size_t i = 0; i < corners; ++i) {
    if (i != opposite) f(nodes[i]);
  }
  if (mesh.order == 1) return;
  const auto edges = edge_corners(mesh.dimension);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (edges[i][0] != opposite && edges[i][1] != opposite) f(nodes[corners + i]);
  }
}

std::vector<char> nodes_of(const FacetedMesh& mesh,
                           const std::vector<std::size_t>& groups,
                           const std::vector<std::size_t>& more) {
  std::vector<char> result(mesh.mesh.points.size(), 0);
  const auto mark = [&](std::int32_t node) { result[at(node)] = 1; };
  for (const std::size_t g : groups) each_facet_node(mesh.mesh, mesh.first(g), mark);
  for (const std::size_t g : more) each_facet_node(mesh.mesh, mesh.first(g), mark);
  return result;
}

}  // namespace

Turns::Turns(const MeshData& cell)
    : frame_(AxisFrame::of_axis(cell.axis_origin, cell.axis_direction)), rotations_(cell.fold) {
  if (cell.dimension == 2) frame_.origin.z = 0;
}

bool check_pairs(const MeshData& cell,
                 const Turns& turns,
                 const PairTolerances& tolerances,
                 Checks& checks) {
  return PairChecker(cell, turns, tolerances).run(checks);
}

CellBounds check_bounds(const FacetedMesh& cell,
                        const Turns& turns,
                        double tolerance,
                        const ModelPinches& pinches,
                        Checks& checks) {
  BoundFinder finder(cell, turns);
  CellBounds bounds = finder.run(checks);
  if (turns.fold() == 1) return bounds;
  // Every pair belongs to facets of the bounds, but for the axis and where the model pinches.
  const std::vector<char> low = nodes_of(cell, bounds.lower, finder.mutual());
  const std::vector<char> high = nodes_of(cell, bounds.higher, finder.mutual());
  const auto& pairs = cell.mesh.lower_to_higher;
  std::vector<char> stray(pairs.size(), 0);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (pairs[i] < 0) {
      stray[i] = low[i];
      continue;
    }
    if (low[i] == 0) stray[i] = 1;
    if (high[at(pairs[i])] == 0) stray[at(pairs[i])] = 1;
  }
  std::vector<std::size_t> nodes;
  std::vector<Point3> places;
  for (std::size_t i = 0; i < stray.size(); ++i) {
    if (stray[i] == 0 || turns.from_axis(cell.mesh.points[i]) <= tolerance) continue;
    nodes.push_back(i);
    places.push_back(cell.mesh.points[i]);
  }
  const std::vector<char> exempts = pinches.exempted(places);
  Flaws flaws;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (exempts[i] != 0) continue;
    flaws.note([&] {
      return node_name(nodes[i]) + (pairs[nodes[i]] < 0 && low[nodes[i]] != 0
                                        ? " is on the lower bound and has no pair"
                                        : " is paired but on no facet of a bound");
    });
  }
  flaws.report(checks, "cell.bounds_nodes");
  return bounds;
}

}  // namespace symcell::internal
