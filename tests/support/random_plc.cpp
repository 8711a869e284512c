#include "tests/support/random_plc.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/base/index.hpp"
#include "core/base/random.hpp"
#include "core/geometry/axis_frame.hpp"

namespace symcell::test {
namespace {

// A ring of points about the axis: `per_sector` of them, repeated `fold` times.
struct Ring {
  std::int32_t fold = 1;
  std::vector<double> radius;  // per point of a sector
  std::vector<double> angle;   // likewise, ascending

  [[nodiscard]] std::int32_t size() const {
    return fold * static_cast<std::int32_t>(radius.size());
  }
  [[nodiscard]] Point2 point(std::int32_t i) const {
    const auto m = static_cast<std::int32_t>(radius.size());
    const double turn = angle[at(i % m)] + 2 * std::numbers::pi * (i / m) / fold;
    return {radius[at(i % m)] * std::cos(turn), radius[at(i % m)] * std::sin(turn)};
  }
  [[nodiscard]] double area() const {
    double sum = 0;
    for (std::int32_t i = 0; i < size(); ++i) sum += cross(point(i), point((i + 1) % size()));
    return 0.5 * sum;
  }
  // The distance of the nearest side from the axis.
  [[nodiscard]] double inner_radius() const {
    double best = 1e300;
    for (std::int32_t i = 0; i < size(); ++i) {
      const Point2 a = point(i);
      const Point2 u = point((i + 1) % size()) - a;
      const double t = std::clamp(-dot(a, u) / squared_length(u), 0.0, 1.0);
      best = std::min(best, length(a + t * u));
    }
    return best;
  }
};

class Maker {
 public:
  Maker(std::uint64_t seed, const RandomPlcOptions& options) : random_(seed) {
    // The first numbers of neighbouring seeds are alike in nothing but that.
    result_.acute = options.acute && chance(0.4);
    const double pick = random_.uniform();
    std::int32_t fold = 1 + integer(8);
    if (pick < 0.3) fold = 1 + integer(options.max_fold);
    result_.fold = options.fold.value_or(std::min(fold, options.max_fold));
  }

  RandomPlc run() {
    switch (integer(6)) {
      case 0:
        if (result_.fold >= 3) {
          antiprism();
          break;
        }
        [[fallthrough]];
      case 1:
        if (result_.fold >= 2) {
          blocks();
          break;
        }
        [[fallthrough]];
      case 2: bipyramid(); break;
      default: stack();
    }
    place();
    return std::move(result_);
  }

 private:
  bool chance(double p) { return random_.uniform() < p; }
  double between(double low, double high) { return low + (high - low) * random_.uniform(); }
  std::int32_t integer(std::int32_t count) {
    return static_cast<std::int32_t>(random_.uniform() * count);
  }

  std::int32_t vertex(Point3 p) {
    plc().vertices.push_back(p);
    return static_cast<std::int32_t>(plc().vertices.size()) - 1;
  }
  Plc& plc() { return result_.plc; }
  void facet(std::vector<std::vector<std::int32_t>> polygons,
             std::int32_t marker,
             std::vector<Point3> holes = {}) {
    PlcFacet f;
    f.polygons = std::move(polygons);
    f.holes = std::move(holes);
    f.marker = marker;
    plc().facets.push_back(std::move(f));
  }

  // Angles are spread so that no gap reaches 150 degrees: the ring stays star-shaped.
  Ring ring(double low, double high) {
    const std::int32_t n = result_.fold;
    const std::int32_t least = n == 1 ? 4 : n == 2 ? 2 : 1;
    const std::int32_t most = std::max(least, std::min(6, 160 / n));
    const std::int32_t m = least + integer(most - least + 1);
    Ring ring;
    ring.fold = n;
    const double step = 2 * std::numbers::pi / (n * m);
    // Blunt: neighbours differ by less than a third of their distance.
    if (!result_.acute) low = std::max(low, high * (1 - 0.3 * step));
    const double phase = between(0, 2 * std::numbers::pi);
    for (std::int32_t i = 0; i < m; ++i) {
      ring.radius.push_back(between(low, high));
      ring.angle.push_back(phase + step * (i + (m > 1 ? between(-0.3, 0.3) : 0)));
    }
    return ring;
  }
  Ring outer_ring() { return result_.acute ? ring(0.25, 1) : ring(0.8, 1); }

