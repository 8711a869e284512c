#include "tests/fuzz/generated_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include "core/base/index.hpp"
#include "core/geometry/axis_frame.hpp"

namespace symcell::fuzz {
namespace {

constexpr std::int32_t kOutside = 0;  // the cell round all others
constexpr std::array<double, 8> kSteps{1, 1, 0.5, 2, 0.25, 0.1, 1.5, 0.03};

struct Cell {
  std::int32_t value = 0;  // 0: void, else its region
  Point3 middle;           // a point inside
  double measure = 0;
};

struct Face {
  std::int32_t a = kOutside;  // cells
  std::int32_t b = kOutside;
  std::vector<std::int32_t> corners;  // a segment's two, or a polygon's
  std::int32_t plane = 0;             // solids: faces of one number lie in one plane
  bool wall = false;                  // part of the model whatever the cells are
};

struct Grid {
  std::vector<Point3> points;
  std::vector<Cell> cells{Cell{}};
  std::vector<Face> faces;
};

// One cell of a planar grid, and what it is a copy of under the rotations.
struct PlanarCell {
  std::vector<std::int32_t> corners;  // counter-clockwise
  std::int32_t orbit = 0;
};

struct PlanarGrid {
  std::vector<Point2> points;
  std::vector<PlanarCell> cells;
  std::int32_t fold = 1;
  std::int32_t orbits = 0;
  bool hole = false;  // the last orbit is void whatever the bytes say
  // Edges of one number lie on one line; absent: each on its own.
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> lines;

