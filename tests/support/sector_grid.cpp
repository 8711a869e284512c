#include "tests/support/sector_grid.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "core/base/index.hpp"

namespace symcell::test {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kThin = 0.12;         // of an ordinary width
constexpr double kUneven = 0.12;       // of a width: how far points are moved
constexpr double kWidestColumn = 100;  // degrees, seen from the centre
constexpr double kWidestUneven = 50;   // likewise, where points are moved

// Collects points, cells and lines, and finds edges and orbits.
class GridBuilder {
 public:
  explicit GridBuilder(std::int32_t fold) { grid_.fold = fold; }

  SectorGrid& grid() { return grid_; }
  std::int32_t point(Point2 p) {
    grid_.points.push_back(p);
    turned_.push_back(static_cast<std::int32_t>(turned_.size()));
    return turned_.back();
  }
  // The image of a point under the first rotation; without a word: itself.
  void turn(std::int32_t point, std::int32_t image) { turned_[at(point)] = image; }
  GridCell& cell(std::vector<std::int32_t> corners, std::int32_t u, std::int32_t v) {
    GridCell c;
    c.corners = std::move(corners);
    c.u = u;
    c.v = v;
    grid_.rings = std::max(grid_.rings, u + 1);
    grid_.columns = std::max(grid_.columns, v + 1);
    grid_.cells.push_back(std::move(c));
    return grid_.cells.back();
  }
  // The edge between two points lies on the line `key`.
  void line(std::int32_t a, std::int32_t b, std::int32_t key) { line_[std::minmax(a, b)] = key; }

  SectorGrid build() {
    find_edges();
    find_lines();
    find_orbits();
    return std::move(grid_);
  }

 private:
  using Pair = std::pair<std::int32_t, std::int32_t>;

  void find_edges() {
    for (std::size_t c = 0; c < grid_.cells.size(); ++c) {
      const auto& corners = grid_.cells[c].corners;
      for (std::size_t i = 0; i < corners.size(); ++i) {
        const std::int32_t a = corners[i], b = corners[(i + 1) % corners.size()];
        const auto [place, fresh] =
            edge_.try_emplace(std::minmax(a, b), static_cast<std::int32_t>(grid_.edges.size()));
        if (fresh) grid_.edges.push_back({a, b});
        GridEdge& e = grid_.edges[at(place->second)];
        (e.a == a ? e.left : e.right) = static_cast<std::int32_t>(c);
      }
    }
  }

  void find_lines() {
    std::map<std::int32_t, std::int32_t> number;  // per key
    std::map<std::int32_t, Point2> direction;     // per line
    for (GridEdge& e : grid_.edges) {
      const auto told = line_.find(std::minmax(e.a, e.b));
      if (told == line_.end()) {
        e.line = grid_.lines++;
        continue;
      }
      const auto [place, fresh] = number.try_emplace(told->second, grid_.lines);
      if (fresh) ++grid_.lines;
      e.line = place->second;
      const Point2 along = grid_.points[at(e.b)] - grid_.points[at(e.a)];
      const auto first = direction.try_emplace(e.line, along).first;
      if (dot(first->second, along) > 0) continue;
      std::swap(e.a, e.b);
      std::swap(e.left, e.right);
    }
    grid_.edges_at.resize(grid_.points.size());
    for (std::size_t e = 0; e < grid_.edges.size(); ++e) {
      grid_.edges_at[at(grid_.edges[e].a)].push_back(static_cast<std::int32_t>(e));
      grid_.edges_at[at(grid_.edges[e].b)].push_back(static_cast<std::int32_t>(e));
    }
  }

  void find_orbits() {
    std::map<std::vector<std::int32_t>, std::int32_t> points, edges, cells;
    const auto orbit = [&](auto& orbits, std::vector<std::int32_t> corners) {
      std::vector<std::int32_t> least;
      for (std::int32_t k = 0; k < grid_.fold; ++k) {
        for (std::int32_t& p : corners) p = turned_[at(p)];
        std::vector<std::int32_t> sorted = corners;
        std::sort(sorted.begin(), sorted.end());
        if (least.empty() || sorted < least) least = std::move(sorted);
      }
      return orbits.try_emplace(least, static_cast<std::int32_t>(orbits.size())).first->second;
    };
    for (std::size_t p = 0; p < grid_.points.size(); ++p) {
      grid_.point_orbit.push_back(orbit(points, {static_cast<std::int32_t>(p)}));
    }
    for (GridEdge& e : grid_.edges) e.orbit = orbit(edges, {e.a, e.b});
    for (GridCell& c : grid_.cells) c.orbit = orbit(cells, c.corners);
    grid_.cell_orbits = static_cast<std::int32_t>(cells.size());
  }