  std::vector<std::int32_t> place_ring(const Ring& ring, double z, double scale) {
    std::vector<std::int32_t> result;
    for (std::int32_t i = 0; i < ring.size(); ++i) {
      const Point2 p = ring.point(i);
      result.push_back(vertex({scale * p.x, scale * p.y, z}));
    }
    return result;
  }
  void walls(const std::vector<std::int32_t>& low,
             const std::vector<std::int32_t>& high,
             std::int32_t per_sector,
             std::int32_t marker) {
    for (std::size_t i = 0; i < low.size(); ++i) {
      const std::size_t j = (i + 1) % low.size();
      const auto kind = static_cast<std::int32_t>(i) % per_sector;
      facet({{low[i], low[j], high[j], high[i]}}, marker + kind);
    }
  }

  // Layers of a prism or frustum, with or without a bore; layers may be regions or voids, and
  // partitions may divide them into sectors.
  void stack() {
    const Ring outer = outer_ring();
    const bool bored = chance(0.5);
    Ring inner;
    if (bored) {
      const double room = outer.inner_radius();
      inner = ring(0.4 * room, 0.8 * room);
    }
    const auto m = static_cast<std::int32_t>(outer.radius.size());
    const std::int32_t layers = 1 + (chance(0.4) ? 1 + integer(2) : 0);
    const std::int32_t cavity = layers == 3 && chance(0.4) ? 1 : -1;
    const bool regions = layers > 1 && chance(0.7);
    const double height = std::exp(between(std::log(0.3), std::log(result_.acute ? 6.0 : 2.0)));
    double taper = chance(0.4) ? between(0.4, 1.6) : 1;
    // Blunt: walls at less than 15 degrees from upright.
    if (!result_.acute) taper = std::clamp(taper, 1 - 0.25 * height, 1 + 0.25 * height);
    const double area = outer.area() - (bored ? inner.area() : 0);
    result_.description = std::to_string(layers) + (layers == 1 ? " layer" : " layers");
    if (bored) result_.description += ", bored";
    if (cavity >= 0) result_.description += ", cavity";
    if (taper != 1) result_.description += ", tapered";
    // One scale for both rings.
    const auto scale_at = [&](std::int32_t level) { return 1 + (taper - 1) * level / layers; };

    std::vector<std::int32_t> below, below_inner;
    for (std::int32_t level = 0; level <= layers; ++level) {
      const double z = height * level / layers;
      const double scale = scale_at(level);
      const std::vector<std::int32_t> here = place_ring(outer, z, scale);
      std::vector<std::vector<std::int32_t>> polygons{here};
      std::vector<Point3> holes;
      std::vector<std::int32_t> here_inner;
      if (bored) {
        here_inner = place_ring(inner, z, scale);
        polygons.push_back(here_inner);
        holes.push_back({0, 0, z});
      }
      const bool outside = level == 0 || level == layers;
      facet(std::move(polygons), outside ? 1 + (level == 0 ? 0 : 1) : 20 + level, std::move(holes));
      if (level > 0) {
        walls(below, here, m, 3);
        if (bored)
          walls(below_inner, here_inner, static_cast<std::int32_t>(inner.radius.size()), 30);
        fill_layer(level - 1 == cavity, regions, outer, bored ? &inner : nullptr, level,
                   height / layers, z, scale_at(level - 1), scale, area);
      }
      below = here;
      below_inner = here_inner;
    }
    if (layers > 1) result_.plain_surface = false;
    result_.axis_inside = !bored;
  }

  void fill_layer(bool is_cavity,
                  bool regions,
                  const Ring& outer,
                  const Ring* inner,
                  std::int32_t level,
                  double thickness,
                  double top,
                  double scale_low,
                  double scale_high,
                  double area) {
    const double middle = 0.5 * (scale_low + scale_high);
    const double z = top - 0.5 * thickness;
    double hollow = 0;
    if (inner != nullptr) {
      for (const double r : inner->radius) hollow = std::max(hollow, r);
    }
    const double rim = outer.inner_radius();
    const double radius = middle * 0.5 * (hollow + rim);
    const double phase = between(0, 2 * std::numbers::pi);
    const Point3 inside{radius * std::cos(phase), radius * std::sin(phase), z};
    const double volume =
        thickness * area *
        (scale_low * scale_low + scale_low * scale_high + scale_high * scale_high) / 3;
    if (is_cavity) {
      plc().holes.push_back(inside);
      return;
    }
    result_.volume += volume;
    if (regions) plc().regions.push_back({inside, level});
    // Room for things that touch nothing: a ball round a point of every sector.
    const double sector = result_.fold == 1 ? 1 : std::sin(std::numbers::pi / result_.fold);
    const double narrow = std::min(scale_low, scale_high) * 0.5 * (rim - hollow);
    const double slack = middle - std::min(scale_low, scale_high);
    const double room = 0.6 * std::min({narrow - slack * rim, 0.5 * thickness, radius * sector});
    if (room < 0.01) return;
    if (chance(0.25))
      baffles(phase, radius, z, room);
    else if (chance(0.15))
      needles(phase, radius, z, room);
  }

