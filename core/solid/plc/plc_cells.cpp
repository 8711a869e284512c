#include "core/solid/plc/plc_cells.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/base/index.hpp"
#include "core/base/union_find.hpp"
#include "core/geometry/box_tree.hpp"
#include "core/geometry/indexed_surface.hpp"
#include "core/geometry/predicates.hpp"

namespace symcell::solid {
namespace {

// Turns the model so that no facet stands upright and no two vertices above each other but by rare
// accident: rays along z then meet few degenerate cases. An arbitrary rotation.
Point3 tilt(Point3 p) {
  // Cosines and sines by Pythagorean triples.
  constexpr double kA = 20.0 / 29, kB = 21.0 / 29;
  constexpr double kC = 12.0 / 37, kD = 35.0 / 37;
  const Point3 q{kA * p.x - kB * p.y, kB * p.x + kA * p.y, p.z};
  return {q.x, kC * q.y - kD * q.z, kD * q.y + kC * q.z};
}

// Side 2 t of triangle t is where its normal looks to, side 2 t + 1 the other.
class CellFinder {
 public:
  CellFinder(const PlcComplex& complex, ExecutionContext& context)
      : complex_(complex), context_(context) {
    centre_ = 0.5 * (complex.box_low + complex.box_high);
    // To a size near 1: sixth powers of the coordinates occur below.
    scale_ = std::exp2(-std::ilogb(complex.diameter));
    for (const Point3 p : complex.points) points_.push_back(placed(p));
    for (const ComplexFacet& facet : complex.facets) {
      const auto& t = facet.triangles.triangles;
      triangles_.insert(triangles_.end(), t.begin(), t.end());
    }
  }

  Result<PlcCells> run() {
    join_round_edges();
    SYMCELL_TRY(context_.check());
    measure_shells();
    build_tree();
    SYMCELL_TRY(unite_shells());
    number_cells();
    place_seeds();
    return std::move(result_);
  }

 private:
  [[nodiscard]] Point3 placed(Point3 p) const { return tilt(scale_ * (p - centre_)); }
  [[nodiscard]] Point3 corner(std::int32_t t, std::size_t i) const {
    return points_[at(triangles_[at(t)][i])];
  }

  void join_round_edges() {
    sides_ = std::make_unique<UnionFind>(2 * triangles_.size());
    const std::vector<EdgeUse> uses = sorted_edge_uses(triangles_);
    struct Spoke {
      double angle;
      std::int32_t triangle;
      bool forward;
    };
    std::vector<Spoke> spokes;
    for_each_edge(uses, [&](std::size_t begin, std::size_t end) {
      const Point3 a = points_[at(uses[begin].low)];
      const Point3 axis = points_[at(uses[begin].high)] - a;
      spokes.clear();
      Point3 u, v;
      for (std::size_t i = begin; i < end; ++i) {
        const auto& t = triangles_[at(uses[i].triangle)];
        const std::int32_t apex = t[0] + t[1] + t[2] - uses[i].low - uses[i].high;
        const Point3 d = points_[at(apex)] - a;
        const Point3 out = squared_length(axis) * d - dot(d, axis) * axis;
        if (i == begin) {
          u = out;
          v = cross(axis, out);
          // Equal scales for both coordinates.
          v = std::sqrt(squared_length(u) / squared_length(v)) * v;
        }
        const double angle = i == begin ? 0 : std::atan2(dot(out, v), dot(out, u));
        spokes.push_back({angle, uses[i].triangle, uses[i].forward});
      }
      std::sort(spokes.begin(), spokes.end(), [](const Spoke& s, const Spoke& t) {
        return std::pair(s.angle, s.triangle) < std::pair(t.angle, t.triangle);
      });
      // A triangle that runs along the axis looks towards growing angles.
      for (std::size_t i = 0; i < spokes.size(); ++i) {
        const Spoke& s = spokes[i];
        const Spoke& t = spokes[(i + 1) % spokes.size()];
        sides_->join(2 * s.triangle + (s.forward ? 0 : 1), 2 * t.triangle + (t.forward ? 1 : 0));
      }
      if (end - begin == 1) open_.push_back({uses[begin].low, uses[begin].high});
    });
  }

  // Twice what each shell encloses, times three: positive for the outer bound of a cell, negative
  // for what bounds it from inside.
  void measure_shells() {
    shell_volume_.assign(2 * triangles_.size(), 0);
    both_sides_.assign(2 * triangles_.size(), 1);
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      const auto i = static_cast<std::int32_t>(t);
      const double volume = dot(corner(i, 0), cross(corner(i, 1), corner(i, 2))) / 6;
      const std::int32_t front = sides_->root(2 * i), back = sides_->root(2 * i + 1);
      if (front == back) continue;
      shell_volume_[at(front)] -= volume;
      shell_volume_[at(back)] += volume;
      both_sides_[at(front)] = both_sides_[at(back)] = 0;
    }
  }
  [[nodiscard]] bool outer(std::int32_t shell) const {
    return both_sides_[at(shell)] == 0 && shell_volume_[at(shell)] > 0;
  }