  void set_line(std::int32_t a, std::int32_t b, std::int32_t line) {
    lines[std::minmax(a, b)] = line;
  }
};

std::vector<double> steps(ByteSource& bytes, std::int32_t count) {
  std::vector<double> all;
  for (std::int32_t i = 0; i < count; ++i) all.push_back(kSteps[at(bytes.below(8))]);
  return all;
}

// Running sums of `steps` from `first`.
std::vector<double> sums(double first, const std::vector<double>& steps) {
  std::vector<double> all{first};
  for (const double step : steps) all.push_back(all.back() + step);
  return all;
}

// Rings about the centre, whose middle is a hole, one cell, or cut by spokes.
PlanarGrid polar_grid(ByteSource& bytes) {
  enum class Centre { kHole, kCell, kSpokes };
  PlanarGrid grid;
  grid.fold = 1 + bytes.below(8);
  const auto centre = static_cast<Centre>(bytes.below(3));
  const std::int32_t rings = 1 + bytes.below(3);
  const std::int32_t parts =
      std::max(1 + bytes.below(3), grid.fold >= 3 ? 1 : (grid.fold == 2 ? 2 : 3));
  const std::int32_t around = grid.fold * parts;
  const std::vector<double> widths = steps(bytes, rings + 1);
  const std::vector<double> radii = sums(widths.front(), {widths.begin() + 1, widths.end()});
  const std::vector<double> shares = sums(0, steps(bytes, parts));
  const double sector = 2 * std::numbers::pi / grid.fold;
  std::vector<double> angles;
  for (std::int32_t i = 0; i < parts; ++i) {
    // Where corners are few, none of the parts may reach half way round.
    const double share =
        around < 5 ? static_cast<double>(i) / parts : shares[at(i)] / shares.back();
    angles.push_back(share * sector);
  }
  const std::uint8_t twist = bytes.byte();
  for (std::int32_t r = 0; r <= rings; ++r) {
    const double turn = (twist >> r & 1) != 0 ? 0.2 * sector / parts : 0;
    for (std::int32_t i = 0; i < around; ++i) {
      const double angle = sector * (i / parts) + angles[at(i % parts)] + turn;
      grid.points.push_back({radii[at(r)] * std::cos(angle), radii[at(r)] * std::sin(angle)});
    }
  }
  const auto point = [&](std::int32_t ring, std::int32_t i) { return ring * around + i % around; };
  for (std::int32_t r = 0; r < rings; ++r) {
    for (std::int32_t i = 0; i < around; ++i) {
      grid.cells.push_back({{point(r, i), point(r + 1, i), point(r + 1, i + 1), point(r, i + 1)},
                            r * parts + i % parts});
      if ((twist & 15) == 0) grid.set_line(point(r, i), point(r + 1, i), i);
    }
  }
  grid.orbits = rings * parts;
  if (centre != Centre::kSpokes) {
    grid.hole = centre == Centre::kHole;
    PlanarCell disc{{}, grid.orbits++};
    for (std::int32_t i = 0; i < around; ++i) disc.corners.push_back(point(0, i));
    grid.cells.push_back(std::move(disc));
  } else {
    const auto middle = static_cast<std::int32_t>(grid.points.size());
    grid.points.push_back({0, 0});
    for (std::int32_t i = 0; i < around; ++i) {
      grid.cells.push_back({{middle, point(0, i), point(0, i + 1)}, grid.orbits + i % parts});
      if ((twist & 15) == 0) grid.set_line(middle, point(0, i), i);
    }
    grid.orbits += parts;
  }
  return grid;
}

// Squares about the centre; the folds of a square lattice.
PlanarGrid square_grid(ByteSource& bytes) {
  PlanarGrid grid;
  grid.fold = std::array{1, 2, 4}[at(bytes.below(3))];
  const std::int32_t columns = 2 + bytes.below(5);
  const std::int32_t rows = grid.fold == 4 ? columns : 1 + bytes.below(5);
  const auto lines = [&](std::int32_t count) {
    std::vector<double> all = steps(bytes, count);
    if (grid.fold > 1) {
      for (std::int32_t i = 0; i < count / 2; ++i) all[at(count - 1 - i)] = all[at(i)];
    }
    all = sums(0, all);
    // Mirrored exactly.
    std::vector<double> centred;
    for (std::size_t i = 0; i < all.size(); ++i) {
      centred.push_back(0.5 * (all[i] - all[all.size() - 1 - i]));
    }
    if (grid.fold == 1) return all;
    return centred;
  };
  const std::vector<double> x = lines(columns);
  const std::vector<double> y = grid.fold == 4 ? x : lines(rows);
  const auto point = [&](std::int32_t i, std::int32_t j) { return j * (columns + 1) + i; };
  for (std::int32_t j = 0; j <= rows; ++j) {
    for (std::int32_t i = 0; i <= columns; ++i) {
      grid.points.push_back({x[at(i)], y[at(j)]});
      if (i > 0) grid.set_line(point(i - 1, j), point(i, j), j);
      if (j > 0) grid.set_line(point(i, j - 1), point(i, j), 100 + i);
    }
  }
  std::map<std::int32_t, std::int32_t> orbits;
  for (std::int32_t j = 0; j < rows; ++j) {
    for (std::int32_t i = 0; i < columns; ++i) {
      std::int32_t first = j * columns + i, u = i, v = j;
      for (std::int32_t k = 1; k < grid.fold; ++k) {
        if (grid.fold == 2) {
          std::tie(u, v) = std::pair(columns - 1 - u, rows - 1 - v);
        } else {
          std::tie(u, v) = std::pair(columns - 1 - v, u);
        }
        first = std::min(first, v * columns + u);
      }
      const auto [orbit, added] =
          orbits.try_emplace(first, static_cast<std::int32_t>(orbits.size()));
      grid.cells.push_back(
          {{point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)}, orbit->second});
    }
  }
  grid.orbits = static_cast<std::int32_t>(orbits.size());
  return grid;
}

double area(const PlanarGrid& grid, const PlanarCell& cell) {
  double twice = 0;
  for (std::size_t i = 0; i < cell.corners.size(); ++i) {
    twice += cross(grid.points[at(cell.corners[i])],
                   grid.points[at(cell.corners[(i + 1) % cell.corners.size()])]);
  }
  return 0.5 * twice;
}

Point2 middle(const PlanarGrid& grid, const PlanarCell& cell) {
  Point2 sum{};
  for (const std::int32_t corner : cell.corners) sum = sum + grid.points[at(corner)];
  return 1.0 / static_cast<double>(cell.corners.size()) * sum;
}

// What a byte says of a cell: its region, and walls on its faces.
struct CellByte {
  std::int32_t value = 1;
  bool side_wall = false;  // on a side between it and another cell
  bool top_wall = false;
};

CellByte cell_byte(std::uint8_t byte) {
  constexpr std::array<std::int32_t, 4> kValues{1, 1, 0, 2};
  return {kValues[byte & 3], (byte >> 2 & 7) == 7, (byte >> 5 & 7) == 7};
}

// The cells of one orbit have one byte; walls follow the orbits of both of a side's cells.
std::vector<CellByte> cell_bytes(ByteSource& bytes, const PlanarGrid& plan) {
  std::vector<CellByte> all;
  for (std::int32_t i = plan.hole ? 1 : 0; i < plan.orbits; ++i) {
    all.push_back(cell_byte(bytes.byte()));
  }
  if (plan.hole) all.push_back({0, false, false});
  return all;
}

struct Side {
  std::array<std::int32_t, 2> cells{-1, -1};  // to the left of a -> b, to the right
  std::int32_t a = 0, b = 0;
};

std::vector<Side> sides_of(const PlanarGrid& grid) {
  std::map<std::pair<std::int32_t, std::int32_t>, Side> sides;
  for (std::size_t c = 0; c < grid.cells.size(); ++c) {
    const auto& corners = grid.cells[c].corners;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const std::int32_t a = corners[i], b = corners[(i + 1) % corners.size()];
      Side& side = sides[std::minmax(a, b)];
      if (side.cells[0] < 0) side.a = a, side.b = b;
      (side.cells[0] < 0 ? side.cells[0] : side.cells[1]) = static_cast<std::int32_t>(c);
    }
  }
  std::vector<Side> all;
  for (const auto& [key, side] : sides) all.push_back(side);
  return all;
}

