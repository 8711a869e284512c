#include "tests/support/random_planar_cells.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <utility>

#include "core/base/index.hpp"
#include "core/base/random.hpp"
#include "tests/support/layered_cells.hpp"
#include "tests/support/placement.hpp"

namespace symcell::test {
namespace {

class PlanarMaker {
 public:
  PlanarMaker(std::uint64_t seed, std::optional<std::int32_t> fold) : random_(seed ^ 0x91a7a2u) {
    const double pick = random_.uniform();
    const std::int32_t most = pick < 0.15 ? 1 : pick < 0.8 ? 12 : 100;
    const std::int32_t any = 1 + static_cast<std::int32_t>(random_.uniform() * most);
    made_.fold = fold.value_or(any);
    LayeredOptions options;
    options.layers = 1;
    options.pinches = chance(0.2);
    cells_ = make_layered_cells(random_, made_.fold, options);
    cells_.taper = 0;
    cells_.heights = {0, 1};
  }

  RandomPlanarCells run() {
    choose_edges();
    write_segments();
    add_seeds();
    describe();
    place();
    return std::move(made_);
  }

 private:
  bool chance(double p) { return random_.uniform() < p; }
  double between(double low, double high) { return low + (high - low) * random_.uniform(); }
  [[nodiscard]] const SectorGrid& grid() const { return cells_.grid; }
  [[nodiscard]] std::int32_t left(const GridEdge& e) const { return cells_.material(0, e.left); }
  [[nodiscard]] std::int32_t right(const GridEdge& e) const { return cells_.material(0, e.right); }

  // Borders, and within material partitions that may end anywhere.
  void choose_edges() {
    const Coin partition(random_, chance(0.4) ? 0.2 : 0);
    for (const GridEdge& e : grid().edges) {
      const bool inside = left(e) == right(e) && left(e) != 0 && partition(e.orbit);
      wanted_.push_back(left(e) != right(e) || inside ? 1 : 0);
      divided_ = divided_ || inside || (wanted_.back() != 0 && left(e) != 0 && right(e) != 0);
    }
  }

  // Segments of one line and marker become one where nothing else ends: all copies or none. Where
  // something does, it may end inside the segment; one line at most runs on there.
  void write_segments() {
    const bool marked = chance(0.5);
    const Coin marker(random_, 0), joins(random_, chance(0.5) ? 0.7 : 0);
    const double passes = chance(0.5) ? 0.6 : 0;
    std::vector<std::int32_t> markers;
    for (const GridEdge& e : grid().edges) {
      markers.push_back(marked ? static_cast<std::int32_t>(3 * marker.share(e.orbit)) : 0);
    }
    std::vector<std::int32_t> segment(grid().edges.size());  // another edge of its segment
    std::iota(segment.begin(), segment.end(), 0);
    const auto root = [&](std::int32_t e) {
      while (segment[at(e)] != e) e = segment[at(e)];
      return e;
    };
    std::vector<char> left_out(grid().points.size(), 0);
    for (std::size_t p = 0; p < grid().points.size(); ++p) {
      std::map<std::int32_t, std::vector<std::int32_t>> lines;
      for (const std::int32_t e : grid().edges_at[p]) {
        if (wanted_[at(e)] != 0) lines[grid().edges[at(e)].line].push_back(e);
      }
      for (const auto& [line, edges] : lines) {
        if (edges.size() != 2 || markers[at(edges[0])] != markers[at(edges[1])]) continue;
        const bool alone = lines.size() == 1;
        if (alone ? !joins(grid().point_orbit[p]) : !chance(passes)) continue;
        segment[at(root(edges[0]))] = root(edges[1]);
        left_out[p] = alone ? 1 : 0;
        break;
      }
    }
    std::map<std::int32_t, std::map<std::int32_t, int>> ends;  // per segment: points and their uses
    for (std::size_t e = 0; e < grid().edges.size(); ++e) {
      if (wanted_[e] == 0) continue;
      auto& uses = ends[root(static_cast<std::int32_t>(e))];
      ++uses[grid().edges[e].a];
      ++uses[grid().edges[e].b];
    }
    std::vector<std::int32_t> index(grid().points.size(), -1);
    for (const auto& [first, uses] : ends) {
      std::vector<std::int32_t> tips;
      for (const auto& [point, count] : uses) {
        if (left_out[at(point)] == 0 && index[at(point)] < 0) {
          index[at(point)] = static_cast<std::int32_t>(made_.pslg.vertices.size());
          made_.pslg.vertices.push_back(grid().points[at(point)]);
        }
        if (count == 1) tips.push_back(point);
      }
      if (chance(0.5)) std::swap(tips[0], tips[1]);
      made_.pslg.segments.push_back({index[at(tips[0])], index[at(tips[1])], markers[at(first)]});
    }
  }

