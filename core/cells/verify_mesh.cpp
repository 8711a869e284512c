#include "core/cells/verify_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <type_traits>
#include <variant>

#include "core/cells/verify_support.hpp"
#include "core/geometry/axis_frame.hpp"

namespace symcell {
namespace {

using internal::Checks;
using internal::FacetedMesh;
using internal::HalfFacet;
using internal::shown;

// Even permutations of an element's corners: the orders in which a copy may name them.
using CornerOrder = std::array<std::size_t, 4>;
constexpr std::array<CornerOrder, 3> kTriangleOrders{{{0, 1, 2, 3}, {1, 2, 0, 3}, {2, 0, 1, 3}}};
constexpr std::array<CornerOrder, 12> kTetrahedronOrders{{{0, 1, 2, 3},
                                                          {1, 2, 0, 3},
                                                          {2, 0, 1, 3},
                                                          {0, 2, 3, 1},
                                                          {0, 3, 1, 2},
                                                          {1, 0, 3, 2},
                                                          {1, 3, 2, 0},
                                                          {2, 1, 3, 0},
                                                          {2, 3, 0, 1},
                                                          {3, 0, 2, 1},
                                                          {3, 1, 0, 2},
                                                          {3, 2, 1, 0}}};

constexpr double kFar = std::numeric_limits<double>::infinity();
// Places at elements are counted with 32 bits, six an element.
constexpr std::size_t kMostLinked = 300'000'000;

class Verifier {
 public:
  Verifier(const MeshData& cell,
           const MeshData* full,
           const Model* model,
           const VerifyOptions& options,
           VerifyReport& report)
      : cell_(cell),
        full_(full),
        model_(model),
        options_(options),
        checks_(report),
        rotations_(std::max(cell.fold, 1)) {}

  void run() {
    if (!internal::check_elements(cell_, "cell", internal::diameter(cell_.points), checks_)) return;
    frame_ = AxisFrame::of_axis(cell_.axis_origin, cell_.axis_direction);
    if (cell_.dimension == 2) frame_.origin.z = 0;
    diameter_ = full_ != nullptr ? internal::diameter(full_->points) : restored_diameter();
    tolerance_ = std::max(options_.tolerance_rel * diameter_, rounding());
    internal::tell_quality(cell_, checks_);
    if (!check_pairs() || !check_bounds()) return;
    MeshData restored;
    const MeshData* full = full_;
    if (full == nullptr) {
      const std::size_t nodes = cell_.points.size() * static_cast<std::size_t>(cell_.fold);
      if (nodes > options_.most_restored_nodes) {
        checks_.skip("full.fields",
                     "the full mesh is too large to be restored here; give its file");
        return;
      }
      restored = restore();
      full = &restored;
    }
    if (!internal::check_elements(*full, "full", diameter_, checks_)) return;
    const bool copies = check_copies(*full);
    check_measure(*full);
    const std::vector<HalfFacet> facets = internal::sorted_facets(*full);
    const std::vector<std::size_t> groups = internal::facet_groups(facets);
    const FacetedMesh faceted{*full, facets, groups};
    if (copies && full->dimension == 3) check_links(faceted);
    internal::tell_delaunay(faceted, check_model(faceted), checks_);
  }

 private:
  [[nodiscard]] Point3 rotated(const Point3& p, std::int32_t k) const {
    const Point3 local = frame_.to_local(p);
    return frame_.to_model(rotations_.rotate(local, rotations_.reduce(k)));
  }

  // Of the coordinates: what a correct mesh far from the origin may be off by.
  [[nodiscard]] double rounding() const {
    const auto size = [](const Point3& p) {
      return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    };
    double largest = size(cell_.axis_origin);
    for (const Point3& p : cell_.points) largest = std::max(largest, size(p));
    return 16 * 0x1p-52 * largest;
  }

  [[nodiscard]] double restored_diameter() const {
    if (cell_.fold == 1) return internal::diameter(cell_.points);
    double reach = 0;
    double low = kFar, high = -kFar;
    for (const Point3& p : cell_.points) {
      const Point3 local = frame_.to_local(p);
      reach = std::max(reach, length(internal::planar(local)));
      low = std::min(low, local.z);
      high = std::max(high, local.z);
    }
    return std::hypot(2 * reach, high - low);
  }

  // The model's own where it is a solid: a box round a skew solid is larger than one along its
  // axis.
  [[nodiscard]] double model_diameter() const {
    return std::visit(
        [this](const auto& model) {
          if constexpr (std::is_same_v<std::decay_t<decltype(model)>, Pslg>) {
            return diameter_;
          } else {
            return internal::diameter(model.vertices);
          }
        },
        *model_);
  }