  SectorGrid grid_;
  std::vector<std::int32_t> turned_;
  std::map<Pair, std::int32_t> line_;
  std::map<Pair, std::int32_t> edge_;
};

class GridMaker {
 public:
  GridMaker(Random& random, std::int32_t fold, bool tabs)
      : random_(random), n_(fold), tabs_(tabs), builder_(fold) {}

  SectorGrid run() {
    const bool square = n_ == 1 || n_ == 2 || n_ == 4;
    if (square && (random_.uniform() < 0.5 || (tabs_ && n_ < 3))) {
      rectangles();
    } else {
      rings();
    }
    return builder_.build();
  }

 private:
  bool chance(double p) { return random_.uniform() < p; }
  double between(double low, double high) { return low + (high - low) * random_.uniform(); }
  std::int32_t any(std::int32_t low, std::int32_t high) {  // both may come
    return low +
           static_cast<std::int32_t>(random_.next() % static_cast<std::uint64_t>(high - low + 1));
  }

  // Places of the bounds of `count` steps from 0 to 1, a few of them thin.
  std::vector<double> steps(std::int32_t count, bool mirrored, bool thin) {
    std::vector<double> width;
    for (std::int32_t i = 0; i < count; ++i) {
      width.push_back(thin && count > 1 && chance(0.3) ? kThin : between(0.6, 1.4));
      if (mirrored && 2 * i >= count) width.back() = width[at(count - 1 - i)];
    }
    std::vector<double> places{0};
    for (const double w : width) places.push_back(places.back() + w);
    for (double& p : places) p /= places.back();
    return places;
  }

  // n = 1, 2 or 4.
  void rectangles() {
    const bool thin = chance(0.3);
    const std::int32_t least = tabs_ ? 4 : 2, most = tabs_ ? 6 : 5;
    const std::int32_t nx = any(least, most), ny = n_ == 4 ? nx : any(least, most);
    const std::vector<double> x = steps(nx, n_ > 1, thin);
    const std::vector<double> y = n_ == 4 ? x : steps(ny, n_ > 1, thin);
    const double height = n_ == 4 ? 1 : between(0.5, 1);
    const auto id = [&](std::int32_t i, std::int32_t j) { return i * (ny + 1) + j; };
    // Mirrored places have coordinates that are exactly opposite.
    const auto place = [](const std::vector<double>& p, std::int32_t i) {
      return p[at(i)] - p[p.size() - 1 - at(i)];
    };
    for (std::int32_t i = 0; i <= nx; ++i) {
      for (std::int32_t j = 0; j <= ny; ++j) {
        const Point2 p =
            n_ == 1 ? Point2{2 * x[at(i)] - 1, 2 * y[at(j)] - 1} : Point2{place(x, i), place(y, j)};
        builder_.point({0.7 * p.x, 0.7 * height * p.y});
      }
    }
    for (std::int32_t i = 0; i <= nx; ++i) {
      for (std::int32_t j = 0; j <= ny; ++j) {
        if (n_ == 2) builder_.turn(id(i, j), id(nx - i, ny - j));
        if (n_ == 4) builder_.turn(id(i, j), id(nx - j, i));
        if (i < nx) builder_.line(id(i, j), id(i + 1, j), j);
        if (j < ny) builder_.line(id(i, j), id(i, j + 1), ny + 1 + i);
        if (i < nx && j < ny) {
          const bool by_x = i == 0 || i + 1 == nx, by_y = j == 0 || j + 1 == ny;
          GridCell& c =
              builder_.cell({id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)}, i, j);
          c.outer = by_x || by_y;
          c.hollow = tabs_ && by_x && by_y;
        }
      }
    }
    builder_.grid().description = "rectangles " + std::to_string(nx) + "x" + std::to_string(ny);
  }