  void build_tree() {
    std::vector<Box3> boxes;
    boxes.reserve(triangles_.size());
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      const auto i = static_cast<std::int32_t>(t);
      const Point3 a = corner(i, 0), b = corner(i, 1), c = corner(i, 2);
      boxes.push_back(
          {{std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y}), std::min({a.z, b.z, c.z})},
           {std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y}), std::max({a.z, b.z, c.z})}});
    }
    tree_ = std::make_unique<BoxTree>(boxes);
  }

  struct Upwards {
    bool clear = true;       // no triangle was met at its rim
    std::int32_t side = -1;  // the first met, -1: none
  };

  // The first side of a triangle straight above p, `except` apart.
  [[nodiscard]] Upwards look_up(Point3 p, std::int32_t except) const {
    Upwards result;
    double best = std::numeric_limits<double>::infinity();
    const Point2 q{p.x, p.y};
    const Box3 ray{p, {p.x, p.y, std::numeric_limits<double>::max()}};
    tree_->visit(ray, [&](std::int32_t t) {
      if (t == except) return;
      const Point3 a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
      const auto flat = [](Point3 r) { return Point2{r.x, r.y}; };
      const int ab = static_cast<int>(orientation(flat(a), flat(b), q));
      const int bc = static_cast<int>(orientation(flat(b), flat(c), q));
      const int ca = static_cast<int>(orientation(flat(c), flat(a), q));
      const int low = std::min({ab, bc, ca}), high = std::max({ab, bc, ca});
      if (low < 0 && high > 0) return;
      if (ab == 0 || bc == 0 || ca == 0) {
        result.clear = false;
        return;
      }
      const Point3 n = cross(b - a, c - a);
      const double height = a.z + (n.x * (a.x - p.x) + n.y * (a.y - p.y)) / n.z;
      if (height <= p.z || height >= best) return;
      best = height;
      result.side = 2 * t + (low > 0 ? 1 : 0);  // counter-clockwise from above: we see its back
    });
    return result;
  }

  // Joins shells that bound one cell. The sides that look up from the top of a shell are the ones
  // that see past it.
  Result<void> unite_shells() {
    cells_ = std::make_unique<UnionFind>(2 * triangles_.size() + 1);
    outside_ = static_cast<std::int32_t>(2 * triangles_.size());
    std::vector<std::pair<double, std::int32_t>> starts;  // (-height, side looking up)
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      const auto i = static_cast<std::int32_t>(t);
      const Point3 n = cross(corner(i, 1) - corner(i, 0), corner(i, 2) - corner(i, 0));
      const std::int32_t side = 2 * i + (n.z > 0 ? 0 : 1);
      const double top = std::max({corner(i, 0).z, corner(i, 1).z, corner(i, 2).z});
      if (!outer(sides_->root(side))) starts.emplace_back(-top, side);
    }
    std::sort(starts.begin(), starts.end());
    // Classes that have an outer bound or the outside; the others ask on. What was met leads
    // upwards, so that the tops of the shells are enough as a rule.
    std::vector<std::uint8_t> anchored(2 * triangles_.size() + 1, 0);
    anchored[at(outside_)] = 1;
    for (std::size_t s = 0; s < 2 * triangles_.size(); ++s) {
      const auto i = static_cast<std::int32_t>(s);
      if (sides_->root(i) == i && outer(i)) anchored[s] = 1;
    }
    std::size_t steps = 0;
    for (const auto& [height, side] : starts) {
      const std::int32_t shell = sides_->root(side);
      if (anchored[at(cells_->root(shell))] != 0) continue;
      if (++steps % 64 == 0) {
        SYMCELL_TRY(context_.check());
      }
      const std::int32_t met = meet_above(side);
      if (met < 0) continue;
      const std::uint8_t sure = anchored[at(cells_->root(met))];
      cells_->join(shell, met);
      anchored[at(cells_->root(shell))] = sure;
    }
    for (const auto& start : starts) {
      if (anchored[at(cells_->root(sides_->root(start.second)))] != 0) continue;
      return fail(ErrorCode::kInternal, "a shell of the model lies in no cell that could be found");
    }
    return {};
  }

  // Another shell, or the outside, that the side sees straight above; -1: none.
  [[nodiscard]] std::int32_t meet_above(std::int32_t side) const {
    const std::int32_t t = side / 2;
    // Near each corner in turn, then in the middle: whichever sees clear of rims.
    for (const auto& w : {std::array{0.8, 0.11, 0.09}, std::array{0.12, 0.79, 0.09},
                          std::array{0.1, 0.13, 0.77}, std::array{0.37, 0.29, 0.34}}) {
      const Point3 p = w[0] * corner(t, 0) + w[1] * corner(t, 1) + w[2] * corner(t, 2);
      const Upwards up = look_up(p, t);
      if (!up.clear) continue;
      const std::int32_t met = up.side < 0 ? outside_ : sides_->root(up.side);
      if (met != sides_->root(side)) return met;
    }
    return -1;
  }

  void number_cells() {
    std::vector<std::int32_t> number(2 * triangles_.size() + 1, -1);
    number[at(cells_->root(outside_))] = kOutside;
    result_.cells.emplace_back();
    const auto cell_of = [&](std::int32_t side) {
      std::int32_t& n = number[at(cells_->root(sides_->root(side)))];
      if (n < 0) {
        n = static_cast<std::int32_t>(result_.cells.size());
        result_.cells.emplace_back();
      }
      return n;
    };
    std::int32_t t = 0;
    for (const ComplexFacet& facet : complex_.facets) {
      auto& sides = result_.sides.emplace_back();
      for (std::size_t i = 0; i < facet.triangles.triangles.size(); ++i, ++t) {
        sides.push_back({cell_of(2 * t), cell_of(2 * t + 1)});
      }
    }
    cell_of_side_.resize(2 * triangles_.size());
    for (std::int32_t s = 0; at(s) < cell_of_side_.size(); ++s) {
      cell_of_side_[at(s)] = cell_of(s);
      if (sides_->root(s) == s && both_sides_[at(s)] == 0) {
        result_.cells[at(cell_of_side_[at(s)])].volume +=
            shell_volume_[at(s)] / scale_ / scale_ / scale_;
      }
    }
    result_.cells[kOutside].volume = 0;
    for (const ComplexFacet& facet : complex_.facets) result_.borders.push_back(borders_of(facet));
    for (const IndexPair& pair : open_) {
      const auto it = std::lower_bound(complex_.edges.begin(), complex_.edges.end(), pair,
                                       [](const ComplexEdge& e, const IndexPair& p) {
                                         return IndexPair{e.a, e.b} < p;
                                       });
      result_.open_edges.push_back(static_cast<std::int32_t>(it - complex_.edges.begin()));
    }
  }

  // Triangles are counter-clockwise: one that runs from a to b lies on its left.
  static std::vector<std::array<std::int32_t, 2>> borders_of(const ComplexFacet& facet) {
    const auto& segments = facet.graph.segments;
    std::vector<std::array<std::int32_t, 2>> result(segments.size(), {-1, -1});
    for (std::size_t t = 0; t < facet.triangles.triangles.size(); ++t) {
      const auto& v = facet.triangles.triangles[t];
      for (std::size_t i = 0; i < 3; ++i) {
        const std::int32_t a = v[i], b = v[(i + 1) % 3];
        const IndexPair pair{std::min(a, b), std::max(a, b)};
        const auto it = std::lower_bound(segments.begin(), segments.end(), pair);
        if (it == segments.end() || *it != pair) continue;
        result[static_cast<std::size_t>(it - segments.begin())][a < b ? 0 : 1] =
            static_cast<std::int32_t>(t);
      }
    }
    return result;
  }

  [[nodiscard]] std::int32_t cell_at(Point3 seed) const {
    const Point3 p = placed(seed);
    // A seed exactly below a rim is looked at from beside, by next to nothing.
    constexpr double kBeside = 1e-13;
    for (const double shift : {0.0, kBeside, -2 * kBeside}) {
      const double d = shift * scale_ * complex_.diameter;
      const Upwards up = look_up({p.x + d, p.y + 0.7 * d, p.z}, -1);
      if (up.clear) return up.side < 0 ? kOutside : cell_of_side_[at(up.side)];
    }
    return kOutside;
  }

  void place_seeds() {
    for (std::size_t i = 0; i < complex_.holes.size(); ++i) {
      const std::int32_t c = cell_at(complex_.holes[i]);
      result_.hole_cell.push_back(c);
      if (result_.cells[at(c)].hole < 0) {
        result_.cells[at(c)].hole = static_cast<std::int32_t>(i);
      }
    }
    for (std::size_t i = 0; i < complex_.regions.size(); ++i) {
      const std::int32_t c = cell_at(complex_.regions[i].point);
      result_.region_cell.push_back(c);
      if (result_.cells[at(c)].region < 0) {
        result_.cells[at(c)].region = static_cast<std::int32_t>(i);
      }
    }
    for (std::size_t c = 1; c < result_.cells.size(); ++c) {
      result_.cells[c].meshed = result_.cells[c].hole < 0;
      if (result_.cells[c].meshed) result_.volume += result_.cells[c].volume;
    }
  }

  const PlcComplex& complex_;
  ExecutionContext& context_;
  Point3 centre_;
  double scale_ = 1;            // a power of two
  std::vector<Point3> points_;  // tilted and scaled
  std::vector<Triangle> triangles_;
  std::unique_ptr<UnionFind> sides_;      // its roots name the shells
  std::vector<double> shell_volume_;      // at the roots
  std::vector<std::uint8_t> both_sides_;  // at the roots: the shell has both sides of all it has
  std::unique_ptr<UnionFind> cells_;      // over shells and the outside
  std::int32_t outside_ = 0;
  std::unique_ptr<BoxTree> tree_;
  std::vector<std::int32_t> cell_of_side_;
  std::vector<IndexPair> open_;
  PlcCells result_;
};

}  // namespace

Result<PlcCells> find_cells(const PlcComplex& complex, ExecutionContext& context) {
  return CellFinder(complex, context).run();
}

}  // namespace symcell::solid
