#include "core/guard/check_cell.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/base/index.hpp"
#include "core/geometry/rotation.hpp"
#include "core/guard/cell_facets.hpp"

namespace symcell {
namespace {

using internal::broken;
using internal::check_cell_links;
using internal::element_facet;
using internal::ElementFacet;
using internal::FacetTable;
using internal::InnerFacet;
using internal::name_of;
using internal::Nodes;
using internal::number_of;
using internal::sort_nodes;

// Roundings of the difference of two nodes, of the largest coordinate: each is the sum of some
// products of numbers no larger, rounded to 2^-53 of it.
constexpr double kCoordinateRounding = 32 * 0x1p-53;

// So many open facets are found by their names; more are too many before that.
constexpr std::size_t kOpenFacetsNamed = 64;

// More than fit the time of a fetch from memory, few enough to stay in the nearest cache.
constexpr std::size_t kFacetsAhead = 16;

class CellChecker {
 public:
  CellChecker(const SymmetryCellMesh& cell, const BoundaryTopology* boundary)
      : cell_(cell),
        boundary_(boundary),
        dimension_(cell.dimension),
        corners_(static_cast<std::size_t>(cell.dimension) + 1) {}

  Result<void> run() {
    SYMCELL_TRY(check_fields());
    SYMCELL_TRY(check_nodes());
    SYMCELL_TRY(place_nodes());
    mark_surface();
    SYMCELL_TRY(sweep_elements());
    SYMCELL_TRY(check_copies());
    SYMCELL_TRY(gather_facets());
    SYMCELL_TRY(check_bounds());
    SYMCELL_TRY(check_outer());
    SYMCELL_TRY(check_boundary());
    return check_cell_links(cell_, marked_, at_surface_, inner_, pinched_);
  }

 private:
  [[nodiscard]] const std::int32_t* element(std::size_t e) const {
    return &cell_.elements[e * corners_];
  }

  [[nodiscard]] Result<void> check_fields() const {
    const auto d = static_cast<std::size_t>(dimension_);
    const std::size_t facets = cell_.facet_count(), elements = cell_.element_count();
    const auto by_sector = [&](std::size_t size, std::size_t count) {
      return size == 0 || size == count * static_cast<std::size_t>(cell_.fold);
    };
    const bool fit =
        cell_.nodes_per_element == dimension_ + 1 && cell_.nodes_per_facet == dimension_ &&
        cell_.fold >= 1 && cell_.elements.size() == elements * corners_ &&
        cell_.regions.size() == elements && cell_.boundary.size() == facets * d &&
        cell_.boundary_is_higher_image.size() == facets &&
        cell_.on_axis.size() == cell_.orbit_points.size() &&
        cell_.node_markers.size() == cell_.nodes.size() &&
        cell_.lower_to_higher.size() == cell_.nodes.size() &&
        cell_.lower_facets.size() == cell_.higher_facets.size() &&
        cell_.lower_facets.size() % d == 0 && by_sector(cell_.sector_regions.size(), elements) &&
        by_sector(cell_.sector_boundary_markers.size(), facets);
    if (!fit) return broken("arrays that belong together differ in length");
    for (const auto* list : {&cell_.boundary, &cell_.lower_facets, &cell_.higher_facets}) {
      for (const std::int32_t n : *list) {
        if (n < 0 || at(n) >= cell_.nodes.size()) return broken("a facet's node is none");
      }
    }
    return {};
  }

  [[nodiscard]] Result<void> check_nodes() const {
    std::vector<char> has_node(cell_.orbit_points.size(), 0);
    for (std::size_t n = 0; n < cell_.nodes.size(); ++n) {
      const OrbitVertex v = cell_.nodes[n];
      if (v.orbit < 0 || at(v.orbit) >= has_node.size() || v.exponent < 0 ||
          v.exponent >= cell_.fold || (v.exponent != 0 && cell_.on_axis[at(v.orbit)] != 0)) {
        return broken("node " + std::to_string(n) + " is no copy of an orbit");
      }
      has_node[at(v.orbit)] = 1;
    }
    if (std::find(has_node.begin(), has_node.end(), 0) == has_node.end()) return {};
    return broken("an orbit has no node");
  }