bool has_wall(const PlanarGrid& grid, const Side& side, const std::vector<CellByte>& what) {
  return std::ranges::any_of(side.cells, [&](std::int32_t c) {
    return c >= 0 && what[at(grid.cells[at(c)].orbit)].side_wall;
  });
}

Grid planar_model_grid(const PlanarGrid& plan, const std::vector<CellByte>& what) {
  Grid grid;
  for (const Point2 p : plan.points) grid.points.push_back({p.x, p.y, 0});
  for (const PlanarCell& cell : plan.cells) {
    const Point2 m = middle(plan, cell);
    grid.cells.push_back({what[at(cell.orbit)].value, {m.x, m.y, 0}, area(plan, cell)});
  }
  for (const Side& side : sides_of(plan)) {
    grid.faces.push_back(
        {side.cells[0] + 1, side.cells[1] + 1, {side.a, side.b}, 0, has_wall(plan, side, what)});
  }
  return grid;
}

// `what`: per layer, per orbit of the plan.
Grid layered_grid(const PlanarGrid& plan,
                  const std::vector<double>& heights,
                  const std::vector<std::vector<CellByte>>& what) {
  Grid grid;
  const auto level = static_cast<std::int32_t>(plan.points.size());
  const auto plan_cells = static_cast<std::int32_t>(plan.cells.size());
  const auto layers = static_cast<std::int32_t>(what.size());
  for (const double z : heights) {
    for (const Point2 p : plan.points) grid.points.push_back({p.x, p.y, z});
  }
  for (std::int32_t l = 0; l < layers; ++l) {
    const double low = heights[at(l)], high = heights[at(l + 1)];
    for (const PlanarCell& cell : plan.cells) {
      const Point2 m = middle(plan, cell);
      grid.cells.push_back({what[at(l)][at(cell.orbit)].value,
                            {m.x, m.y, 0.5 * (low + high)},
                            area(plan, cell) * (high - low)});
    }
  }
  const auto cell_at = [&](std::int32_t layer, std::int32_t c) {
    return c < 0 || layer < 0 || layer >= layers ? kOutside : 1 + layer * plan_cells + c;
  };
  for (std::int32_t l = 0; l <= layers; ++l) {
    for (std::int32_t c = 0; c < plan_cells; ++c) {
      Face face{cell_at(l, c), cell_at(l - 1, c), plan.cells[at(c)].corners, l, false};
      for (std::int32_t& corner : face.corners) corner += l * level;
      face.wall = l > 0 && what[at(l - 1)][at(plan.cells[at(c)].orbit)].top_wall;
      grid.faces.push_back(std::move(face));
    }
  }
  std::int32_t plane = 1000;
  for (const Side& side : sides_of(plan)) {
    const auto line = plan.lines.find(std::minmax(side.a, side.b));
    const std::int32_t own = line == plan.lines.end() ? plane++ : 100 + line->second;
    for (std::int32_t l = 0; l < layers; ++l) {
      const std::int32_t a = side.a + l * level, b = side.b + l * level;
      grid.faces.push_back({cell_at(l, side.cells[0]),
                            cell_at(l, side.cells[1]),
                            {a, b, b + level, a + level},
                            own,
                            has_wall(plan, side, what[at(l)])});
    }
  }
  return grid;
}

