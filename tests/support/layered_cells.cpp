#include "tests/support/layered_cells.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

#include "core/base/index.hpp"

namespace symcell::test {
namespace {

// A prism of the stack, or a place where none is.
struct Slot {
  std::int32_t layer = 0;
  std::int32_t cell = 0;
  friend auto operator<=>(const Slot&, const Slot&) = default;
};

// What is round an edge or corner: slots, and which of them share a face there.
struct Surroundings {
  std::vector<Slot> slots;
  std::vector<std::pair<std::size_t, std::size_t>> faces;
};

// How many parts the slots with or without material make.
std::size_t parts(const LayeredCells& cells, const Surroundings& round, bool filled) {
  std::vector<std::size_t> part(round.slots.size());
  std::iota(part.begin(), part.end(), std::size_t{0});
  const auto counts = [&](std::size_t i) {
    return (cells.material(round.slots[i].layer, round.slots[i].cell) != 0) == filled;
  };
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& [i, j] : round.faces) {
      if (!counts(i) || !counts(j) || part[i] == part[j]) continue;
      part[i] = part[j] = std::min(part[i], part[j]);
      changed = true;
    }
  }
  std::set<std::size_t> found;
  for (std::size_t i = 0; i < part.size(); ++i) {
    if (counts(i)) found.insert(part[i]);
  }
  return found.size();
}

// The slots of `layers` round a point or along an edge of the grid.
Surroundings surroundings(const std::vector<std::pair<std::int32_t, std::int32_t>>& neighbours,
                          std::int32_t first_layer,
                          std::int32_t layers) {
  Surroundings round;
  std::vector<std::int32_t> around;
  for (const auto& [a, b] : neighbours) around.insert(around.end(), {a, b});
  std::sort(around.begin(), around.end());
  around.erase(std::unique(around.begin(), around.end()), around.end());
  const auto place = [&](std::int32_t layer, std::int32_t cell) {
    const auto i = std::lower_bound(around.begin(), around.end(), cell) - around.begin();
    return at(layer) * around.size() + static_cast<std::size_t>(i);
  };
  for (std::int32_t layer = 0; layer < layers; ++layer) {
    for (const std::int32_t cell : around) {
      round.slots.push_back({first_layer + layer, cell});
      if (layer > 0) round.faces.emplace_back(place(layer - 1, cell), place(layer, cell));
    }
    for (const auto& [a, b] : neighbours)
      round.faces.emplace_back(place(layer, a), place(layer, b));
  }
  return round;
}

using Place = std::pair<std::int32_t, std::int32_t>;  // point and level

std::pair<Place, Place> ordered(Place a, Place b) {
  return a < b ? std::pair{a, b} : std::pair{b, a};
}

// Calls visit(surroundings, ends) for each edge and corner of the stack, or for one an orbit.
template <class Visit>
void for_each_place(const LayeredCells& cells, bool one_an_orbit, const Visit& visit) {
  using Ends = std::vector<Place>;
  const SectorGrid& grid = cells.grid;
  for (std::int32_t level = 0; level <= cells.layers(); ++level) {
    std::set<std::int32_t> edges_seen, points_seen;
    for (const GridEdge& e : grid.edges) {
      if (one_an_orbit && !edges_seen.insert(e.orbit).second) continue;
      visit(surroundings({{e.left, e.right}}, level - 1, 2), Ends{{e.a, level}, {e.b, level}});
    }
    for (std::size_t p = 0; p < grid.points.size(); ++p) {
      if (one_an_orbit && !points_seen.insert(grid.point_orbit[p]).second) continue;
      const auto point = static_cast<std::int32_t>(p);
      std::vector<std::pair<std::int32_t, std::int32_t>> neighbours;
      for (const std::int32_t e : grid.edges_at[p]) {
        neighbours.emplace_back(grid.edges[at(e)].left, grid.edges[at(e)].right);
      }
      visit(surroundings(neighbours, level - 1, 2), Ends{{point, level}});
      if (level == cells.layers()) continue;
      visit(surroundings(neighbours, level, 1), Ends{{point, level}, {point, level + 1}});
    }
  }
}

class Filler {
 public:
  Filler(Random& random, std::int32_t fold, const LayeredOptions& options)
      : random_(random), options_(options) {
    made_.grid = make_sector_grid(random, fold, options.tabs);
  }

  LayeredCells run() {
    add_levels();
    made_.fill.assign(at(made_.layers()) * made_.grid.cells.size(), 0);
    if (options_.tabs) {
      tabs();
    } else {
      start();
    }
    std::int32_t cuts = 0, adds = 0;
    for (std::int32_t i = options_.tabs ? any(0, 1) : any(1, 5); i > 0; --i) {
      const bool cut = chance(0.5);
      ++(cut ? cuts : adds);
      box(cut ? 0 : any(1, kinds_));
    }
    make_sure_of_something();
    if (!options_.pinches) mend();
    std::string& text = made_.description;
    text = made_.grid.description + ", " + std::to_string(made_.layers()) + " layers, " + start_ +
           ", " + std::to_string(adds) + " added, " + std::to_string(cuts) + " cut";
    if (kinds_ > 1) text += ", " + std::to_string(kinds_) + " materials";
    if (made_.taper != 0) text += ", tapered";
    return std::move(made_);
  }