  void add_seeds() {
    const auto count = static_cast<std::int32_t>(grid().cells.size());
    std::vector<std::int32_t> part(at(count) + 1);
    std::iota(part.begin(), part.end(), 0);
    const auto root = [&](std::int32_t i) {
      while (part[at(i)] != i) i = part[at(i)] = part[at(part[at(i)])];
      return i;
    };
    const auto slot = [&](std::int32_t cell) { return cell < 0 ? count : cell; };
    for (std::size_t e = 0; e < grid().edges.size(); ++e) {
      if (wanted_[e] != 0) continue;
      part[at(root(slot(grid().edges[e].left)))] = root(slot(grid().edges[e].right));
    }
    const bool regions = divided_ && chance(0.8);
    const double bounded = chance(0.3) ? between(0.02, 0.2) : 0;
    std::vector<char> seen(part.size(), 0);
    seen[at(root(count))] = 1;
    for (std::int32_t c = 0; c < count; ++c) {
      char& done = seen[at(root(c))];
      if (done != 0) continue;
      done = 1;
      const std::int32_t fill = cells_.material(0, c);
      if (fill == 0) {
        made_.pslg.holes.push_back(grid().middle(c));
      } else if (regions) {
        PslgRegion region{grid().middle(c), fill};
        if (bounded > 0 && fill == 1) region.max_area = bounded / made_.fold;
        made_.pslg.regions.push_back(region);
      }
    }
  }

  void describe() {
    made_.description = std::to_string(made_.fold) + "-fold cells: " + cells_.description;
    if (divided_) made_.description += ", divided";
    for (std::int32_t c = 0; c < static_cast<std::int32_t>(grid().cells.size()); ++c) {
      if (cells_.material(0, c) != 0) made_.area += grid().area(c);
    }
    for (const auto& [low, high] : pinches_of(cells_).edges) {
      if (low.z != high.z) made_.pinches.push_back({low.x, low.y});
    }
    if (!made_.pinches.empty()) made_.description += ", pinched";
    std::vector<std::array<std::int64_t, 2>> rim;
    for (const GridEdge& e : grid().edges) {
      if ((left(e) == 0) != (right(e) == 0)) rim.push_back({e.a, e.b});
    }
    made_.boundary = boundary_topology(rim);
  }

  void place() {
    if (chance(0.6)) made_.scale = std::pow(10, between(-3, 3));
    const double angle = chance(0.3) ? 0 : between(0, 2 * std::numbers::pi);
    const double c = std::cos(angle), s = std::sin(angle);
    if (chance(0.7)) {
      made_.center = made_.scale * Point2{between(-20, 20), between(-20, 20)};
    }
    const auto put = [&](Point2& p) {
      p = made_.scale * Point2{c * p.x - s * p.y, s * p.x + c * p.y} + made_.center;
    };
    for (Point2& p : made_.pslg.vertices) put(p);
    for (Point2& p : made_.pslg.holes) put(p);
    for (PslgRegion& r : made_.pslg.regions) {
      put(r.point);
      r.max_area *= made_.scale * made_.scale;
    }
    for (Point2& p : made_.pinches) put(p);
    made_.area *= made_.scale * made_.scale;
  }

  Random random_;
  RandomPlanarCells made_;
  LayeredCells cells_;
  std::vector<char> wanted_;  // per edge
  bool divided_ = false;
};

}  // namespace

RandomPlanarCells make_random_planar_cells(std::uint64_t seed, std::optional<std::int32_t> fold) {
  return PlanarMaker(seed, fold).run();
}

}  // namespace symcell::test