// Components of the cells: over faces that are not part of the model.
class Components {
 public:
  Components(const Grid& grid, const std::vector<std::uint8_t>& in_model)
      : parent_(grid.cells.size()) {
    std::iota(parent_.begin(), parent_.end(), 0);
    for (std::size_t f = 0; f < grid.faces.size(); ++f) {
      if (in_model[f] == 0) parent_[at(find(grid.faces[f].a))] = find(grid.faces[f].b);
    }
  }
  std::int32_t find(std::int32_t c) {
    while (parent_[at(c)] != c) c = parent_[at(c)] = parent_[at(parent_[at(c)])];
    return c;
  }

 private:
  std::vector<std::int32_t> parent_;
};

// Whether each face is part of the model: between unlike cells, or a wall. Walls in the void that
// hang on nothing are left out: they would be a model of their own.
std::vector<std::uint8_t> faces_of_model(const Grid& grid, bool walls_in_void) {
  std::vector<std::uint8_t> in_model;
  for (const Face& face : grid.faces) {
    const std::int32_t a = grid.cells[at(face.a)].value, b = grid.cells[at(face.b)].value;
    const bool wall = face.wall && (walls_in_void || a != 0 || b != 0);
    in_model.push_back(a != b || wall ? 1 : 0);
  }
  return in_model;
}

struct Seeds {
  std::vector<Point3> holes;
  std::vector<std::pair<Point3, std::int32_t>> regions;  // with the region
  double measure = 0;
};

Seeds seeds_of(const Grid& grid, const std::vector<std::uint8_t>& in_model) {
  Seeds seeds;
  Components components(grid, in_model);
  std::vector<std::uint8_t> seen(grid.cells.size(), 0);
  seen[at(components.find(kOutside))] = 1;
  for (std::size_t c = 1; c < grid.cells.size(); ++c) {
    const Cell& cell = grid.cells[c];
    if (cell.value != 0) seeds.measure += cell.measure;
    const std::int32_t component = components.find(static_cast<std::int32_t>(c));
    if (std::exchange(seen[at(component)], 1) != 0) continue;
    if (cell.value == 0) {
      seeds.holes.push_back(cell.middle);
    } else {
      seeds.regions.emplace_back(cell.middle, cell.value);
    }
  }
  return seeds;
}