  std::vector<char> check_model(const FacetedMesh& full) {
    const std::vector<char> none(full.groups.size(), 0);
    if (model_ == nullptr) {
      checks_.skip("model.boundary", "no model was given");
      return none;
    }
    const ModelKind kind = kind_of(*model_);
    if (is_planar(kind) != (cell_.dimension == 2)) {
      checks_.add("model.boundary", false, "the model has another dimension than the mesh");
      return none;
    }
    const double share = options_.model_tolerance_rel.value_or(
        kind == ModelKind::kSurface ? kSurfaceToleranceRel : kExactToleranceRel);
    const double tolerance = std::max(share * model_diameter(), tolerance_);
    return std::visit(
        [&](const auto& model) { return internal::check_model(full, model, tolerance, checks_); },
        *model_);
  }

  bool check_pairs() {
    std::string wrong;
    double worst = 0;
    const auto& pairs = cell_.lower_to_higher;
    if (pairs.size() != cell_.points.size()) {
      return checks_.add("cell.pairs", false, "lower_to_higher is missing");
    }
    std::vector<char> taken(cell_.points.size(), 0);
    std::size_t count = 0;
    for (std::size_t i = 0; i < pairs.size() && wrong.empty(); ++i) {
      if (pairs[i] < 0) continue;
      const auto j = static_cast<std::size_t>(pairs[i]);
      const std::string name = "node " + std::to_string(i);
      if (j >= cell_.points.size()) {
        wrong = name + " is paired with a node that does not exist";
        break;
      }
      ++count;
      const double off = distance(rotated(cell_.points[i], 1), cell_.points[j]);
      worst = std::max(worst, off);
      if (!(off <= tolerance_)) wrong = name + " is off its pair by " + shown(off);
      if (taken[j] != 0) wrong = "node " + std::to_string(j) + " is the pair of two nodes";
      taken[j] = 1;
      if (cell_.fold == 1) wrong = name + " has a pair although the fold is 1";
    }
    return checks_.add(
        "cell.pairs", wrong.empty(),
        wrong.empty() ? std::to_string(count) + " pairs, worst off by " + shown(worst) : wrong);
  }

  // Boundary facets of the cell with all corners on the lower bound go to boundary facets that are
  // seen from the other side; one seen from the same side would overlap in the full mesh.
  bool check_bounds() {
    const std::vector<HalfFacet> facets = internal::sorted_facets(cell_);
    const std::vector<std::size_t> groups = internal::facet_groups(facets);
    std::vector<HalfFacet> boundary;
    for (std::size_t g = 0; g + 1 < groups.size(); ++g) {
      if (groups[g + 1] - groups[g] == 1) boundary.push_back(facets[groups[g]]);
    }
    const auto corners = static_cast<std::size_t>(cell_.dimension);
    std::size_t bound_facets = 0;
    std::string wrong;
    for (const HalfFacet& f : boundary) {
      std::array<std::int32_t, 3> image{-1, -1, -1};
      bool paired = true;
      for (std::size_t i = 0; i < corners; ++i) {
        image[i] = cell_.lower_to_higher[static_cast<std::size_t>(f.nodes[i])];
        paired = paired && image[i] >= 0;
      }
      if (!paired) continue;
      const bool even = internal::sort_facet(image, cell_.dimension);
      const auto found = std::ranges::lower_bound(boundary, image, {}, &HalfFacet::nodes);
      if (found == boundary.end() || found->nodes != image) continue;
      ++bound_facets;
      const bool same_side = found->even == (f.even == even);
      if (same_side && wrong.empty()) {
        wrong = internal::facet_name(f.nodes) + " and its image have the cell on one side";
      }
    }
    return checks_.add("cell.bounds", wrong.empty(),
                       wrong.empty() ? std::to_string(bound_facets) + " facets on a bound" : wrong);
  }