  // Of orbits with several nodes the first is listed with each of the others.
  [[nodiscard]] Result<void> check_copies() const {
    std::vector<std::int32_t> first(cell_.orbit_points.size(), -1);
    std::vector<std::pair<std::int32_t, std::int32_t>> others;
    for (std::size_t n = 0; n < cell_.nodes.size(); ++n) {
      const OrbitVertex v = cell_.nodes[n];
      std::int32_t& own = first[at(v.orbit)];
      if (own < 0) {
        own = v.exponent;
        continue;
      }
      if (own == v.exponent) return broken("two nodes are one copy of an orbit");
      others.emplace_back(v.orbit, v.exponent);
    }
    std::sort(others.begin(), others.end());
    if (std::adjacent_find(others.begin(), others.end()) == others.end()) return {};
    return broken("two nodes are one copy of an orbit");
  }

  // Places of the nodes in the axis' frame, and the doubt of a difference of two as written.
  Result<void> place_nodes() {
    const RotationTable rotations(cell_.fold);
    double reach = 0;
    points_.reserve(cell_.nodes.size());
    for (const OrbitVertex& v : cell_.nodes) {
      const Point3 p = cell_.orbit_points[at(v.orbit)];
      if (cell_.fold > 1 && cell_.on_axis[at(v.orbit)] != 0 && (p.x != 0 || p.y != 0)) {
        return broken("orbit " + std::to_string(v.orbit) + " is not on the axis");
      }
      points_.push_back(rotations.rotate(p, v.exponent));
      reach = std::max(reach, length(p));
    }
    const Point3 origin = cell_.axis_origin;
    const double offset = std::max({std::abs(origin.x), std::abs(origin.y), std::abs(origin.z)});
    off_ = kCoordinateRounding * (offset + reach);
    return {};
  }

  void mark_surface() {
    marked_.assign(cell_.nodes.size(), 0);
    for (const auto* list : {&cell_.boundary, &cell_.lower_facets, &cell_.higher_facets}) {
      for (const std::int32_t n : *list) marked_[at(n)] = 1;
    }
  }

  [[nodiscard]] bool is_marked(std::int32_t n) const { return n >= 0 && marked_[at(n)] != 0; }
  [[nodiscard]] bool all_marked(const Nodes& n) const {
    return is_marked(n[0]) && is_marked(n[1]) && (n[2] < 0 || is_marked(n[2]));
  }

  // Each element by itself, in one sweep.  Of those away from the cell's surface the facets' sides
  // must cancel; the others are listed, to be matched facet by facet.
  Result<void> sweep_elements() {
    std::vector<char> used(cell_.nodes.size(), 0);
    for (std::size_t e = 0; e < cell_.element_count(); ++e) {
      const std::int32_t* v = element(e);
      std::size_t marked = 0;
      for (std::size_t i = 0; i < corners_; ++i) {
        if (v[i] < 0 || at(v[i]) >= used.size()) return broken("a corner is no node");
        used[at(v[i])] = 1;
        marked += marked_[at(v[i])] != 0 ? 1 : 0;
      }
      if (!(dimension_ == 2 ? is_positive_2(v) : is_positive_3(v))) return not_positive(e);
      if (marked == 0) {
        sum_ += dimension_ == 2 ? internal::signed_sides_2(v) : internal::signed_faces_3(v);
        continue;
      }
      at_surface_.push_back(static_cast<std::int32_t>(e));
      facets_at_surface_ += marked == 1 ? corners_ - 1 : corners_;
    }
    const auto unused = std::find(used.begin(), used.end(), 0);
    if (unused == used.end()) return {};
    return broken("node " + std::to_string(unused - used.begin()) + " is not used");
  }