 private:
  bool chance(double p) { return random_.uniform() < p; }
  double between(double low, double high) { return low + (high - low) * random_.uniform(); }
  std::int32_t any(std::int32_t low, std::int32_t high) {  // both may come
    return low +
           static_cast<std::int32_t>(random_.next() % static_cast<std::uint64_t>(high - low + 1));
  }

  void add_levels() {
    const std::int32_t layers = any(options_.tabs ? 2 : 1, options_.layers);
    const bool thin = chance(0.25);
    made_.heights = {0};
    for (std::int32_t i = 0; i < layers; ++i) {
      made_.heights.push_back(made_.heights.back() +
                              (thin && chance(0.3) ? 0.04 : between(0.15, 0.6)));
    }
    if (chance(0.25)) made_.taper = between(-0.3, 0.3) / made_.heights.back();
    kinds_ = chance(0.5) ? 1 : any(1, options_.kinds);
  }

  // All of it, a plate, a hub, or every prism by chance.
  void start() {
    const std::int32_t kind = any(0, 3);
    constexpr const char* kNames[] = {"full", "plate", "hub", "mixed"};
    start_ = kNames[kind];
    const std::int32_t top = kind == 1 ? any(0, made_.layers() - 1) : made_.layers() - 1;
    const std::int32_t rim = kind == 2 ? any(0, made_.grid.rings - 1) : made_.grid.rings - 1;
    const double share = kind == 3 ? between(0.4, 0.9) : 1;
    for (std::int32_t layer = 0; layer <= top; ++layer) {
      for (std::int32_t orbit = 0; orbit < made_.grid.cell_orbits; ++orbit) {
        const std::int32_t fill = chance(share) ? any(1, kinds_) : 0;
        set(layer, fill, [&](const GridCell& c) { return c.orbit == orbit && c.u <= rim; });
      }
    }
  }

  // A full body; tabs grow out of some of its sides, pockets go into some, mostly away from the
  // bottom and the top.
  void tabs() {
    start_ = "tabs";
    const bool apart = made_.layers() > 2 && chance(0.8);
    const double tabbed = between(0.1, 0.5), pocketed = chance(0.4) ? between(0, 0.3) : 0;
    for (std::int32_t layer = 0; layer < made_.layers(); ++layer) {
      set(layer, any(1, kinds_), [](const GridCell& c) { return !c.outer; });
      if (apart && (layer == 0 || layer + 1 == made_.layers())) continue;
      std::vector<std::int32_t> reach;  // of the tab in every column or place
      for (std::int32_t i = 0; i < std::max(made_.grid.cell_orbits, made_.grid.columns); ++i) {
        reach.push_back(chance(tabbed) ? any(1, made_.grid.rings) : -1);
      }
      set(layer, any(1, kinds_), [&](const GridCell& c) {
        return c.outer && c.u <= reach[at(made_.grid.arms ? c.v : c.orbit)];
      });
      for (std::int32_t orbit = 0; orbit < made_.grid.cell_orbits; ++orbit) {
        if (!chance(pocketed)) continue;
        set(layer, 0, [&](const GridCell& c) { return c.orbit == orbit && !c.outer; });
      }
    }
  }

  template <class Which>
  void set(std::int32_t layer, std::int32_t fill, const Which& which) {
    const auto& all = made_.grid.cells;
    std::set<std::int32_t> orbits;
    for (const GridCell& c : all) {
      if (!c.hollow && which(c)) orbits.insert(c.orbit);
    }
    for (std::size_t c = 0; c < all.size(); ++c) {
      if (orbits.contains(all[c].orbit)) made_.fill[at(layer) * all.size() + c] = fill;
    }
  }

  std::pair<std::int32_t, std::int32_t> range(std::int32_t count) {
    const std::int32_t a = any(0, count - 1), b = any(0, count - 1);
    if (chance(0.4)) return {a, a};
    return std::minmax(a, b);
  }

  void box(std::int32_t fill) {
    const auto [low, high] = range(made_.layers());
    const auto u = range(made_.grid.rings);
    const auto v = range(made_.grid.columns);
    const bool all_round = chance(0.2), inverse = !all_round && chance(0.15);
    for (std::int32_t layer = low; layer <= high; ++layer) {
      set(layer, fill, [&](const GridCell& c) {
        if (c.u < u.first || c.u > u.second) return false;
        return c.v < 0 || all_round || (c.v >= v.first && c.v <= v.second) != inverse;
      });
    }
  }

  void make_sure_of_something() {
    if (made_.volume() > 0) return;
    for (std::int32_t layer = 0; layer < made_.layers(); ++layer) {
      set(layer, 1, [](const GridCell&) { return true; });
    }
  }