// The outlines of coplanar faces: what is on one side of them is in the set.
class Outlines {
 public:
  explicit Outlines(const std::vector<const Face*>& faces) {
    for (const Face* face : faces) {
      const std::size_t n = face->corners.size();
      for (std::size_t i = 0; i < n; ++i) add(face->corners[i], face->corners[(i + 1) % n]);
    }
  }
  // Closed polygons that use every side of the set's rim once.
  std::vector<std::vector<std::int32_t>> polygons() {
    std::vector<std::vector<std::int32_t>> all;
    while (!next_.empty()) {
      std::vector<std::int32_t> loop{next_.begin()->first};
      while (true) {
        const auto step = next_.find(loop.back());
        const std::int32_t to = step->second;
        next_.erase(step);
        // A loop that comes by a corner again is closed there.
        const auto met = std::ranges::find(loop, to);
        if (met == loop.end()) {
          loop.push_back(to);
          continue;
        }
        all.emplace_back(met, loop.end());
        loop.erase(met + 1, loop.end());
        if (loop.size() == 1) break;
      }
    }
    return all;
  }

 private:
  void add(std::int32_t a, std::int32_t b) {
    // Sides that two faces share cancel, whichever way round the faces are.
    for (const bool turned : {false, true}) {
      const std::int32_t from = turned ? b : a, to = turned ? a : b;
      const auto [begin, end] = next_.equal_range(from);
      const auto same = std::find_if(begin, end, [to](const auto& e) { return e.second == to; });
      if (same == end) continue;
      next_.erase(same);
      return;
    }
    next_.emplace(a, b);
  }

  std::multimap<std::int32_t, std::int32_t> next_;
};

// Faces of one plane that hang together by sides become one facet.
class FacetMaker {
 public:
  FacetMaker(const Grid& grid, const std::vector<std::uint8_t>& in_model, Plc& plc)
      : grid_(grid), in_model_(in_model), plc_(plc) {}

  template <class Visit>
  static void for_each_side(const Face& face, const Visit& visit) {
    const std::vector<std::int32_t>& c = face.corners;
    for (std::size_t i = 0; i < c.size(); ++i) visit(std::minmax(c[i], c[(i + 1) % c.size()]));
  }

  void run(bool join, bool keep_sides, bool markers) {
    std::map<std::int32_t, std::vector<const Face*>> planes;
    for (std::size_t f = 0; f < grid_.faces.size(); ++f) {
      const Face& face = grid_.faces[f];
      if (in_model_[f] == 0) continue;
      for_each_side(face, [&](const auto& side) { ++uses_[side]; });
      if (join) {
        planes[face.plane].push_back(&face);
      } else {
        plc_.facets.push_back({{face.corners}, {}, markers ? marker(face.plane) : 0});
      }
    }
    for (const auto& [plane, faces] : planes) join_plane(plane, faces, keep_sides, markers);
  }

 private:
  // Planes across the axis have their own; those along it are turned into each other.
  static std::int32_t marker(std::int32_t plane) { return plane < 100 ? 1 + plane : 100; }

  void join_plane(std::int32_t plane,
                  const std::vector<const Face*>& faces,
                  bool keep_sides,
                  bool markers) {
    PlcFacet facet{Outlines(faces).polygons(), {}, markers ? marker(plane) : 0};
    std::map<std::pair<std::int32_t, std::int32_t>, int> sides;
    for (const Face* face : faces) {
      for_each_side(*face, [&](const auto& side) { ++sides[side]; });
    }
    for (const auto& [side, uses] : sides) {
      // Facets may not cross where they have no segment.
      const bool crossed = uses == 2 && uses_.at(side) == 4;
      if (uses == 2 && (keep_sides || crossed)) facet.polygons.push_back({side.first, side.second});
    }
    find_holes(plane, facet);
    plc_.facets.push_back(std::move(facet));
  }

