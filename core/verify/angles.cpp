// The angle bound of a planar mesh: what is below it must be forced by the model, which is found from
// the constrained edges alone.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/verify/against_model.hpp"

namespace symcell::internal {
namespace {

constexpr double kDegree = 180 / std::numbers::pi;
// Degrees: files may have rounded the coordinates, and an offset centre costs digits.
constexpr double kAngleTolerance = 1e-6;
constexpr double kStraight = 1e-6;    // radians by which a chain of edges may bend
constexpr double kShellRatio = 1e-3;  // distances on one shell agree this well

class AngleChecker {
 public:
  AngleChecker(const FacetedMesh& full,
               const std::vector<char>& constrained,
               const AngleBound& bound,
               Checks& checks)
      : full_(full), constrained_(constrained), bound_(bound), checks_(checks) {
    find_constrained_neighbours();
  }

  void run() {
    Flaws flaws;
    std::size_t exempt = 0;
    double least = 180;
    for (std::size_t e = 0; e < full_.mesh.element_count(); ++e) {
      double smallest = 180;
      for (std::size_t i = 0; i < 3; ++i) smallest = std::min(smallest, angle(e, i));
      if (smallest >= bound_.min_angle_deg - kAngleTolerance) continue;
      least = std::min(least, smallest);
      if (is_forced(e)) {
        ++exempt;
        continue;
      }
      flaws.note([&] {
        return "element " + std::to_string(e) + " has an angle of " + shown(smallest) +
               " degrees, which nothing in the model forces";
      });
    }
    flaws.report_beyond_bound(checks_, "full.min_angle",
                              exempt == 0
                                  ? ""
                                  : std::to_string(exempt) + " elements are below, down to " +
                                        shown(least) + " degrees, as the model forces");
  }

 private:
  [[nodiscard]] std::int32_t corner(std::size_t e, std::size_t i) const {
    return full_.mesh.elements[e * static_cast<std::size_t>(full_.mesh.nodes_per_element) + i % 3];
  }
  [[nodiscard]] Point2 at(std::int32_t node) const { return planar(full_.point(node)); }

  [[nodiscard]] double angle_at(std::int32_t apex, std::int32_t a, std::int32_t b) const {
    const Point2 u = at(a) - at(apex), v = at(b) - at(apex);
    return std::atan2(std::abs(cross(u, v)), dot(u, v)) * kDegree;
  }
  [[nodiscard]] double angle(std::size_t e, std::size_t i) const {
    return angle_at(corner(e, i), corner(e, i + 1), corner(e, i + 2));
  }

  // The group of the edge opposite corner i.
  [[nodiscard]] std::size_t edge(std::size_t e, std::size_t i) const {
    std::array<std::int32_t, 3> nodes{corner(e, i + 1), corner(e, i + 2), -1};
    sort_facet(nodes, 2);
    return full_.find(nodes);
  }

  void find_constrained_neighbours() {
    first_.assign(full_.mesh.points.size() + 1, 0);
    const auto each = [&](const auto& f) {
      for (std::size_t g = 0; g < full_.group_count(); ++g) {
        if (constrained_[g] == 0 && full_.sides(g) == 2) continue;
        f(full_.first(g).nodes[0], full_.first(g).nodes[1]);
      }
    };
    each([&](std::int32_t a, std::int32_t b) {
      ++first_[static_cast<std::size_t>(a) + 1];
      ++first_[static_cast<std::size_t>(b) + 1];
    });
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    std::vector<std::size_t> next = first_;
    neighbours_.resize(first_.back());
    each([&](std::int32_t a, std::int32_t b) {
      neighbours_[next[static_cast<std::size_t>(a)]++] = b;
      neighbours_[next[static_cast<std::size_t>(b)]++] = a;
    });
  }
  [[nodiscard]] std::span<const std::int32_t> constrained_around(std::int32_t node) const {
    const std::size_t begin = first_[static_cast<std::size_t>(node)];
    return {neighbours_.data() + begin, first_[static_cast<std::size_t>(node) + 1] - begin};
  }