  // Empties or fills where material or void touches itself in an edge or corner; after a while it
  // fills only, which ends at the latest when all is full.
  void mend() {
    for (std::int32_t round = 0;; ++round) {
      std::vector<Slot> choice;
      for_each_place(made_, true, [&](const Surroundings& s, const auto&) {
        if (!choice.empty()) return;
        if (parts(made_, s, true) <= 1 && parts(made_, s, false) <= 1) return;
        for (const Slot slot : s.slots) {
          if (slot.layer < 0 || slot.layer >= made_.layers() || slot.cell < 0) continue;
          if (made_.grid.cells[at(slot.cell)].hollow) continue;
          choice.push_back(slot);
        }
      });
      if (choice.empty()) break;
      const std::int32_t fill = round < 40 && chance(0.4) ? 0 : any(1, kinds_);
      std::vector<Slot> other;
      for (const Slot slot : choice) {
        if ((made_.material(slot.layer, slot.cell) == 0) != (fill == 0)) other.push_back(slot);
      }
      if (other.empty()) continue;
      const Slot slot = other[random_.next() % other.size()];
      const std::int32_t orbit = made_.grid.cells[at(slot.cell)].orbit;
      set(slot.layer, fill, [&](const GridCell& c) { return c.orbit == orbit; });
      if (fill == 0) make_sure_of_something();
    }
  }

  Random& random_;
  const LayeredOptions& options_;
  LayeredCells made_;
  std::int32_t kinds_ = 1;
  std::string start_;
};

}  // namespace

std::int32_t LayeredCells::material(std::int32_t layer, std::int32_t cell) const {
  if (layer < 0 || layer >= layers() || cell < 0) return 0;
  return fill[at(layer) * grid.cells.size() + at(cell)];
}

Point3 LayeredCells::position(Point2 p, double z) const {
  const double scale = 1 + taper * z;
  return {scale * p.x, scale * p.y, z};
}

Point3 LayeredCells::position(std::int32_t point, std::int32_t level) const {
  return position(grid.points[at(point)], heights[at(level)]);
}

double LayeredCells::volume() const {
  double sum = 0;
  for (std::int32_t layer = 0; layer < layers(); ++layer) {
    const double low = 1 + taper * heights[at(layer)], high = 1 + taper * heights[at(layer + 1)];
    const double share =
        (heights[at(layer + 1)] - heights[at(layer)]) * (low * low + low * high + high * high) / 3;
    for (std::int32_t c = 0; c < static_cast<std::int32_t>(grid.cells.size()); ++c) {
      if (material(layer, c) != 0) sum += share * grid.area(c);
    }
  }
  return sum;
}

LayeredCells make_layered_cells(Random& random, std::int32_t fold, const LayeredOptions& options) {
  return Filler(random, fold, options).run();
}

Pinches pinches_of(const LayeredCells& cells) {
  Pinches result;
  for_each_place(cells, false, [&](const Surroundings& round, const auto& ends) {
    if (parts(cells, round, true) <= 1) return;
    std::vector<Point3> points;
    for (const auto& [point, level] : ends) points.push_back(cells.position(point, level));
    if (points.size() == 2) {
      result.edges.push_back({points[0], points[1]});
    } else {
      result.points.push_back(points[0]);
    }
  });
  return result;
}

BoundaryTopology boundary_topology(const LayeredCells& cells) {
  BoundaryTopology result;
  std::set<Place> corners;
  std::set<std::pair<Place, Place>> edges;
  for_each_place(cells, false, [&](const Surroundings& round, const auto& ends) {
    if (parts(cells, round, true) == 0 || parts(cells, round, false) == 0) return;
    if (ends.size() == 1) {
      corners.insert(ends[0]);
    } else {
      edges.insert(ordered(ends[0], ends[1]));
    }
  });
  std::int64_t faces = 0;
  for (std::int32_t layer = 0; layer <= cells.layers(); ++layer) {
    for (std::int32_t c = 0; c < static_cast<std::int32_t>(cells.grid.cells.size()); ++c) {
      faces += (cells.material(layer - 1, c) != 0) != (cells.material(layer, c) != 0) ? 1 : 0;
    }
    for (const GridEdge& e : cells.grid.edges) {
      faces +=
          (cells.material(layer, e.left) != 0) != (cells.material(layer, e.right) != 0) ? 1 : 0;
    }
  }
  result.euler =
      static_cast<std::int64_t>(corners.size()) - static_cast<std::int64_t>(edges.size()) + faces;
  // Pieces by walking from corner to corner along edges.
  std::set<Place> left = corners;
  while (!left.empty()) {
    ++result.pieces;
    std::vector<Place> stack{*left.begin()};
    left.erase(left.begin());
    while (!stack.empty()) {
      const std::int32_t point = stack.back().first, level = stack.back().second;
      stack.pop_back();
      const auto visit = [&](Place from, Place to) {
        if (!edges.contains(ordered(from, to))) return;
        const Place& other = from.first == point && from.second == level ? to : from;
        if (left.erase(other) != 0) stack.push_back(other);
      };
      visit({point, level}, {point, level + 1});
      visit({point, level - 1}, {point, level});
      for (const std::int32_t e : cells.grid.edges_at[at(point)]) {
        visit({cells.grid.edges[at(e)].a, level}, {cells.grid.edges[at(e)].b, level});
      }
    }
  }
  return result;
}

}  // namespace symcell::test
