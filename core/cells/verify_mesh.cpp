#include "core/cells/verify_mesh.hpp"

#include <algorithm>
#include <numeric>

#include "core/cells/verify_support.hpp"
#include "core/geometry/predicates.hpp"

namespace symcell {
namespace {

using internal::Checks;
using internal::HalfEdge;
using internal::planar;
using internal::shown;

class Verifier {
 public:
  Verifier(const MeshData& cell,
           const MeshData* full,
           const Pslg* model,
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
    diameter_ = full_ != nullptr ? internal::diameter(full_->points) : restored_diameter();
    tolerance_ = std::max(options_.tolerance_rel * diameter_, rounding());
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
    check_copies(*full);
    check_area(*full);
    const std::vector<HalfEdge> edges = internal::sorted_edges(*full);
    const std::vector<std::size_t> groups = internal::edge_groups(edges);
    std::vector<char> constrained(groups.size(), 0);
    if (model_ != nullptr) {
      constrained = internal::check_model(
          *full, edges, groups, *model_,
          std::max(options_.model_tolerance_rel * diameter_, tolerance_), checks_);
    } else {
      checks_.skip("model.segments", "no model was given");
    }
    tell_delaunay(*full, edges, groups, constrained);
  }

 private:
  [[nodiscard]] Point2 center() const { return planar(cell_.axis_origin); }

  // The rotation about an axis along -z runs the other way round.
  [[nodiscard]] std::int32_t turn(std::int32_t k) const {
    return cell_.axis_direction.z > 0 ? rotations_.reduce(k) : rotations_.reduce(-k);
  }
  [[nodiscard]] Point2 rotated(const Point3& p, std::int32_t k) const {
    return center() + rotations_.rotate(planar(p) - center(), turn(k));
  }

  // Of the coordinates: what a correct mesh far from the origin may be off by.
  [[nodiscard]] double rounding() const {
    double largest = std::max(std::abs(center().x), std::abs(center().y));
    for (const Point3& p : cell_.points) {
      largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
    }
    return 16 * 0x1p-52 * largest;
  }

