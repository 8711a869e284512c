#include "tests/support/random_layers.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include "core/base/index.hpp"
#include "core/base/random.hpp"
#include "tests/support/layered_facets.hpp"
#include "tests/support/placement.hpp"

namespace symcell::test {
namespace {

class PlcMaker {
 public:
  PlcMaker(std::uint64_t seed, const RandomLayersOptions& options)
      : random_(seed ^ 0x1a7e25u), options_(options) {
    made_.fold = random_fold(random_, options);
    LayeredOptions layered;
    layered.tabs = options.tabs;
    if (options.tabs) layered.layers = 5;
    layered.pinches = chance(0.1) && options.pinches;
    cells_ = make_layered_cells(random_, made_.fold, layered);
  }

  RandomPlc run() {
    choose_facets();
    write_facets();
    add_seeds();
    describe();
    place();
    return std::move(made_);
  }

 private:
  bool chance(double p) { return random_.uniform() < p; }

  struct Facet {
    FacetOutline outline;
    std::int32_t marker = 0;
    std::int64_t line = -1;  // of the grid, which a wall stands on; -1: level
  };

  void choose_facets() {
    const double partitions = chance(0.3) ? 0.15 : 0;
    const Coin partition(random_, options_.loose ? partitions : 0);
    const std::int32_t markers = static_cast<std::int32_t>(random_.next() % 3);
    const Coin marker(random_, 0);
    constexpr double kMerges[] = {1, 0.7, 0};
    const Coin merges(random_, kMerges[random_.next() % 3]);
    const Coin seam(random_, chance(0.2) && options_.loose ? 0.3 : 0);
    sheets_ = make_sheets(cells_);
    for (const Sheet& sheet : sheets_) {
      std::vector<char> wanted;
      for (const SheetFace& f : sheet) {
        const bool border = f.front != f.back;
        const bool inside = !border && f.front != 0 && partition(f.orbit);
        wanted.push_back(border || inside ? 1 : 0);
        if (inside || (border && f.front != 0 && f.back != 0)) made_.plain_surface = false;
        if (wanted.back() == 0) continue;
        for (std::size_t i = 0; i < f.corners.size(); ++i) ++uses_[side(f, i)];
      }
      wanted_.push_back(std::move(wanted));
    }
    const auto marker_of = [&](const SheetFace& f) {
      if (markers == 0) return 0;
      return markers == 1 ? f.kind : static_cast<std::int32_t>(1 + 3 * marker.share(f.orbit));
    };
    for (std::size_t s = 0; s < sheets_.size(); ++s) {
      const bool level = s < cells_.heights.size();
      const auto joins = [&](const SheetFace& f, std::size_t i, const SheetFace& g) {
        return marker_of(f) == marker_of(g) && merges(f.side_orbits[i]) && !crossed(f, i, level);
      };
      for (FacetOutline& o : make_outlines(sheets_[s], wanted_[s], joins)) {
        keep_seams(sheets_[s], level, seam, o);
        const std::int32_t m = marker_of(sheets_[s][at(o.face)]);
        const std::int64_t line = level ? -1 : static_cast<std::int64_t>(s - cells_.heights.size());
        facets_.push_back({std::move(o), m, line});
      }
    }
  }

  using Side = std::pair<std::int32_t, std::int32_t>;
  static Side side(const SheetFace& f, std::size_t i) {
    return std::minmax({f.corners[i], f.corners[(i + 1) % f.corners.size()]});
  }
  // Facets may not pass through each other: where four faces meet, walls end. If nothing may end
  // inside a facet, all do where three meet.
  [[nodiscard]] bool crossed(const SheetFace& f, std::size_t i, bool level) const {
    const int uses = uses_.at(side(f, i));
    return (!level && uses > 3) || (!options_.touching && uses > 2);
  }

  // Some of the sides within a facet stay, as segments within it.
  void keep_seams(const Sheet& sheet, bool level, const Coin& seam, FacetOutline& outline) const {
    std::set<std::array<std::int32_t, 2>> kept;
    for (const SheetFace& f : sheet) {
      for (std::size_t i = 0; i < f.corners.size(); ++i) {
        if (!uses_.contains(side(f, i))) continue;
        if (!seam(f.side_orbits[i]) && !crossed(f, i, level)) continue;
        const auto [a, b] = side(f, i);
        kept.insert({{a, b}, {b, a}});
      }
    }
    std::erase_if(outline.seams, [&](const auto& s) { return !kept.contains(s); });
  }