  // A triangle or a parallelogram in each sector that touches nothing.
  void baffles(double phase, double radius, double z, double room) {
    const Point3 u = 0.6 * room * unit();
    const Point3 w = 0.6 * room * unit();
    if (length(cross(u, w)) < 0.05 * room * room) return;
    const bool quad = chance(0.5);
    for (std::int32_t k = 0; k < result_.fold; ++k) {
      const std::vector<Point3> shape = quad ? std::vector<Point3>{u, w, -1.0 * u, -1.0 * w}
                                             : std::vector<Point3>{u, w, -1.0 * u};
      std::vector<std::int32_t> polygon;
      for (const Point3 d : shape) polygon.push_back(vertex(turned(phase, radius, z, d, k)));
      facet({polygon}, 9);
    }
    result_.plain_surface = false;
    result_.description += ", baffles";
  }

  void needles(double phase, double radius, double z, double room) {
    const Point3 u = 0.8 * room * unit();
    for (std::int32_t k = 0; k < result_.fold; ++k) {
      PlcSegment s;
      s.a = vertex(turned(phase, radius, z, u, k));
      s.b = vertex(turned(phase, radius, z, -1.0 * u, k));
      s.marker = 7;
      plc().segments.push_back(s);
    }
    result_.description += ", needles";
  }

  Point3 unit() {
    for (;;) {
      const Point3 d{between(-1, 1), between(-1, 1), between(-1, 1)};
      const double size = length(d);
      if (size > 0.1 && size <= 1) return (1 / size) * d;
    }
  }

  // Copy k of the point at `offset` (x outwards, y along the turn, z up) from the middle of a ball.
  [[nodiscard]] Point3 turned(
      double phase, double radius, double z, Point3 offset, std::int32_t k) const {
    const double a = phase + 2 * std::numbers::pi * k / result_.fold;
    const double x = radius + offset.x;
    return {x * std::cos(a) - offset.y * std::sin(a), x * std::sin(a) + offset.y * std::cos(a),
            z + offset.z};
  }

  void antiprism() {
    const std::int32_t n = result_.fold;
    const double top = result_.acute ? between(0.3, 2) : between(0.8, 1.2);
    const double height = between(0.4, result_.acute ? 4.0 : 1.5);
    std::vector<std::int32_t> low, high;
    for (std::int32_t i = 0; i < n; ++i) {
      const double a = 2 * std::numbers::pi * i / n;
      low.push_back(vertex({std::cos(a), std::sin(a), 0}));
    }
    for (std::int32_t i = 0; i < n; ++i) {
      const double a = 2 * std::numbers::pi * (i + 0.5) / n;
      high.push_back(vertex({top * std::cos(a), top * std::sin(a), height}));
    }
    facet({low}, 1);
    facet({high}, 2);
    for (std::int32_t i = 0; i < n; ++i) {
      const std::int32_t j = (i + 1) % n;
      facet({{low[at(i)], low[at(j)], high[at(i)]}}, 3);
      facet({{low[at(j)], high[at(j)], high[at(i)]}}, 4);
    }
    add_volume_by_cones({0, 0, 0.5 * height});
    result_.axis_inside = true;
    result_.description += "antiprism";
  }

  // A star-shaped body: cones over its facets (convex polygons) from a point that sees them all.
  void add_volume_by_cones(Point3 apex) {
    for (const PlcFacet& f : plc().facets) {
      const auto& p = f.polygons.front();
      double sum = 0;
      for (std::size_t i = 1; i + 1 < p.size(); ++i) {
        const auto point = [&](std::size_t k) { return plc().vertices[at(p[k])] - apex; };
        sum += dot(point(0), cross(point(i), point(i + 1))) / 6;
      }
      result_.volume += std::abs(sum);
    }
  }