  // n copies of the cell, glued by the pairs: (i, k + 1) is (pair of i, k).
  [[nodiscard]] MeshData restore() const {
    const std::size_t nodes = cell_.points.size();
    const auto n = static_cast<std::size_t>(cell_.fold);
    std::vector<std::size_t> parent(nodes * n);
    std::iota(parent.begin(), parent.end(), std::size_t{0});
    const auto root = [&](std::size_t i) {
      while (parent[i] != i) i = parent[i] = parent[parent[i]];
      return i;
    };
    for (std::size_t i = 0; i < nodes; ++i) {
      if (cell_.lower_to_higher[i] < 0) continue;
      const auto j = static_cast<std::size_t>(cell_.lower_to_higher[i]);
      for (std::size_t k = 0; k < n; ++k) {
        const std::size_t a = root((k + 1) % n * nodes + i);
        const std::size_t b = root(k * nodes + j);
        parent[std::max(a, b)] = std::min(a, b);
      }
    }
    MeshData full = cell_;
    full.lower_to_higher.clear();
    full.points.clear();
    full.elements.clear();
    full.regions.clear();
    std::vector<std::int32_t> id(parent.size(), -1);
    for (std::size_t v = 0; v < parent.size(); ++v) {
      const std::size_t r = root(v);
      if (r == v) {
        id[v] = static_cast<std::int32_t>(full.points.size());
        full.points.push_back(
            rotated(cell_.points[v % nodes], static_cast<std::int32_t>(v / nodes)));
      } else {
        id[v] = id[r];  // the root is the smallest of its class
      }
    }
    for (std::size_t k = 0; k < n; ++k) {
      for (const std::int32_t node : cell_.elements) {
        full.elements.push_back(id[k * nodes + static_cast<std::size_t>(node)]);
      }
      for (std::size_t e = 0; e < cell_.element_count(); ++e) {
        full.regions.push_back(cell_.regions[e]);
        full.sectors.push_back(static_cast<std::int32_t>(k));
        full.cell_elements.push_back(static_cast<std::int32_t>(e));
      }
    }
    return full;
  }

  // Where the nodes of an element stand if its corners are named in another order.
  [[nodiscard]] std::array<std::size_t, 10> node_order(const CornerOrder& corners) const {
    std::array<std::size_t, 10> order{};
    const auto count = static_cast<std::size_t>(cell_.dimension) + 1;
    std::copy_n(corners.begin(), count, order.begin());
    const auto edges = internal::edge_corners(cell_.dimension);
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const std::size_t a = corners[edges[i][0]], b = corners[edges[i][1]];
      for (std::size_t j = 0; j < edges.size(); ++j) {
        const bool same =
            (edges[j][0] == a && edges[j][1] == b) || (edges[j][0] == b && edges[j][1] == a);
        if (same) order[count + i] = count + j;
      }
    }
    return order;
  }

  [[nodiscard]] double copy_error(const MeshData& full, std::size_t e) const {
    const auto k = static_cast<std::size_t>(cell_.nodes_per_element);
    const auto source = static_cast<std::size_t>(full.cell_elements[e]);
    std::array<Point3, 10> wanted;
    for (std::size_t i = 0; i < k; ++i) {
      const auto node = static_cast<std::size_t>(cell_.elements[source * k + i]);
      wanted[i] = rotated(cell_.points[node], full.sectors[e]);
    }
    const std::span<const CornerOrder> orders =
        cell_.dimension == 2 ? std::span<const CornerOrder>(kTriangleOrders) : kTetrahedronOrders;
    double best = kFar;
    for (const CornerOrder& corners : orders) {
      const auto order = node_order(corners);
      double worst = 0;
      for (std::size_t i = 0; i < k; ++i) {
        const auto node = static_cast<std::size_t>(full.elements[e * k + order[i]]);
        worst = std::max(worst, distance(wanted[i], full.points[node]));
      }
      best = std::min(best, worst);
      if (best <= tolerance_) break;
    }
    return best;
  }

  bool check_copies(const MeshData& full) {
    std::string wrong;
    double worst = 0;
    const std::size_t elements = cell_.element_count();
    const auto n = static_cast<std::size_t>(cell_.fold);
    if (full.fold != cell_.fold || full.order != cell_.order || full.dimension != cell_.dimension ||
        distance(full.axis_origin, cell_.axis_origin) > tolerance_ ||
        distance(full.axis_direction, cell_.axis_direction) > options_.tolerance_rel) {
      wrong = "dimension, fold, order or axis differ from the cell's";
    } else if (full.element_count() != elements * n) {
      wrong = std::to_string(full.element_count()) + " elements, expected " +
              std::to_string(elements * n);
    } else if (full.sectors.size() != elements * n || full.cell_elements.size() != elements * n) {
      wrong = "sector or cell_element is missing";
    }
    std::vector<char> seen(wrong.empty() ? elements * n : 0, 0);
    std::size_t other_regions = 0;
    for (std::size_t e = 0; e < seen.size() && wrong.empty(); ++e) {
      const auto s = static_cast<std::size_t>(full.sectors[e]);
      const auto c = static_cast<std::size_t>(full.cell_elements[e]);
      const std::string name = "element " + std::to_string(e);
      if (s >= n || c >= elements) {
        wrong = name + " has a sector or cell element that does not exist";
      } else if (seen[s * elements + c]++ != 0) {
        wrong = name + " is the second copy of a cell element in one sector";
      } else {
        const double off = copy_error(full, e);
        worst = std::max(worst, off);
        if (!(off <= tolerance_)) wrong = name + " is off the rotated cell by " + shown(off);
        other_regions += full.regions[e] != cell_.regions[c] ? 1 : 0;
      }
    }
    std::string detail = "worst off by " + shown(worst);
    if (other_regions > 0) detail += "; " + std::to_string(other_regions) + " of another region";
    return checks_.add("full.copies", wrong.empty(), wrong.empty() ? detail : wrong);
  }