  // In all sectors, and as written: by more than the rounding of a node's rotation and move into
  // the model's frame may change.
  [[nodiscard]] bool is_positive_2(const std::int32_t* v) const {
    const Point3 a = points_[at(v[0])];
    const Point3 p = points_[at(v[1])] - a, q = points_[at(v[2])] - a;
    return cross(p, q).z > off_ * (length(p) + length(q));
  }
  [[nodiscard]] bool is_positive_3(const std::int32_t* v) const {
    const Point3 a = points_[at(v[0])];
    const Point3 p = points_[at(v[1])] - a, q = points_[at(v[2])] - a, r = points_[at(v[3])] - a;
    const double size = dot(cross(p, q), r);
    // Never less than the sum of products below, and without roots.
    if (size > off_ * (dot(p, p) + dot(q, q) + dot(r, r))) return true;
    const double lp = length(p), lq = length(q), lr = length(r);
    return size > off_ * (lp * lq + lq * lr + lr * lp);
  }
  [[nodiscard]] Failure not_positive(std::size_t e) const {
    std::vector<std::int32_t> nodes(element(e), element(e) + corners_);
    std::sort(nodes.begin(), nodes.end());
    const bool twice = std::adjacent_find(nodes.begin(), nodes.end()) != nodes.end();
    return broken("element " + std::to_string(e) +
                  (twice ? " names a node twice" : " is flat or turned inside out"));
  }

  Result<void> gather_facets() {
    const std::size_t surface =
        (cell_.boundary.size() + cell_.lower_facets.size() + cell_.higher_facets.size()) /
        static_cast<std::size_t>(dimension_);
    table_.emplace(
        cell_, std::min(facets_at_surface_, (facets_at_surface_ + surface) / 2 + kOpenFacetsNamed));
    inner_.reserve(facets_at_surface_ / 2);
    // The places of a table are all over memory: they are fetched some facets ahead.
    std::array<std::pair<ElementFacet, std::size_t>, kFacetsAhead> ahead;
    std::size_t read = 0, added = 0;
    const auto add_next = [&]() -> Result<void> {
      const auto& [f, i] = ahead[added++ % kFacetsAhead];
      const auto other = table_->add(f, i);
      if (!other) return error_of(other);
      if (*other >= 0) inner_.push_back({f.nodes, {*other, f.element}});
      return {};
    };
    for (const std::int32_t e : at_surface_) {
      for (std::size_t i = 0; i < corners_; ++i) {
        const ElementFacet f = element_facet(cell_, at(e), i);
        if (!is_marked(f.nodes[0]) && !is_marked(f.nodes[1]) && !is_marked(f.nodes[2])) {
          sum_ += f.even ? f.number : ~f.number + 1;
          continue;
        }
        if (read - added == kFacetsAhead) {
          SYMCELL_TRY(add_next());
        }
        table_->prefetch(f);
        ahead[read++ % kFacetsAhead] = {f, i};
      }
    }
    while (added < read) SYMCELL_TRY(add_next());
    if (sum_ != 0) return broken("facets inside have not one element on each side");
    outer_ = table_->outer();
    for (const ElementFacet& f : outer_) {
      if (!all_marked(f.nodes)) return broken("the facet " + name_of(f.nodes) + " has one element");
    }
    role_.assign(outer_.size(), Role::kNone);
    return {};
  }

  enum class Role : std::uint8_t { kNone, kLower, kHigher, kBoundary };

  [[nodiscard]] Nodes nodes_of(const std::vector<std::int32_t>& list, std::size_t i) const {
    const auto d = static_cast<std::size_t>(dimension_);
    return {list[i * d], list[i * d + 1], dimension_ == 2 ? -1 : list[i * d + 2]};
  }

  // Index in outer_, -1: the facet is not there.
  [[nodiscard]] std::int64_t find_outer(const Nodes& sorted) const {
    const std::uint64_t number = number_of(sorted);
    const auto found = std::lower_bound(outer_.begin(), outer_.end(), sorted,
                                        [number](const ElementFacet& f, const Nodes& n) {
                                          return std::tie(f.number, f.nodes) < std::tie(number, n);
                                        });
    return found != outer_.end() && found->nodes == sorted ? found - outer_.begin() : -1;
  }