  // A corner that is straight in every outline goes or stays with its copies; one that is a corner
  // of some facet may be left out of those along whose outline it lies.
  void write_facets() {
    const Coin stays(random_, chance(0.5) ? 1 : 0.3);
    const double listed = chance(0.5) ? 1 : 0.4;
    constexpr char kCorner = 1, kCrossing = 2;
    std::vector<char> needed(cells_.grid.points.size() * cells_.heights.size(), 0);
    std::map<std::int32_t, std::int64_t> passing;
    for (const Facet& f : facets_) {
      for (const auto& loop : f.outline.loops) {
        for (const OutlineCorner& c : loop) {
          if (!c.straight) needed[at(c.vertex)] |= kCorner;
          if (c.straight && !runs_through(f, c, passing)) needed[at(c.vertex)] |= kCrossing;
        }
      }
      for (const auto& s : f.outline.seams) needed[at(s[0])] = needed[at(s[1])] = kCorner;
    }
    std::vector<std::int32_t> index(needed.size(), -1);
    const auto use = [&](std::int32_t v) {
      if (index[at(v)] < 0) {
        index[at(v)] = static_cast<std::int32_t>(made_.plc.vertices.size());
        made_.plc.vertices.push_back(position(v));
      }
      return index[at(v)];
    };
    for (const Facet& f : facets_) {
      PlcFacet facet;
      facet.marker = f.marker;
      facet.holes = f.outline.holes;
      // What an outline or a seam of the facet ends at, its other outlines may not pass over.
      std::map<std::int32_t, int> times;
      for (const auto& loop : f.outline.loops) {
        for (const OutlineCorner& c : loop) ++times[c.vertex];
      }
      for (const auto& s : f.outline.seams) times[s[0]] = times[s[1]] = 2;
      for (const auto& loop : f.outline.loops) {
        std::vector<std::int32_t> polygon;
        for (const OutlineCorner& c : loop) {
          const bool must =
              !c.straight || (needed[at(c.vertex)] == kCrossing && index[at(c.vertex)] < 0);
          bool keep =
              needed[at(c.vertex)] != 0 ? must || chance(listed) : stays(vertex_orbit(c.vertex));
          if (times[c.vertex] > 1 || (needed[at(c.vertex)] != 0 && !options_.touching)) keep = true;
          if (keep) polygon.push_back(use(c.vertex));
        }
        facet.polygons.push_back(std::move(polygon));
      }
      for (const auto& s : f.outline.seams) facet.polygons.push_back({use(s[0]), use(s[1])});
      made_.plc.facets.push_back(std::move(facet));
    }
  }

  // Whether all outlines that run straight through the corner do so on one line; `passing`: the line
  // of those before, per vertex. Where two lines cross there is a vertex.
  static bool runs_through(const Facet& f,
                           const OutlineCorner& c,
                           std::map<std::int32_t, std::int64_t>& passing) {
    constexpr std::int64_t kUpright = -1;
    const bool level = f.line < 0;
    const std::int64_t line = level ? c.line : (c.line < 0 ? f.line : kUpright);
    return passing.try_emplace(c.vertex, line).first->second == line;
  }

  [[nodiscard]] Point3 position(std::int32_t vertex) const {
    const auto points = static_cast<std::int32_t>(cells_.grid.points.size());
    return cells_.position(vertex % points, vertex / points);
  }
  [[nodiscard]] std::int64_t vertex_orbit(std::int32_t vertex) const {
    const auto points = static_cast<std::int32_t>(cells_.grid.points.size());
    return 1'000'000 * (vertex / points) + cells_.grid.point_orbit[at(vertex % points)];
  }