  void check_measure(const MeshData& full) {
    const bool plane = cell_.dimension == 2;
    const std::string name = plane ? "area" : "volume";
    const double expected = internal::total_measure(cell_) * cell_.fold;
    const double found = internal::total_measure(full);
    // What a layer of one tolerance round the mesh holds.
    const double layer = 4 * diameter_ * (plane ? 1 : diameter_);
    const double allowed = 1e-9 * expected + tolerance_ * layer;
    checks_.add("full." + name, std::abs(found - expected) <= allowed,
                shown(found) + ", cell times fold " + shown(expected));
    if (!options_.model_measure) return;
    const bool surface = model_ != nullptr && kind_of(*model_) == ModelKind::kSurface;
    const double share =
        options_.model_tolerance_rel.value_or(surface ? kSurfaceToleranceRel : kExactToleranceRel);
    const double moved = share * diameter_ * layer;
    checks_.add("model." + name,
                std::abs(found - *options_.model_measure) <= allowed + 1e-9 * expected + moved,
                shown(found) + ", the model's " + shown(*options_.model_measure));
  }

  // A model may pinch itself, and then so does its mesh; the cell must not do it anywhere else.
  void check_links(const FacetedMesh& full) {
    if (full.mesh.element_count() > kMostLinked) {
      checks_.skip("cell.links", "the full mesh is too large");
      return;
    }
    const internal::Pinches of_full = internal::find_pinches(full);
    checks_.add("full.links", true,
                std::to_string(of_full.nodes.size()) + " nodes and " +
                    std::to_string(of_full.edges.size()) + " edges at which the mesh pinches");
    std::vector<char> pinched(full.mesh.points.size(), 0);
    for (const std::int32_t node : of_full.nodes) pinched[static_cast<std::size_t>(node)] = 1;
    for (const auto& edge : of_full.edges) {
      for (const std::int32_t node : edge) pinched[static_cast<std::size_t>(node)] = 1;
    }
    const std::vector<HalfFacet> facets = internal::sorted_facets(cell_);
    const std::vector<std::size_t> groups = internal::facet_groups(facets);
    const internal::Pinches of_cell = internal::find_pinches({cell_, facets, groups});
    const std::vector<char> excused = nodes_that_pinch(full.mesh, pinched);
    std::string wrong;
    for (const std::int32_t node : of_cell.nodes) {
      if (excused[static_cast<std::size_t>(node)] != 0 || !wrong.empty()) continue;
      wrong = "the cell pinches at node " + std::to_string(node);
    }
    for (const auto& edge : of_cell.edges) {
      const bool both = excused[static_cast<std::size_t>(edge[0])] != 0 &&
                        excused[static_cast<std::size_t>(edge[1])] != 0;
      if (both || !wrong.empty()) continue;
      wrong = "the cell pinches at " + internal::facet_name({edge[0], edge[1], -1});
    }
    checks_.add("cell.links", wrong.empty(), wrong);
  }

  // Nodes of the cell that are pinched nodes of the full mesh, told by the copy in sector 0.
  [[nodiscard]] std::vector<char> nodes_that_pinch(const MeshData& full,
                                                   const std::vector<char>& pinched) const {
    std::vector<char> result(cell_.points.size(), 0);
    const auto k = static_cast<std::size_t>(cell_.nodes_per_element);
    for (std::size_t e = 0; e < full.element_count(); ++e) {
      if (full.sectors[e] != 0) continue;
      for (std::size_t i = 0; i < 4; ++i) {
        const auto node = static_cast<std::size_t>(full.elements[e * k + i]);
        if (pinched[node] == 0) continue;
        for (std::size_t j = 0; j < 4; ++j) {
          const auto own = static_cast<std::size_t>(
              cell_.elements[static_cast<std::size_t>(full.cell_elements[e]) * k + j]);
          if (distance(cell_.points[own], full.points[node]) <= tolerance_) result[own] = 1;
        }
      }
    }
    return result;
  }

  const MeshData& cell_;
  const MeshData* full_;
  const Model* model_;
  const VerifyOptions& options_;
  Checks checks_;
  RotationTable rotations_;
  AxisFrame frame_;
  double diameter_ = 0;
  double tolerance_ = 0;
};

}  // namespace

VerifyReport verify_mesh(const MeshData& cell,
                         const MeshData* full,
                         const Model* model,
                         const VerifyOptions& options) {
  VerifyReport report;
  Verifier(cell, full, model, options, report).run();
  return report;
}

}  // namespace symcell