  [[nodiscard]] double restored_diameter() const {
    double reach = 0;
    for (const Point3& p : cell_.points) reach = std::max(reach, distance(planar(p), center()));
    return cell_.fold == 1 ? internal::diameter(cell_.points) : 2 * reach;
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
      const double off = distance(rotated(cell_.points[i], 1), planar(cell_.points[j]));
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

  // Boundary edges of the cell with both ends on the lower bound go to boundary edges that run the
  // other way; a lone edge of that kind would be a gap in the full mesh.
  bool check_bounds() {
    const std::vector<HalfEdge> edges = internal::sorted_edges(cell_);
    const std::vector<std::size_t> groups = internal::edge_groups(edges);
    std::vector<HalfEdge> boundary;
    for (std::size_t g = 0; g + 1 < groups.size(); ++g) {
      if (groups[g + 1] - groups[g] == 1) boundary.push_back(edges[groups[g]]);
    }
    const auto& pairs = cell_.lower_to_higher;
    std::size_t bound_edges = 0;
    std::string wrong;
    for (const HalfEdge& e : boundary) {
      const std::int32_t a = pairs[static_cast<std::size_t>(e.low)];
      const std::int32_t b = pairs[static_cast<std::size_t>(e.high)];
      if (a < 0 || b < 0) continue;
      const std::pair wanted(std::min(a, b), std::max(a, b));
      const auto image = std::ranges::lower_bound(
          boundary, wanted, {}, [](const HalfEdge& h) { return std::pair(h.low, h.high); });
      if (image == boundary.end() || std::pair(image->low, image->high) != wanted) continue;
      ++bound_edges;
      const bool same_way = image->ascending == (e.ascending == (a < b));
      if (same_way && wrong.empty()) {
        wrong = "edge " + std::to_string(e.low) + "-" + std::to_string(e.high) +
                " and its image have the cell on one side";
      }
    }
    return checks_.add("cell.bounds", wrong.empty(),
                       wrong.empty() ? std::to_string(bound_edges) + " edges on a bound" : wrong);
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
        const Point2 p = rotated(cell_.points[v % nodes], static_cast<std::int32_t>(v / nodes));
        full.points.push_back({p.x, p.y, 0});
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

  // Corners may be turned round within an element.
  [[nodiscard]] double copy_error(const MeshData& full, std::size_t e) const {
    const auto k = static_cast<std::size_t>(cell_.nodes_per_element);
    const auto source = static_cast<std::size_t>(full.cell_elements[e]);
    double best = kInfinity;
    for (std::size_t shift = 0; shift < 3; ++shift) {
      double worst = 0;
      for (std::size_t i = 0; i < k; ++i) {
        const std::size_t j = i < 3 ? (i + shift) % 3 : 3 + (i - 3 + shift) % 3;
        const Point3& from = cell_.points[static_cast<std::size_t>(cell_.elements[source * k + i])];
        const Point3& to = full.points[static_cast<std::size_t>(full.elements[e * k + j])];
        worst = std::max(worst, distance(rotated(from, full.sectors[e]), planar(to)));
      }
      best = std::min(best, worst);
      if (best <= tolerance_) break;
    }
    return best;
  }

  void check_copies(const MeshData& full) {
    std::string wrong;
    double worst = 0;
    const std::size_t elements = cell_.element_count();
    const auto n = static_cast<std::size_t>(cell_.fold);
    if (full.fold != cell_.fold || full.order != cell_.order ||
        distance(planar(full.axis_origin), center()) > tolerance_) {
      wrong = "fold, order or axis differ from the cell's";
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
    checks_.add("full.copies", wrong.empty(), wrong.empty() ? detail : wrong);
  }

  void check_area(const MeshData& full) {
    const double expected = internal::total_area(cell_) * cell_.fold;
    const double found = internal::total_area(full);
    const double allowed = 1e-9 * expected + 4 * tolerance_ * diameter_;
    checks_.add("full.area", std::abs(found - expected) <= allowed,
                shown(found) + ", cell times fold " + shown(expected));
    if (!options_.model_area) return;
    const double moved = 4 * options_.model_tolerance_rel * diameter_ * diameter_;
    checks_.add("model.area",
                std::abs(found - *options_.model_area) <= allowed + 1e-9 * expected + moved,
                shown(found) + ", the model's " + shown(*options_.model_area));
  }

  void tell_delaunay(const MeshData& full,
                     const std::vector<HalfEdge>& edges,
                     const std::vector<std::size_t>& groups,
                     const std::vector<char>& constrained) {
    const auto k = static_cast<std::size_t>(full.nodes_per_element);
    std::size_t inner = 0;
    std::size_t delaunay = 0;
    const auto point = [&](std::int32_t node) {
      return planar(full.points[static_cast<std::size_t>(node)]);
    };
    for (std::size_t g = 0; g + 1 < groups.size(); ++g) {
      if (groups[g + 1] - groups[g] != 2 || constrained[g] != 0) continue;
      const HalfEdge& first = edges[groups[g]];
      const HalfEdge& second = edges[groups[g] + 1];
      const std::int32_t* a = &full.elements[static_cast<std::size_t>(first.element) * k];
      const std::int32_t* b = &full.elements[static_cast<std::size_t>(second.element) * k];
      std::int32_t opposite = *b;
      for (std::size_t i = 0; i < 3; ++i) {
        if (b[i] != second.low && b[i] != second.high) opposite = b[i];
      }
      ++inner;
      const Sign inside = in_circle(point(a[0]), point(a[1]), point(a[2]), point(opposite));
      if (inside != Sign::kPositive) ++delaunay;
    }
    const double share =
        inner == 0 ? 1 : static_cast<double>(delaunay) / static_cast<double>(inner);
    checks_.add("full.delaunay", true,
                shown(100 * share) + " % of " + std::to_string(inner) + " free edges");
  }

  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  const MeshData& cell_;
  const MeshData* full_;
  const Pslg* model_;
  const VerifyOptions& options_;
  Checks checks_;
  RotationTable rotations_;
  double diameter_ = 0;
  double tolerance_ = 0;
};

}  // namespace

VerifyReport verify_mesh(const MeshData& cell,
                         const MeshData* full,
                         const Pslg* model,
                         const VerifyOptions& options) {
  VerifyReport report;
  Verifier(cell, full, model, options, report).run();
  return report;
}

}  // namespace symcell