  // A seed in every cavity, and in every part of material where there are several.
  void add_seeds() {
    const auto count = static_cast<std::int32_t>(cells_.grid.cells.size());
    const std::int32_t layers = cells_.layers();
    std::vector<std::int32_t> part(at(count * layers) + 1);
    std::iota(part.begin(), part.end(), 0);
    const auto root = [&](std::int32_t i) {
      while (part[at(i)] != i) i = part[at(i)] = part[at(part[at(i)])];
      return i;
    };
    const auto slot = [&](std::int32_t layer, std::int32_t cell) {
      return layer < 0 || layer >= layers || cell < 0 ? count * layers : layer * count + cell;
    };
    const auto join = [&](std::int32_t a, std::int32_t b) { part[at(root(a))] = root(b); };
    for (std::int32_t level = 0; level <= layers; ++level) {
      for (std::int32_t c = 0; c < count; ++c) {
        if (wanted_[at(level)][at(c)] == 0) join(slot(level - 1, c), slot(level, c));
      }
    }
    std::vector<std::size_t> place(sheets_.size(), 0);
    for (const GridEdge& e : cells_.grid.edges) {
      const std::size_t s = at(layers + 1 + e.line);
      for (std::int32_t layer = 0; layer < layers; ++layer) {
        if (wanted_[s][place[s]++] == 0) join(slot(layer, e.left), slot(layer, e.right));
      }
    }
    std::int32_t kinds = 0;
    for (const std::int32_t fill : cells_.fill) kinds = std::max(kinds, fill);
    const bool regions = kinds > 1 && chance(0.8);
    std::vector<char> seen(part.size(), 0);
    seen[at(root(count * layers))] = 1;
    for (std::int32_t layer = 0; layer < layers; ++layer) {
      for (std::int32_t c = 0; c < count; ++c) {
        char& done = seen[at(root(slot(layer, c)))];
        if (done != 0) continue;
        done = 1;
        const double z = 0.5 * (cells_.heights[at(layer)] + cells_.heights[at(layer + 1)]);
        const Point3 p = cells_.position(cells_.grid.middle(c), z);
        const std::int32_t fill = cells_.material(layer, c);
        if (fill == 0) {
          made_.plc.holes.push_back(p);
        } else if (regions) {
          made_.plc.regions.push_back({p, fill});
        }
      }
    }
  }

  void describe() {
    made_.description = std::to_string(made_.fold) + "-fold layers: " + cells_.description;
    made_.volume = cells_.volume();
    made_.pinches = pinches_of(cells_);
    made_.boundary = boundary_topology(cells_);
    if (!made_.pinches.edges.empty() || !made_.pinches.points.empty()) {
      made_.description += ", pinched";
    }
    if (!made_.plc.holes.empty()) made_.description += ", cavities";
    if (!made_.plain_surface) made_.description += ", divided";
    made_.acute = true;
    for (std::int32_t layer = 0; layer < cells_.layers(); ++layer) {
      for (std::size_t c = 0; c < cells_.grid.cells.size(); ++c) {
        const GridCell& cell = cells_.grid.cells[c];
        const bool central = cell.v < 0 || cell.u == 0;
        if (central && cells_.material(layer, static_cast<std::int32_t>(c)) != 0) {
          made_.axis_inside = true;
        }
      }
    }
  }

  void place() {
    const Placement put(random_);
    Plc& plc = made_.plc;
    for (Point3& p : plc.vertices) p = put(p);
    for (PlcFacet& f : plc.facets) {
      for (Point3& p : f.holes) p = put(p);
    }
    for (Point3& p : plc.holes) p = put(p);
    for (PlcRegion& r : plc.regions) r.point = put(r.point);
    for (auto& e : made_.pinches.edges) e = {put(e[0]), put(e[1])};
    for (Point3& p : made_.pinches.points) p = put(p);
    made_.volume *= put.scale * put.scale * put.scale;
    made_.axis_origin = put.origin;
    made_.axis_direction = put.direction;
    made_.diameter = box_diagonal(plc.vertices);
  }

  Random random_;
  const RandomLayersOptions& options_;
  RandomPlc made_;
  LayeredCells cells_;
  std::vector<Sheet> sheets_;
  std::vector<std::vector<char>> wanted_;  // per sheet and face
  std::map<Side, int> uses_;               // wanted faces at it
  std::vector<Facet> facets_;
};

}  // namespace

std::int32_t random_fold(Random& random, const RandomLayersOptions& options) {
  if (options.fold) return *options.fold;
  const double pick = random.uniform();
  const double most = pick < 0.15 ? 1 : pick < 0.85 ? 8 : options.tabs ? 12 : options.max_fold;
  return 1 + static_cast<std::int32_t>(random.uniform() * std::min<double>(most, options.max_fold));
}

RandomPlc make_random_layers(std::uint64_t seed, const RandomLayersOptions& options) {
  return PlcMaker(seed, options).run();
}

}  // namespace symcell::test