  // The plane's faces that are not part of the model and closed off from its rim.
  void find_holes(std::int32_t plane, PlcFacet& facet) {
    std::map<std::pair<std::int32_t, std::int32_t>, std::vector<std::size_t>> at_side;
    std::vector<std::size_t> todo;
    std::vector<std::uint8_t> seen(grid_.faces.size(), 1);
    for (std::size_t f = 0; f < grid_.faces.size(); ++f) {
      const Face& face = grid_.faces[f];
      if (face.plane != plane) continue;
      seen[f] = in_model_[f];
      for (std::size_t i = 0; i < face.corners.size(); ++i) {
        at_side[std::minmax(face.corners[i], face.corners[(i + 1) % face.corners.size()])]
            .push_back(f);
      }
    }
    for (const auto& [side, faces] : at_side) {
      if (faces.size() == 1) flood(faces.front(), seen, at_side);
    }
    for (std::size_t f = 0; f < seen.size(); ++f) {
      if (seen[f] != 0) continue;
      Point3 sum{};
      for (const std::int32_t corner : grid_.faces[f].corners) sum = sum + grid_.points[at(corner)];
      facet.holes.push_back(1.0 / static_cast<double>(grid_.faces[f].corners.size()) * sum);
      flood(f, seen, at_side);
    }
  }

  void flood(
      std::size_t first,
      std::vector<std::uint8_t>& seen,
      const std::map<std::pair<std::int32_t, std::int32_t>, std::vector<std::size_t>>& at_side) {
    std::vector<std::size_t> todo{first};
    while (!todo.empty()) {
      const std::size_t f = todo.back();
      todo.pop_back();
      if (std::exchange(seen[f], 1) != 0) continue;
      const std::vector<std::int32_t>& corners = grid_.faces[f].corners;
      for (std::size_t i = 0; i < corners.size(); ++i) {
        const auto& others = at_side.at(std::minmax(corners[i], corners[(i + 1) % corners.size()]));
        todo.insert(todo.end(), others.begin(), others.end());
      }
    }
  }

  const Grid& grid_;
  const std::vector<std::uint8_t>& in_model_;
  std::map<std::pair<std::int32_t, std::int32_t>, int> uses_;  // of the sides by faces of the model
  Plc& plc_;
};

// Vertices that no part of the model uses are left out.
template <class ForEachIndex, class Vertices>
void drop_unused(ForEachIndex for_each_index, Vertices& vertices) {
  std::vector<std::int32_t> index(vertices.size(), -1);
  Vertices used;
  for_each_index([&](std::int32_t& i) {
    if (index[at(i)] < 0) {
      index[at(i)] = static_cast<std::int32_t>(used.size());
      used.push_back(vertices[at(i)]);
    }
    i = index[at(i)];
  });
  vertices = std::move(used);
}

// What models of both kinds have; where a fold is given it is still to be set.
MeshOptions options_from(std::uint8_t flags) {
  MeshOptions options;
  if ((flags & 1) != 0) options.fold = 1;
  if ((flags & 2) != 0) options.order = 2;
  if ((flags & 4) != 0) options.ignore_markers = true;
  if ((flags & 24) == 24) options.plain = true;
  if ((flags & 96) == 96) options.delaunay = true;
  if ((flags & 128) != 0) options.seed = flags;
  return options;
}

}  // namespace