  // Rings about the axis; straight ones have all points of a sector on one side of a polygon.
  void rings() {
    const bool straight = n_ >= 3 && (chance(0.6) || tabs_);
    const bool thin = chance(0.3);
    const std::int32_t least = tabs_      ? 3
                               : straight ? 1
                               : n_ == 1  ? 5
                               : n_ == 2  ? 3
                               : n_ <= 4  ? 2
                                          : 1;
    columns_ = any(least, std::max(least, n_ > 12 ? 2 : n_ > 6 ? 3 : 4));
    const std::int32_t count = any(1, 3);
    std::vector<double> column = steps(columns_, false, thin);
    if (!straight && widest(column) * 360 / n_ > kWidestColumn) {
      for (std::int32_t j = 0; j <= columns_; ++j) column[at(j)] = 1.0 * j / columns_;
    }
    std::vector<double> radius = steps(count + 1, false, thin);
    radius.erase(radius.begin());
    for (double& r : radius) r = 0.1 + 0.9 * r;
    const bool uneven =
        !straight && !thin && widest(column) * 360 / n_ <= kWidestUneven && chance(0.5);
    for (std::int32_t i = 0; i <= count; ++i) add_ring(i, radius, column, straight, uneven);
    for (std::int32_t i = 0; i < count; ++i) join_rings(i, straight, uneven);
    const bool fan = columns_ * n_ <= 24 && chance(0.3);
    const bool bore = !fan && chance(0.5);
    fill_centre(fan, bore, uneven);
    const bool arms = straight && n_ <= 12 && (chance(0.6) || tabs_);
    if (arms) add_arms(count, column, thin);
    std::string& text = builder_.grid().description;
    text = std::to_string(count) +
           (straight ? " straight"
            : uneven ? " uneven"
                     : "") +
           " rings of " + std::to_string(columns_) +
           (fan    ? ", fan"
            : bore ? ", bore"
                   : "") +
           (arms ? ", arms" : "") + (thin ? ", thin" : "");
  }

  static double widest(const std::vector<double>& column) {
    double most = 0;
    for (std::size_t j = 1; j < column.size(); ++j)
      most = std::max(most, column[j] - column[j - 1]);
    return most;
  }

  // Point of ring i, column j (up to columns_: the next sector's first), sector s.
  [[nodiscard]] std::int32_t id(std::int32_t i, std::int32_t j, std::int32_t s) const {
    if (j == columns_) return id(i, 0, (s + 1) % n_);
    return (i * columns_ + j) * n_ + s;
  }
  [[nodiscard]] Point2 turned(Point2 p, std::int32_t s) const {
    const double c = std::cos(kTurn * s / n_), d = std::sin(kTurn * s / n_);
    return {c * p.x - d * p.y, d * p.x + c * p.y};
  }

  void add_ring(std::int32_t i,
                const std::vector<double>& radius,
                const std::vector<double>& column,
                bool straight,
                bool uneven) {
    const double below = i > 0 ? radius[at(i)] - radius[at(i - 1)] : radius[at(i)];
    const double above = at(i + 1) < radius.size() ? radius[at(i + 1)] - radius[at(i)] : below;
    for (std::int32_t j = 0; j < columns_; ++j) {
      Point2 p;
      if (straight) {
        const Point2 from{radius[at(i)], 0}, to = turned(from, 1);
        p = from + column[at(j)] * (to - from);
      } else {
        const double r =
            radius[at(i)] + (uneven ? kUneven * std::min(below, above) * between(-1, 1) : 0);
        const double angle =
            kTurn * (column[at(j)] + (uneven ? kUneven * between(-1, 1) / columns_ : 0)) / n_;
        p = {r * std::cos(angle), r * std::sin(angle)};
      }
      for (std::int32_t s = 0; s < n_; ++s) {
        builder_.turn(builder_.point(turned(p, s)), id(i, j, (s + 1) % n_));
      }
    }
  }

  [[nodiscard]] std::int32_t key(std::int32_t kind, std::int32_t i, std::int32_t s) const {
    return (kind * 100 + i) * n_ + s;
  }

  // The cells between rings i and i + 1, and the lines of both.
  void join_rings(std::int32_t i, bool straight, bool uneven) {
    for (std::int32_t s = 0; s < n_; ++s) {
      for (std::int32_t j = 0; j < columns_; ++j) {
        builder_.cell({id(i, j, s), id(i + 1, j, s), id(i + 1, j + 1, s), id(i, j + 1, s)}, i + 1,
                      j);
        if (!uneven) builder_.line(id(i, j, s), id(i + 1, j, s), key(0, j, s));
        if (!straight) continue;
        builder_.line(id(i, j, s), id(i, j + 1, s), key(1, i, s));
        builder_.line(id(i + 1, j, s), id(i + 1, j + 1, s), key(1, i + 1, s));
      }
    }
  }