  Result<void> check_bounds() {
    for (std::size_t i = 0; i < cell_.nodes.size(); ++i) {
      const std::int32_t image = cell_.lower_to_higher[i];
      if (image < 0 && cell_.fold > 1 && cell_.on_axis[at(cell_.nodes[i].orbit)] != 0) {
        return broken("node " + std::to_string(i) + " on the axis is not paired with itself");
      }
      if (image >= 0 && !is_image(cell_.nodes[i], image)) {
        return broken("node " + std::to_string(i) + " is paired with what is not its image");
      }
    }
    const std::size_t count = cell_.lower_facets.size() / static_cast<std::size_t>(dimension_);
    for (std::size_t i = 0; i < count; ++i) {
      Nodes low = nodes_of(cell_.lower_facets, i), high = nodes_of(cell_.higher_facets, i);
      for (std::size_t j = 0; j < static_cast<std::size_t>(dimension_); ++j) {
        if (!is_image(cell_.nodes[at(low[j])], high[j])) {
          return broken("a facet of the higher bound is not the image of its lower one");
        }
        if (cell_.lower_to_higher[at(low[j])] != high[j]) {
          return broken("node " + std::to_string(low[j]) + " of the lower bound is not paired");
        }
      }
      const bool low_even = sort_nodes(low, dimension_), high_even = sort_nodes(high, dimension_);
      const std::int64_t l = find_outer(low), h = find_outer(high);
      if (l < 0 || h < 0 || l == h) {
        return broken("the facet " + name_of(low) + " of a bound is not of the cell's surface");
      }
      Role &own = role_[static_cast<std::size_t>(l)], &image = role_[static_cast<std::size_t>(h)];
      if (own != Role::kNone || image != Role::kNone) {
        return broken("the facet " + name_of(low) + " is on a bound twice");
      }
      own = Role::kLower;
      image = Role::kHigher;
      const bool same_side = (outer_[static_cast<std::size_t>(l)].even == low_even) ==
                             (outer_[static_cast<std::size_t>(h)].even == high_even);
      if (same_side) return broken("both bounds are seen from one side at " + name_of(low));
    }
    return {};
  }

  [[nodiscard]] bool is_image(OrbitVertex v, std::int32_t image) const {
    if (image < 0 || at(image) >= cell_.nodes.size()) return false;
    const OrbitVertex w = cell_.nodes[at(image)];
    const bool axis = cell_.fold > 1 && cell_.on_axis[at(v.orbit)] != 0;
    return v.orbit == w.orbit && (axis || w.exponent == (v.exponent + 1) % cell_.fold);
  }

  // What is of no bound must be listed as boundary; what is listed may be inside, on a facet or
  // segment of the model.
  Result<void> check_outer() {
    std::vector<Nodes> listed;
    for (std::size_t i = 0; i < cell_.facet_count(); ++i) {
      Nodes n = nodes_of(cell_.boundary, i);
      sort_nodes(n, dimension_);
      listed.push_back(n);
      const std::int64_t found = find_outer(n);
      // Those without a node on the surface are not asked for.
      if (found < 0 && !table_->is_inner(n)) {
        return broken("the facet " + name_of(n) + " of the boundary is of no element");
      }
      Role none = Role::kNone;
      Role& role = found < 0 ? none : role_[static_cast<std::size_t>(found)];
      if (role == Role::kNone) role = Role::kBoundary;
      if ((role == Role::kHigher) != (cell_.boundary_is_higher_image[i] != 0)) {
        return broken("the facet " + name_of(n) + " is wrongly marked as an image or not");
      }
    }
    std::sort(listed.begin(), listed.end());
    const auto twice = std::adjacent_find(listed.begin(), listed.end());
    if (twice != listed.end()) {
      return broken("the facet " + name_of(*twice) + " of the boundary is listed twice");
    }
    const auto open = std::find(role_.begin(), role_.end(), Role::kNone);
    if (open == role_.end()) return {};
    return broken("the facet " +
                  name_of(outer_[static_cast<std::size_t>(open - role_.begin())].nodes) +
                  " is open: on no bound and not of the boundary");
  }

