#include "tests/support/layered_facets.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "core/base/index.hpp"

namespace symcell::test {
namespace {

constexpr std::int64_t kMany = 1'000'000;

void find_neighbours(Sheet& sheet) {
  std::map<std::pair<std::int32_t, std::int32_t>, std::pair<std::int32_t, std::size_t>> first;
  for (std::size_t f = 0; f < sheet.size(); ++f) {
    auto& corners = sheet[f].corners;
    sheet[f].neighbours.assign(corners.size(), -1);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const std::int32_t a = corners[i], b = corners[(i + 1) % corners.size()];
      const auto [place, fresh] = first.try_emplace(std::minmax(a, b), f, i);
      if (fresh) continue;
      const auto [g, j] = place->second;
      sheet[f].neighbours[i] = g;
      sheet[at(g)].neighbours[j] = static_cast<std::int32_t>(f);
    }
  }
}

class OutlineMaker {
 public:
  OutlineMaker(const Sheet& sheet, const std::vector<char>& wanted) : sheet_(sheet) {
    group_.assign(sheet.size(), -1);
    for (std::size_t f = 0; f < sheet.size(); ++f) {
      if (wanted[f] == 0) group_[f] = -2;
    }
  }

  template <class Joins>
  std::vector<FacetOutline> run(const Joins& joins) {
    std::int32_t groups = 0;
    for (std::size_t seed = 0; seed < sheet_.size(); ++seed) {
      if (group_[seed] != -1) continue;
      flood(static_cast<std::int32_t>(seed), groups++, group_,
            [&](std::size_t f, std::size_t i, std::size_t g) {
              return group_[g] == -1 && joins(sheet_[f], i, sheet_[g]);
            });
    }
    std::vector<FacetOutline> result;
    for (std::int32_t g = 0; g < groups; ++g) result.push_back(outline(g));
    return result;
  }

 private:
  template <class Goes>
  void flood(std::int32_t seed,
             std::int32_t name,
             std::vector<std::int32_t>& names,
             const Goes& goes) {
    std::vector<std::int32_t> stack{seed};
    names[at(seed)] = name;
    while (!stack.empty()) {
      const std::size_t f = at(stack.back());
      stack.pop_back();
      for (std::size_t i = 0; i < sheet_[f].corners.size(); ++i) {
        const std::int32_t g = sheet_[f].neighbours[i];
        if (g < 0 || names[at(g)] == name || !goes(f, i, at(g))) continue;
        names[at(g)] = name;
        stack.push_back(g);
      }
    }
  }

  [[nodiscard]] bool bounds(std::size_t f, std::size_t i) const {
    const std::int32_t g = sheet_[f].neighbours[i];
    return g < 0 || group_[at(g)] != group_[f];
  }
  [[nodiscard]] std::size_t side_to(std::int32_t face, std::int32_t neighbour) const {
    const auto& all = sheet_[at(face)].neighbours;
    return static_cast<std::size_t>(std::find(all.begin(), all.end(), neighbour) - all.begin());
  }

  FacetOutline outline(std::int32_t group) {
    FacetOutline made;
    std::set<std::pair<std::size_t, std::size_t>> left;  // sides at the rim
    std::set<std::int32_t> inner, rim;
    for (std::size_t f = 0; f < sheet_.size(); ++f) {
      if (group_[f] != group) continue;
      made.face = static_cast<std::int32_t>(f);
      const auto& corners = sheet_[f].corners;
      for (std::size_t i = 0; i < corners.size(); ++i) {
        const std::int32_t a = corners[i], b = corners[(i + 1) % corners.size()];
        inner.insert(a);
        if (bounds(f, i)) {
          left.emplace(f, i);
          rim.insert({a, b});
        } else if (at(sheet_[f].neighbours[i]) > f) {
          made.seams.push_back({a, b});
        }
      }
    }
    for (const std::int32_t v : inner) {
      if (!rim.contains(v)) made.inner.push_back(v);
    }
    while (!left.empty()) made.loops.push_back(loop(left));
    find_holes(group, made);
    return made;
  }

  // From a side at the rim to the next, the same faces always on the left.
  std::vector<OutlineCorner> loop(std::set<std::pair<std::size_t, std::size_t>>& left) {
    std::vector<OutlineCorner> result;
    auto [f, i] = *left.begin();
    while (left.erase({f, i}) != 0) {
      const std::int64_t line = sheet_[f].lines[i];
      i = (i + 1) % sheet_[f].corners.size();
      const std::int32_t vertex = sheet_[f].corners[i];
      while (!bounds(f, i)) {
        const std::int32_t g = sheet_[f].neighbours[i];
        i = (side_to(g, static_cast<std::int32_t>(f)) + 1) % sheet_[at(g)].corners.size();
        f = at(g);
      }
      result.push_back({vertex, sheet_[f].lines[i] == line, line});
    }
    return result;
  }