  void fill_centre(bool fan, bool bore, bool uneven) {
    std::vector<std::int32_t> rim;
    const std::int32_t centre = fan ? builder_.point({0, 0}) : -1;
    for (std::int32_t s = 0; s < n_; ++s) {
      for (std::int32_t j = 0; j < columns_; ++j) {
        rim.push_back(id(0, j, s));
        if (!fan) continue;
        builder_.cell({centre, id(0, j, s), id(0, j + 1, s)}, 0, j);
        if (!uneven) builder_.line(centre, id(0, j, s), key(0, j, s));
      }
    }
    if (!fan) builder_.cell(rim, 0, -1).hollow = bore;
  }

  // Grids of rectangles on the sides of the outermost ring.
  void add_arms(std::int32_t outermost, const std::vector<double>& column, bool thin) {
    builder_.grid().arms = true;
    const std::int32_t count = any(1, 3);
    const std::vector<double> reach = steps(count, false, thin);
    const double length = between(0.3, 2);
    const Point2 from{1, 0}, to = turned(from, 1);
    const Point2 along = to - from;
    const Point2 out = (1 / std::hypot(along.x, along.y)) * Point2{along.y, -along.x};
    // arm[x][j][s]; row 0 is the side itself.
    std::vector<std::vector<std::vector<std::int32_t>>> arm(at(count + 1));
    for (std::int32_t x = 0; x <= count; ++x) {
      arm[at(x)].resize(at(columns_ + 1));
      for (std::int32_t j = 0; j <= columns_; ++j) {
        auto& row = arm[at(x)][at(j)];
        for (std::int32_t s = 0; s < n_; ++s) {
          if (x == 0) {
            row.push_back(id(outermost, j, s));
            continue;
          }
          const Point2 p = from + column[at(j)] * along + (length * reach[at(x)]) * out;
          row.push_back(builder_.point(turned(p, s)));
        }
        for (std::int32_t s = 0; x > 0 && s < n_; ++s) {
          builder_.turn(row[at(s)], row[at((s + 1) % n_)]);
        }
      }
    }
    for (std::int32_t s = 0; s < n_; ++s) {
      for (std::int32_t x = 0; x < count; ++x) {
        for (std::int32_t j = 0; j <= columns_; ++j) {
          const std::int32_t low = arm[at(x)][at(j)][at(s)], high = arm[at(x + 1)][at(j)][at(s)];
          builder_.line(low, high, key(2, j, s));
          if (j == columns_) continue;
          const std::int32_t next = arm[at(x)][at(j + 1)][at(s)];
          const std::int32_t across = arm[at(x + 1)][at(j + 1)][at(s)];
          builder_.cell({low, high, across, next}, outermost + 1 + x, j).outer = true;
          builder_.line(high, across, key(1, outermost + 1 + x, s));
        }
      }
    }
  }

  Random& random_;
  std::int32_t n_;
  bool tabs_;
  std::int32_t columns_ = 0;
  GridBuilder builder_;
};

}  // namespace

Point2 SectorGrid::middle(std::int32_t cell) const {
  Point2 sum;
  for (const std::int32_t p : cells[at(cell)].corners) sum = sum + points[at(p)];
  return (1.0 / static_cast<double>(cells[at(cell)].corners.size())) * sum;
}

double SectorGrid::area(std::int32_t cell) const {
  const auto& corners = cells[at(cell)].corners;
  double doubled = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    doubled += cross(points[at(corners[i])], points[at(corners[(i + 1) % corners.size()])]);
  }
  return 0.5 * doubled;
}

std::int32_t SectorGrid::edge_between(std::int32_t a, std::int32_t b) const {
  for (const std::int32_t e : edges_at[at(a)]) {
    if (edges[at(e)].a == b || edges[at(e)].b == b) return e;
  }
  return -1;
}

SectorGrid make_sector_grid(Random& random, std::int32_t fold, bool tabs) {
  return GridMaker(random, fold, tabs).run();
}

}  // namespace symcell::test