  Result<void> check_boundary() {
    pinched_.assign(cell_.orbit_points.size(), 0);
    return dimension_ == 2 ? check_boundary_2() : check_boundary_3();
  }

  // More than two edges of the full mesh's boundary at a node: it touches itself there.
  Result<void> check_boundary_2() {
    std::vector<std::int64_t> ends(cell_.orbit_points.size(), 0);
    for (std::size_t i = 0; i < outer_.size(); ++i) {
      if (role_[i] != Role::kBoundary) continue;
      for (std::size_t j = 0; j < 2; ++j) {
        const auto orbit = at(cell_.nodes[at(outer_[i].nodes[j])].orbit);
        ends[orbit] += cell_.on_axis[orbit] != 0 ? cell_.fold : 1;
      }
    }
    for (std::size_t orbit = 0; orbit < ends.size(); ++orbit) {
      if (ends[orbit] % 2 != 0) return broken("the boundary of the full mesh is open");
      pinched_[orbit] = ends[orbit] > 2 ? 1 : 0;
    }
    return {};
  }

  Result<void> check_boundary_3() {
    std::vector<OrbitTriangle> triangles;
    for (std::size_t i = 0; i < outer_.size(); ++i) {
      if (role_[i] != Role::kBoundary) continue;
      const ElementFacet& f = outer_[i];
      OrbitTriangle t{cell_.nodes[at(f.nodes[0])], cell_.nodes[at(f.nodes[1])],
                      cell_.nodes[at(f.nodes[2])]};
      if (!f.even) std::swap(t[1], t[2]);
      triangles.push_back(t);
    }
    const BoundaryTopology found = boundary_topology(cell_.fold, cell_.on_axis, triangles);
    for (const std::int32_t orbit : found.touching) pinched_[at(orbit)] = 1;
    if (boundary_ == nullptr) return {};
    if (found.shells != boundary_->shells || found.euler != boundary_->euler) {
      return broken("the boundary has " + std::to_string(found.shells) +
                    " shells and Euler characteristic " + std::to_string(found.euler) +
                    " in place of " + std::to_string(boundary_->shells) + " and " +
                    std::to_string(boundary_->euler));
    }
    if (found.open_edges > 0) return broken("the boundary of the full mesh is open");
    if (found.pinched_vertices.size() != boundary_->pinched_vertices.size() ||
        (found.pinched_edges > 0) != (boundary_->pinched_edges > 0)) {
      return broken("the boundary of the full mesh touches itself");
    }
    return {};
  }

  const SymmetryCellMesh& cell_;
  const BoundaryTopology* boundary_;
  std::int32_t dimension_;
  std::size_t corners_;
  std::vector<Point3> points_;            // per node, in the axis' frame
  double off_ = 0;                        // rounding of a difference of two nodes, as written
  std::vector<char> marked_;              // nodes of the cell's surface, and of facets inside
  std::vector<std::int32_t> at_surface_;  // elements with a marked node
  std::size_t facets_at_surface_ = 0;     // of these: with a marked node, counted per element
  std::uint64_t sum_ = 0;                 // of the sides of facets without a marked node
  std::optional<FacetTable> table_;       // of facets with a marked node
  std::vector<InnerFacet> inner_;         // of these those with two elements
  std::vector<ElementFacet> outer_;       // with one element, sorted
  std::vector<Role> role_;                // of outer_
  std::vector<char> pinched_;             // orbits at which the full mesh touches itself
};

}  // namespace

Result<void> check_cell(const SymmetryCellMesh& cell, const BoundaryTopology* boundary) {
  return CellChecker(cell, boundary).run();
}

}  // namespace symcell