  void bipyramid() {
    const Ring outer = outer_ring();
    const double up = between(0.3, result_.acute ? 4.0 : 1.2);
    const double down = between(0.3, result_.acute ? 4.0 : 1.2);
    const std::vector<std::int32_t> belt = place_ring(outer, 0, 1);
    const std::int32_t top = vertex({0, 0, up});
    const std::int32_t bottom = vertex({0, 0, -down});
    const auto m = static_cast<std::int32_t>(outer.radius.size());
    for (std::size_t i = 0; i < belt.size(); ++i) {
      const std::size_t j = (i + 1) % belt.size();
      facet({{belt[i], belt[j], top}}, 1 + static_cast<std::int32_t>(i) % m);
      facet({{belt[j], belt[i], bottom}}, 11 + static_cast<std::int32_t>(i) % m);
    }
    if (chance(0.3)) {  // an inner floor that divides the two halves
      facet({belt}, 50);
      plc().regions.push_back({{0, 0, 0.5 * up}, 1});
      plc().regions.push_back({{0, 0, -0.5 * down}, 2});
      result_.plain_surface = false;
      result_.description += "divided ";
    }
    result_.volume = outer.area() * (up + down) / 3;
    result_.axis_inside = true;
    result_.description += "bipyramid";
  }

  // Tilted boxes, tetrahedra and prisms in a ring, none of which touches another.
  void blocks() {
    const std::int32_t n = result_.fold;
    const double radius = 1;
    const double room = 0.85 * radius * std::sin(std::numbers::pi / n);
    const double phase = between(0, 2 * std::numbers::pi);
    const std::int32_t kind = integer(2);
    const Point3 u = unit();
    Point3 v = unit();
    while (length(cross(u, v)) < (result_.acute ? 0.2 : 0.7)) v = unit();
    Point3 w = unit();
    while (std::abs(dot(w, cross(u, v))) < (result_.acute ? 0.1 : 0.5)) w = unit();
    const double size = 0.3 * room;
    if (dot(w, cross(u, v)) < 0) w = -1.0 * w;
    const auto corner = [&](int a, int b, int c) { return size * (a * u + b * v + c * w); };
    std::vector<Point3> shape;
    std::vector<std::vector<std::int32_t>> sides;
    double volume = std::pow(size, 3) * dot(w, cross(u, v));
    if (kind == 0) {
      shape = {corner(0, 0, 0), corner(2, 0, 0), corner(0, 2, 0), corner(0, 0, 2)};
      sides = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
      volume *= 8.0 / 6;
    } else {
      shape = {corner(-1, -1, -1), corner(1, -1, -1), corner(1, 1, -1), corner(-1, 1, -1),
               corner(-1, -1, 1),  corner(1, -1, 1),  corner(1, 1, 1),  corner(-1, 1, 1)};
      sides = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
      volume *= 8;
    }
    for (std::int32_t k = 0; k < n; ++k) {
      const auto first = static_cast<std::int32_t>(plc().vertices.size());
      for (const Point3 d : shape) vertex(turned(phase, radius, 0, d, k));
      for (std::size_t s = 0; s < sides.size(); ++s) {
        std::vector<std::int32_t> polygon = sides[s];
        for (std::int32_t& i : polygon) i += first;
        facet({polygon}, static_cast<std::int32_t>(s) + 1);
      }
    }
    result_.volume = n * volume;
    result_.description += kind == 0 ? "loose tetrahedra" : "loose boxes";
  }

  // Turns, scales and shifts the model, and measures it.
  void place() {
    const double scale = chance(0.5) ? 1 : std::exp(between(std::log(1e-3), std::log(1e3)));
    const Point3 direction = chance(0.3) ? Point3{0, 0, 1} : unit();
    Point3 origin;
    if (chance(0.6)) origin = (scale * std::exp(between(std::log(0.1), std::log(300)))) * unit();
    const AxisFrame frame = AxisFrame::of_axis(origin, direction);
    const auto move = [&](Point3& p) { p = frame.to_model(scale * p); };
    for (Point3& p : plc().vertices) move(p);
    for (PlcFacet& f : plc().facets) {
      for (Point3& p : f.holes) move(p);
    }
    for (Point3& p : plc().holes) move(p);
    for (PlcRegion& r : plc().regions) move(r.point);
    result_.volume *= scale * scale * scale;
    result_.axis_origin = origin;
    result_.axis_direction = direction;
    Point3 low = plc().vertices.front();
    Point3 high = low;
    for (const Point3 p : plc().vertices) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    result_.diameter = distance(low, high);
    result_.description = std::to_string(result_.fold) + "-fold " + result_.description +
                          (result_.acute ? ", acute" : ", blunt");
  }

  Random random_;
  RandomPlc result_;
};

}  // namespace

RandomPlc make_random_plc(std::uint64_t seed, const RandomPlcOptions& options) {
  return Maker(seed, options).run();
}

}  // namespace symcell::test