GeneratedModel<Pslg> generate_planar(ByteSource& bytes) {
  GeneratedModel<Pslg> made;
  const std::uint8_t shape = bytes.byte();
  const std::uint8_t bounds = bytes.byte();
  const std::uint8_t flags = bytes.byte();
  MeshOptions options = options_from(bytes.byte());
  const PlanarGrid plan = (shape & 1) != 0 ? square_grid(bytes) : polar_grid(bytes);
  if (options.fold) options.fold = plan.fold;
  const std::vector<CellByte> what = cell_bytes(bytes, plan);
  const Grid grid = planar_model_grid(plan, what);
  const std::vector<std::uint8_t> in_model = faces_of_model(grid, (flags & 1) != 0);
  const Seeds seeds = seeds_of(grid, in_model);

  Pslg& pslg = made.geometry;
  const double turn = (flags & 2) != 0 ? 0.1 * (flags >> 4) : 0;
  const Point2 offset = (flags & 4) != 0 ? Point2{10, -3} : Point2{};
  const auto placed = [&](Point3 p) {
    return Point2{std::cos(turn) * p.x - std::sin(turn) * p.y,
                  std::sin(turn) * p.x + std::cos(turn) * p.y} +
           offset;
  };
  for (const Point3 p : grid.points) pslg.vertices.push_back(placed(p));
  for (std::size_t f = 0; f < grid.faces.size(); ++f) {
    if (in_model[f] == 0) continue;
    const auto& corners = grid.faces[f].corners;
    pslg.segments.push_back({corners[0], corners[1], 0});
  }
  drop_unused(
      [&](const auto& use) {
        for (PslgSegment& s : pslg.segments) use(s.a), use(s.b);
      },
      pslg.vertices);
  for (const Point3 p : seeds.holes) pslg.holes.push_back(placed(p));
  if ((flags & 8) != 0) {
    for (const auto& [p, region] : seeds.regions) {
      pslg.regions.push_back({placed(p), region, kInfinity});
    }
  }
  made.measure = seeds.measure;
  constexpr std::array<double, 8> kAngles{20, 30, 0, 25, 33, 28, 20, 35};
  options.min_angle_deg = kAngles[bounds & 7];
  if (options.plain) options.min_angle_deg = std::min(options.min_angle_deg, 25.0);
  const double element = seeds.measure / (50.0 * plan.fold);
  if ((bounds >> 3 & 3) == 3) options.max_area = element;
  if ((bounds >> 5 & 3) == 3) options.max_edge = 2 * std::sqrt(element);
  made.options = options;
  return made;
}

GeneratedModel<Plc> generate_solid(ByteSource& bytes) {
  GeneratedModel<Plc> made;
  const std::uint8_t shape = bytes.byte();
  const std::uint8_t bounds = bytes.byte();
  const std::uint8_t flags = bytes.byte();
  MeshOptions options = options_from(bytes.byte());
  const std::int32_t layers = 1 + bytes.below(3);
  const std::vector<double> heights = sums(0, steps(bytes, layers));
  const PlanarGrid plan = (shape & 1) != 0 ? square_grid(bytes) : polar_grid(bytes);
  if (options.fold) options.fold = plan.fold;
  std::vector<std::vector<CellByte>> what;
  for (std::int32_t l = 0; l < layers; ++l) what.push_back(cell_bytes(bytes, plan));
  const Grid grid = layered_grid(plan, heights, what);
  const std::vector<std::uint8_t> in_model = faces_of_model(grid, (flags & 1) != 0);
  const Seeds seeds = seeds_of(grid, in_model);

  Plc& plc = made.geometry;
  AxisFrame frame;
  if ((flags & 2) != 0) frame = AxisFrame::of_axis({1, 2, 3}, {1, -2, 0.5});
  const auto placed = [&](Point3 p) { return frame.to_model(p); };
  plc.vertices = grid.points;
  FacetMaker(grid, in_model, plc).run((flags & 4) != 0, (flags & 8) != 0, (flags & 16) != 0);
  drop_unused(
      [&](const auto& use) {
        for (PlcFacet& facet : plc.facets) {
          for (auto& polygon : facet.polygons) std::ranges::for_each(polygon, use);
        }
      },
      plc.vertices);
  for (Point3& p : plc.vertices) p = placed(p);
  for (PlcFacet& facet : plc.facets) {
    for (Point3& p : facet.holes) p = placed(p);
  }
  for (const Point3 p : seeds.holes) plc.holes.push_back(placed(p));
  if ((flags & 32) != 0) {
    for (const auto& [p, region] : seeds.regions) {
      plc.regions.push_back({placed(p), region, kInfinity});
    }
  }
  made.measure = seeds.measure;
  constexpr std::array<double, 4> kRatios{1.414, 2, 1.2, 4};
  options.radius_edge = kRatios[bounds & 3];
  const double element = seeds.measure / (50.0 * plan.fold);
  if ((bounds >> 2 & 3) == 3) options.max_volume = element;
  if ((bounds >> 4 & 3) == 3) options.max_edge = 2 * std::cbrt(element);
  made.options = options;
  return made;
}

}  // namespace symcell::fuzz
