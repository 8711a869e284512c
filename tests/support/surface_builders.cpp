#include "tests/support/surface_builders.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/base/random.hpp"
#include "core/geometry/axis_frame.hpp"

namespace symcell {
namespace {

void add_triangle(TriangleSurface& s, Point3 a, Point3 b, Point3 c) {
  const auto first = static_cast<std::int32_t>(s.vertices.size());
  s.vertices.insert(s.vertices.end(), {a, b, c});
  s.triangles.push_back({first, first + 1, first + 2});
}

// The star's outline as fractions of its sides: x times the side's start plus 1 - x times its end.
std::vector<Point2> outline(const PrismShape& shape, Random& random) {
  std::vector<Point2> points;
  const auto corner = [&](std::int32_t i) {
    const double angle = std::numbers::pi * i / shape.fold;
    const double r = i % 2 == 0 ? shape.outer : shape.inner_tip;
    return Point2{r * std::cos(angle), r * std::sin(angle)};
  };
  for (std::int32_t i = 0; i < 2 * shape.fold; ++i) {
    const Point2 from = corner(i), to = corner(i + 1);
    const auto pieces = 1 + static_cast<std::int32_t>(random.uniform() * shape.pieces);
    for (std::int32_t k = 0; k < pieces; ++k) {
      const double t = k == 0 ? 0 : (k + 0.4 * (random.uniform() - 0.5)) / pieces;
      points.push_back(from + t * (to - from));
    }
  }
  return points;
}

}  // namespace

TriangleSurface asymmetric_prism(const PrismShape& shape, std::uint64_t seed) {
  Random random(seed);
  TriangleSurface s;
  const std::vector<Point2> ring = outline(shape, random);
  const std::size_t count = ring.size();
  std::vector<double> heights{0};
  for (std::int32_t k = 1; k < shape.layers; ++k) {
    heights.push_back(shape.height * (k + 0.3 * (random.uniform() - 0.5)) / shape.layers);
  }
  heights.push_back(shape.height);
  const auto at = [&](std::size_t i, double share, double z) {
    const Point2 p = share * ring[i % count];
    const double angle = shape.twist * z / shape.height;
    const double c = std::cos(angle), d = std::sin(angle);
    return Point3{c * p.x - d * p.y, d * p.x + c * p.y, z};
  };
  const auto quad = [&](Point3 a, Point3 b, Point3 c, Point3 d) {
    if (random.uniform() < 0.5) {
      add_triangle(s, a, b, c);
      add_triangle(s, a, c, d);
    } else {
      add_triangle(s, b, c, d);
      add_triangle(s, b, d, a);
    }
  };
  const double bore = shape.bore / shape.outer;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k + 1 < heights.size(); ++k) {
      const double z0 = heights[k], z1 = heights[k + 1];
      quad(at(i, 1, z0), at(i + 1, 1, z0), at(i + 1, 1, z1), at(i, 1, z1));
      if (bore > 0)
        quad(at(i + 1, bore, z0), at(i, bore, z0), at(i, bore, z1), at(i + 1, bore, z1));
    }
    const double h = shape.height;
    if (bore > 0) {
      quad(at(i, bore, h), at(i, 1, h), at(i + 1, 1, h), at(i + 1, bore, h));
      quad(at(i, 1, 0), at(i, bore, 0), at(i + 1, bore, 0), at(i + 1, 1, 0));
    } else {
      add_triangle(s, {0, 0, h}, at(i, 1, h), at(i + 1, 1, h));
      add_triangle(s, {0, 0, 0}, at(i + 1, 1, 0), at(i, 1, 0));
    }
  }
  return s;
}

TriangleSurface box_surface(Point3 low, Point3 high) {
  TriangleSurface s;
  const auto corner = [&](int i) {
    return Point3{(i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y,
                  (i & 4) != 0 ? high.z : low.z};
  };
  constexpr int kQuads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& q : kQuads) {
    add_triangle(s, corner(q[0]), corner(q[1]), corner(q[2]));
    add_triangle(s, corner(q[0]), corner(q[2]), corner(q[3]));
  }
  return s;
}

TriangleSurface ring_surface(std::int32_t sides, double outer, double inner, double height) {
  TriangleSurface tube;
  for (const double r : {outer, inner}) {
    for (const double z : {0.0, height}) {
      for (std::int32_t i = 0; i < sides; ++i) {
        const double angle = 2 * std::numbers::pi * i / sides;
        tube.vertices.push_back({r * std::cos(angle), r * std::sin(angle), z});
      }
    }
  }
  const auto quad = [&](std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) {
    tube.triangles.push_back({a, b, c});
    tube.triangles.push_back({a, c, d});
  };
  for (std::int32_t i = 0; i < sides; ++i) {
    const std::int32_t j = (i + 1) % sides, n = sides;
    quad(i, j, n + j, n + i);                          // outside
    quad(2 * n + j, 2 * n + i, 3 * n + i, 3 * n + j);  // bore
    quad(n + i, n + j, 3 * n + j, 3 * n + i);          // top
    quad(j, i, 2 * n + i, 2 * n + j);                  // bottom
  }
  return tube;
}

void move_to_axis(TriangleSurface& surface, Point3 origin, Point3 direction) {
  const AxisFrame frame = AxisFrame::of_axis(origin, direction);
  for (Point3& p : surface.vertices) p = frame.to_model(p);
}

void append(TriangleSurface& surface, const TriangleSurface& other) {
  const auto offset = static_cast<std::int32_t>(surface.vertices.size());
  surface.vertices.insert(surface.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& t : other.triangles) {
    surface.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  }
}

void turn_inside_out(TriangleSurface& surface) {
  for (auto& t : surface.triangles) std::swap(t[1], t[2]);
}

}  // namespace symcell