  // What the group leaves out and encloses.
  void find_holes(std::int32_t group, FacetOutline& made) {
    std::vector<std::int32_t> part(sheet_.size(), -1);
    std::int32_t parts = 0;
    for (std::size_t seed = 0; seed < sheet_.size(); ++seed) {
      if (group_[seed] == group || part[seed] >= 0) continue;
      flood(static_cast<std::int32_t>(seed), parts++, part,
            [&](std::size_t, std::size_t, std::size_t g) { return group_[g] != group; });
    }
    std::vector<char> open(at(parts), 0);
    for (std::size_t f = 0; f < sheet_.size(); ++f) {
      for (const std::int32_t g : sheet_[f].neighbours) {
        if (g < 0 && part[f] >= 0) open[at(part[f])] = 1;
      }
    }
    for (std::size_t f = 0; f < sheet_.size(); ++f) {
      if (part[f] < 0 || open[at(part[f])] != 0) continue;
      open[at(part[f])] = 1;
      made.holes.push_back(sheet_[f].middle);
    }
  }

  const Sheet& sheet_;
  std::vector<std::int32_t> group_;  // -1: to come, -2: not wanted
};

std::int32_t kind_of(std::int32_t front, std::int32_t back, bool level) {
  if (front != 0 && back != 0) return 4;
  if (!level) return 3;
  return front != 0 ? 1 : 2;
}

}  // namespace

std::vector<Sheet> make_sheets(const LayeredCells& cells) {
  const SectorGrid& grid = cells.grid;
  const auto points = static_cast<std::int32_t>(grid.points.size());
  const std::int32_t layers = cells.layers();
  std::vector<Sheet> sheets(at(layers + 1 + grid.lines));
  for (std::int32_t level = 0; level <= layers; ++level) {
    for (std::size_t c = 0; c < grid.cells.size(); ++c) {
      const auto cell = static_cast<std::int32_t>(c);
      SheetFace face;
      const auto& corners = grid.cells[c].corners;
      for (std::size_t i = 0; i < corners.size(); ++i) {
        face.corners.push_back(level * points + corners[i]);
        const GridEdge& e =
            grid.edges[at(grid.edge_between(corners[i], corners[(i + 1) % corners.size()]))];
        face.lines.push_back(e.line);
        face.side_orbits.push_back(level * kMany + e.orbit);
      }
      face.front = cells.material(level, cell);
      face.back = cells.material(level - 1, cell);
      face.orbit = level * kMany + grid.cells[c].orbit;
      face.kind = kind_of(face.front, face.back, true);
      face.middle = cells.position(grid.middle(cell), cells.heights[at(level)]);
      sheets[at(level)].push_back(std::move(face));
    }
  }
  for (const GridEdge& e : grid.edges) {
    for (std::int32_t layer = 0; layer < layers; ++layer) {
      SheetFace face;
      const std::int32_t low = layer * points, high = low + points;
      face.corners = {low + e.a, low + e.b, high + e.b, high + e.a};
      face.lines = {-1, e.b, -1, e.a};
      const auto upright = [&](std::int32_t p) {
        return -1 - (layer * kMany + grid.point_orbit[at(p)]);
      };
      face.side_orbits = {layer * kMany + e.orbit, upright(e.b), (layer + 1) * kMany + e.orbit,
                          upright(e.a)};
      face.front = cells.material(layer, e.right);
      face.back = cells.material(layer, e.left);
      face.orbit = -1 - (layer * kMany + e.orbit);
      face.kind = kind_of(face.front, face.back, false);
      const double z = 0.5 * (cells.heights[at(layer)] + cells.heights[at(layer + 1)]);
      face.middle = cells.position(0.5 * (grid.points[at(e.a)] + grid.points[at(e.b)]), z);
      sheets[at(layers + 1 + e.line)].push_back(std::move(face));
    }
  }
  for (Sheet& sheet : sheets) find_neighbours(sheet);
  return sheets;
}

std::vector<FacetOutline> make_outlines(
    const Sheet& sheet,
    const std::vector<char>& wanted,
    const std::function<bool(const SheetFace&, std::size_t, const SheetFace&)>& joins) {
  return OutlineMaker(sheet, wanted).run(joins);
}

}  // namespace symcell::test
