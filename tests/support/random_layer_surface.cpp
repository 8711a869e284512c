#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/base/index.hpp"
#include "core/geometry/facet_triangulation.hpp"
#include "core/geometry/indexed_surface.hpp"
#include "tests/support/layered_facets.hpp"
#include "tests/support/placement.hpp"
#include "tests/support/random_layers.hpp"

namespace symcell::test {
namespace {

// Of the area of a pair of triangles: the least that a flip may leave to one of them.
constexpr double kLeastShare = 1e-3;

class SurfaceMaker {
 public:
  SurfaceMaker(std::uint64_t seed, const RandomLayersOptions& options)
      : random_(seed ^ 0x5027faceu) {
    made_.fold = random_fold(random_, options);
    LayeredOptions layered;
    layered.tabs = options.tabs;
    if (options.tabs) layered.layers = 5;
    layered.kinds = 1;
    cells_ = make_layered_cells(random_, made_.fold, layered);
  }

  RandomSurface run() {
    choose_outlines();
    const bool flipped = chance(0.7);
    for (const auto& [outline, sheet] : outlines_) add_facet(outline, *sheet, flipped);
    const bool soup = chance(0.3);
    write(soup);
    made_.flat = true;
    made_.boundary = boundary_topology(cells_);
    made_.description = std::to_string(made_.fold) +
                        "-fold layers as triangles: " + cells_.description + ", " +
                        std::to_string(triangles_.size()) + " triangles" + (soup ? " apart" : "");
    return std::move(made_);
  }

 private:
  bool chance(double p) { return random_.uniform() < p; }
  using Side = std::pair<std::int32_t, std::int32_t>;

  // Whether faces are one facet is decided by chance in every copy for itself.
  void choose_outlines() {
    constexpr double kMerges[] = {1, 1, 0.8, 0};
    const double merges = kMerges[random_.next() % 4];
    sheets_ = make_sheets(cells_);
    for (const Sheet& sheet : sheets_) {
      std::vector<char> wanted;
      for (const SheetFace& f : sheet) wanted.push_back(f.front != f.back ? 1 : 0);
      const auto joins = [&](const SheetFace& f, std::size_t, const SheetFace& g) {
        return f.front == g.front && chance(merges);
      };
      for (FacetOutline& o : make_outlines(sheet, wanted, joins)) outlines_.emplace_back(o, &sheet);
    }
    keep_.assign(cells_.grid.points.size() * cells_.heights.size(), 0);
    const double kept = chance(0.5) ? 0.3 : 1;
    for (char& k : keep_) k = chance(kept) ? 1 : 0;
    for (const auto& [outline, sheet] : outlines_) {
      std::map<std::int32_t, int> times;
      for (const auto& loop : outline.loops) {
        for (const OutlineCorner& c : loop) {
          if (!c.straight || ++times[c.vertex] > 1) keep_[at(c.vertex)] = 1;
        }
      }
    }
  }

  [[nodiscard]] Point3 position(std::int32_t vertex) const {
    const auto points = static_cast<std::int32_t>(cells_.grid.points.size());
    return cells_.position(vertex % points, vertex / points);
  }

  void add_facet(const FacetOutline& outline, const Sheet& sheet, bool flipped) {
    FacetGraph graph;
    std::vector<Point3> points;
    std::vector<std::int32_t> vertex;
    std::map<std::int32_t, std::int32_t> index;
    const auto use = [&](std::int32_t v) {
      const auto [place, fresh] = index.try_emplace(v, static_cast<std::int32_t>(points.size()));
      if (fresh) {
        points.push_back(position(v));
        vertex.push_back(v);
      }
      return place->second;
    };
    for (const auto& loop : outline.loops) {
      std::vector<std::int32_t> corners;
      for (const OutlineCorner& c : loop) {
        if (keep_[at(c.vertex)] != 0) corners.push_back(use(c.vertex));
      }
      for (std::size_t i = 0; i < corners.size(); ++i) {
        graph.segments.push_back({corners[i], corners[(i + 1) % corners.size()]});
      }
    }
    for (const std::int32_t v : outline.inner) {
      if (chance(0.3)) graph.points.push_back(use(v));
    }
    graph.holes = outline.holes;
    const SheetFace& face = sheet[at(outline.face)];
    const auto& c = face.corners;
    graph.normal = cross(position(c[0]) - face.middle, position(c[1]) - face.middle);
    auto made = triangulate_facet(points, graph);
    if (!made) throw std::logic_error("random_layer_surface: " + made.error().message);
    if (flipped) flip(made->triangles, points);
    for (std::array<std::int32_t, 3> t : made->triangles) {
      for (std::int32_t& i : t) i = vertex[at(i)];
      if (face.front != 0) std::swap(t[1], t[2]);
      triangles_.push_back(t);
    }
  }

  // Other diagonals here and there: no copy is divided as the next one.
  void flip(std::vector<std::array<std::int32_t, 3>>& triangles,
            const std::vector<Point3>& points) {
    const auto area = [&](std::int32_t a, std::int32_t b, std::int32_t c) {
      return area_normal(points[at(a)], points[at(b)], points[at(c)]);
    };
    for (std::size_t round = 0; round < 2 * triangles.size(); ++round) {
      auto& t = triangles[random_.next() % triangles.size()];
      const std::size_t i = random_.next() % 3;
      const std::int32_t a = t[i], b = t[(i + 1) % 3], c = t[(i + 2) % 3];
      for (auto& u : triangles) {  // the one beyond side ab
        for (std::size_t j = 0; j < 3; ++j) {
          if (u[j] != b || u[(j + 1) % 3] != a) continue;
          const std::int32_t d = u[(j + 2) % 3];
          const Point3 normal = area(a, b, c), both = normal + area(b, a, d);
          const double least = kLeastShare * dot(both, normal);
          if (dot(area(a, d, c), normal) < least || dot(area(d, b, c), normal) < least) continue;
          t = {a, d, c};
          u = {d, b, c};
          j = 3;
        }
      }
    }
  }

  void write(bool soup) {
    const Placement put(random_);
    std::vector<std::int32_t> index(keep_.size(), -1);
    TriangleSurface& s = made_.surface;
    for (std::array<std::int32_t, 3> t : triangles_) {
      for (std::int32_t& v : t) {
        std::int32_t& place = index[at(v)];
        if (place < 0 || soup) {
          place = static_cast<std::int32_t>(s.vertices.size());
          s.vertices.push_back(put(position(v)));
        }
        v = place;
      }
      s.triangles.push_back(t);
    }
    made_.volume = cells_.volume() * put.scale * put.scale * put.scale;
    made_.area = surface_area({s.vertices, s.triangles, {}});
  }

  Random random_;
  RandomSurface made_;
  LayeredCells cells_;
  std::vector<Sheet> sheets_;
  std::vector<std::pair<FacetOutline, const Sheet*>> outlines_;
  std::vector<char> keep_;  // per vertex
  std::vector<std::array<std::int32_t, 3>> triangles_;
};

}  // namespace

RandomSurface make_random_layer_surface(std::uint64_t seed, const RandomLayersOptions& options) {
  return SurfaceMaker(seed, options).run();
}

}  // namespace symcell::test