  // The angle at corner i of element e from one constrained edge to the next; 360 if there is none.
  [[nodiscard]] double model_angle(std::size_t e, std::size_t i) const {
    double sum = angle(e, i);
    const std::int32_t node = corner(e, i);
    for (const std::size_t side : {std::size_t{1}, std::size_t{2}}) {
      std::size_t element = e, c = i, over = side;
      for (;;) {
        // The edge at the node on this side is opposite the other of the two further corners.
        const std::size_t g = edge(element, c + over);
        if (full_.sides(g) != 2 || constrained_[g] != 0) break;
        const std::int32_t shared = corner(element, c + 3 - over);
        const auto& half = static_cast<std::size_t>(full_.first(g).element) == element
                               ? full_.second(g)
                               : full_.first(g);
        element = static_cast<std::size_t>(half.element);
        if (element == e) return 360;
        c = index_of(element, node);
        over = corner(element, c + 1) == shared ? 1 : 2;
        sum += angle(element, c);
      }
    }
    return sum;
  }

  [[nodiscard]] std::size_t index_of(std::size_t e, std::int32_t node) const {
    for (std::size_t i = 0; i < 3; ++i) {
      if (corner(e, i) == node) return i;
    }
    return 0;
  }

  [[nodiscard]] bool is_forced(std::size_t e) const {
    const double bound = bound_.min_angle_deg + kAngleTolerance;
    const double sector = 360.0 / full_.mesh.fold;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t node = corner(e, i);
      const bool at_centre = distance(at(node), planar(full_.mesh.axis_origin)) <= bound_.place;
      // Between copies of one segment the model asks for no angle but the fold's.
      const double narrow = at_centre ? std::min(bound, sector - kAngleTolerance) : bound;
      if (constrained_around(node).size() > 1 && model_angle(e, i) < narrow) return true;
      if (at_centre && sector < bound && fills_sector(e, i, sector)) return true;
    }
    return spans_narrow_corner(e, bound);
  }

  // At the centre the fold forces the angle of (centre, a, Ra), and no other.
  [[nodiscard]] bool fills_sector(std::size_t e, std::size_t at_centre, double sector) const {
    const double others = std::min(bound_.min_angle_deg, (180 - sector) / 2) - kAngleTolerance;
    return angle(e, at_centre) >= sector - kAngleTolerance && angle(e, at_centre + 1) >= others &&
           angle(e, at_centre + 2) >= others;
  }

  // Whether the shortest edge runs between two straight chains that meet in a narrow corner, its
  // ends equally far from it.
  [[nodiscard]] bool spans_narrow_corner(std::size_t e, double bound) const {
    std::size_t shortest = 0;
    const auto length_of = [&](std::size_t i) {
      return distance(at(corner(e, i + 1)), at(corner(e, i + 2)));
    };
    for (std::size_t i = 1; i < 3; ++i) {
      if (length_of(i) < length_of(shortest)) shortest = i;
    }
    const std::int32_t u = corner(e, shortest + 1), v = corner(e, shortest + 2);
    std::vector<std::int32_t> along_u = straight_from(u), along_v = straight_from(v);
    std::ranges::sort(along_v);
    for (const std::int32_t w : along_u) {
      if (w == u || w == v || !std::ranges::binary_search(along_v, w)) continue;
      const double a = distance(at(u), at(w)), b = distance(at(v), at(w));
      if (std::abs(a - b) <= kShellRatio * a && angle_at(w, u, v) < bound) return true;
    }
    return false;
  }

  // The nodes of all straight chains of constrained edges that start at a node.
  [[nodiscard]] std::vector<std::int32_t> straight_from(std::int32_t node) const {
    std::vector<std::int32_t> reached;
    for (const std::int32_t first : constrained_around(node)) {
      const Point2 along = at(first) - at(node);
      std::int32_t now = first;
      for (std::size_t steps = 0; steps < full_.mesh.points.size(); ++steps) {
        reached.push_back(now);
        std::int32_t next = -1;
        for (const std::int32_t to : constrained_around(now)) {
          const Point2 d = at(to) - at(now);
          if (dot(d, along) > 0 && std::abs(cross(d, along)) <= kStraight * dot(d, along)) {
            next = to;
          }
        }
        if (next < 0) break;
        now = next;
      }
    }
    return reached;
  }

  const FacetedMesh& full_;
  const std::vector<char>& constrained_;
  const AngleBound& bound_;
  Checks& checks_;
  std::vector<std::size_t> first_;        // per node, in neighbours_
  std::vector<std::int32_t> neighbours_;  // along constrained edges
};

}  // namespace

void check_angles(const FacetedMesh& full,
                  const std::vector<char>& constrained,
                  const AngleBound& bound,
                  Checks& checks) {
  AngleChecker(full, constrained, bound, checks).run();
}

}  // namespace symcell::internal
