#include "tests/support/touching_bodies.hpp"

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/base/random.hpp"
#include "core/geometry/indexed_surface.hpp"
#include "tests/support/surface_builders.hpp"

namespace symcell::test {

TriangleSurface prism(const std::vector<std::pair<double, double>>& polygon,
                      double low,
                      double high) {
  TriangleSurface s;
  const auto n = static_cast<std::int32_t>(polygon.size());
  for (const double z : {low, high}) {
    for (const auto& [x, y] : polygon) s.vertices.push_back({x, y, z});
  }
  for (std::int32_t i = 1; i + 1 < n; ++i) {
    s.triangles.push_back({0, i + 1, i});
    s.triangles.push_back({n, n + i, n + i + 1});
  }
  for (std::int32_t i = 0; i < n; ++i) {
    const std::int32_t j = (i + 1) % n;
    s.triangles.push_back({i, j, n + j});
    s.triangles.push_back({i, n + j, n + i});
  }
  return s;
}

namespace {

constexpr double kRadius = 3;
// Of bodies in the hollow of a drum.
constexpr double kInner = 2.5;  // radius of the hollow
constexpr double kWedgeDepth = 0.01;
constexpr double kWedgeHeight = 0.7;

std::vector<std::pair<double, double>> regular(std::int32_t n, double radius, double turn = 0) {
  std::vector<std::pair<double, double>> polygon;
  for (std::int32_t i = 0; i < n; ++i) {
    const double angle = turn + 2 * std::numbers::pi * i / n;
    polygon.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return polygon;
}

// In the hollow of a drum, at each side of its wall, which is `at` from the axis.
TriangleSurface inside_part(Assembly kind, double at, double width) {
  const double w = width / 4;
  switch (kind) {
    case Assembly::kPillars: return box_surface({at - 0.5, -w, -1}, {at, w, 1});
    case Assembly::kWedges:
      return box_surface({at - 0.5, -w, -0.4}, {at + kWedgeDepth, w, kWedgeHeight - 0.4});
    case Assembly::kSpikes: {
      TriangleSurface s;
      s.vertices = {{at, 0, 0}, {at - 0.5, -w, -0.3}, {at - 0.5, w, -0.3}, {at - 0.5, 0, 0.4}};
      s.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
      return s;
    }
    default: return box_surface({at - 0.5, -w, -0.4}, {at, w, 0.3});
  }
}

TriangleSurface drum_with_bodies(std::int32_t n, Assembly kind) {
  TriangleSurface whole = prism(regular(n, kRadius), -1.5, 1.5);
  TriangleSurface hollow = prism(regular(n, kInner), -1, 1);
  turn_inside_out(hollow);
  append(whole, hollow);
  const double half = std::numbers::pi / n;
  for (std::int32_t i = 0; i < n; ++i) {
    TriangleSurface one = inside_part(kind, kInner * std::cos(half), 2 * kInner * std::sin(half));
    turn(one, (2 * i + 1) * half);
    append(whole, one);
  }
  return whole;
}

TriangleSurface parts_of(std::int32_t n, Assembly kind) {
  TriangleSurface whole;
  const auto ring = [&](double outer, double inner) {
    append(whole, ring_surface(n, outer, inner, 1));
  };
  const auto disc = [&](double radius, double low, double high) {
    append(whole, prism(regular(n, radius), low, high));
  };
  switch (kind) {
    case Assembly::kPin:
      ring(kRadius, 1);
      disc(1, -0.5, 1.5);
      break;
    case Assembly::kFlushPin:
      ring(kRadius, 1);
      disc(1, 0, 1);
      break;
    case Assembly::kRings:
      ring(kRadius, 2);
      ring(2, 1);
      break;
    case Assembly::kStack:
      disc(2, 0, 1);
      disc(2, 1, 1.7);
      disc(2, 1.7, 3);
      break;
    case Assembly::kTeeth: {
      const double half = std::numbers::pi / (2 * n);
      append(whole, prism(regular(2 * n, 2, half), 0, 1));
      const double at = 2 * std::cos(half), w = 2 * std::sin(half);
      for (std::int32_t i = 0; i < n; ++i) {
        TriangleSurface tooth =
            prism({{at, -w}, {at + 0.5, -w / 2}, {at + 0.5, w / 2}, {at, w}}, 0, 1);
        turn(tooth, 2 * std::numbers::pi * i / n);
        append(whole, tooth);
      }
      break;
    }
    case Assembly::kPillars:
    case Assembly::kBrackets:
    case Assembly::kWedges:
    case Assembly::kSpikes: return drum_with_bodies(n, kind);
  }
  return whole;
}

// As a file in single precision has it.  Volatile: GCC 12 leaves the rounding out of the last turns of the
// loop below when it unrolls it.
double rounded(double x) {
  volatile float single = static_cast<float>(x);
  return static_cast<double>(single);
}

void round_to_single(TriangleSurface& surface) {
  for (Point3& p : surface.vertices) p = {rounded(p.x), rounded(p.y), rounded(p.z)};
}

}  // namespace

United united(std::int32_t n, Assembly kind) {
  switch (kind) {
    case Assembly::kRings: return {1, 1, 0};
    case Assembly::kPillars:
    case Assembly::kBrackets: return {2, 0, 0};
    case Assembly::kWedges: {
      const double width = kInner * std::sin(std::numbers::pi / n);  // half a side of the wall
      return {2, 0, n * width * kWedgeDepth * kWedgeHeight};
    }
    case Assembly::kSpikes: return {2 + n, 0, 0};
    default: return {1, 0, 0};
  }
}

bool is_one_solid(Touch touch) {
  return touch != Touch::kEdge && touch != Touch::kEdgeFlush && touch != Touch::kCorner;
}

TriangleSurface body(Touch touch, double at, double width) {
  const double w = width / 4;
  switch (touch) {
    case Touch::kFace: return box_surface({at, -w, 0.25}, {at + 1, w, 0.75});
    case Touch::kFlush: return box_surface({at, -w, 0}, {at + 1, w, 1});
    case Touch::kWhole: return box_surface({at, -2 * w, 0}, {at + 1, 2 * w, 1});
    case Touch::kHanging: return box_surface({at, -w, 0.5}, {at + 1, w, 1.5});
    case Touch::kEdge:
      return prism({{at, 0}, {at + 1, -w}, {at + 1.5, 0}, {at + 1, w}}, 0.25, 0.75);
    case Touch::kEdgeFlush: return prism({{at, 0}, {at + 1, -w}, {at + 1.5, 0}, {at + 1, w}}, 0, 1);
    case Touch::kCorner: {
      TriangleSurface s;
      s.vertices = {{at, 0, 0.5}, {at + 1, -w, 0.3}, {at + 1, w, 0.3}, {at + 1, 0, 0.8}};
      s.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}};
      return s;
    }
  }
  return {};
}

void turn(TriangleSurface& surface, double angle) {
  for (Point3& p : surface.vertices) {
    p = {std::cos(angle) * p.x - std::sin(angle) * p.y,
         std::sin(angle) * p.x + std::cos(angle) * p.y, p.z};
  }
}

TriangleSurface prism_with_bodies(std::int32_t n, Touch touch, double phase, Point3 centre) {
  const double step = 2 * std::numbers::pi / n;
  TriangleSurface whole = prism(regular(n, kRadius), 0, 1);
  for (std::int32_t i = 0; i < n; ++i) {
    TriangleSurface one =
        body(touch, kRadius * std::cos(step / 2), 2 * kRadius * std::sin(step / 2));
    turn(one, (i + 0.5) * step);
    append(whole, one);
  }
  turn(whole, phase);
  for (Point3& p : whole.vertices) p = p + centre;
  round_to_single(whole);
  return whole;
}

TriangleSurface assembled(std::int32_t n, Assembly kind, Point3 turns, Point3 centre) {
  TriangleSurface whole = parts_of(n, kind);
  for (const double angle : {turns.x, turns.y, turns.z}) {
    turn(whole, angle);
    for (Point3& p : whole.vertices) p = {p.y, p.z, p.x};
  }
  for (Point3& p : whole.vertices) p = p + centre;
  round_to_single(whole);
  return whole;
}

RandomSurface make_touching_bodies(std::uint64_t seed) {
  Random random(seed + 0xb0d1e5);
  RandomSurface made;
  made.fold = 3 + static_cast<std::int32_t>(random.next() % 10);
  const auto angle = [&] { return 2 * std::numbers::pi * random.uniform(); };
  Point3 centre;
  if (random.uniform() < 0.5) {
    centre = {20 * random.uniform() - 10, 20 * random.uniform() - 10, 20 * random.uniform() - 10};
  }
  United parts;
  if (random.uniform() < 0.4) {
    const Assembly kind = kAssemblies[random.next() % kAssemblies.size()];
    parts = united(made.fold, kind);
    const Point3 turns{angle(), angle(), angle()};
    made.surface = assembled(made.fold, kind, turns, centre);
    made.description = "assembly of way " + std::to_string(static_cast<int>(kind));
  } else {
    const Touch touch = kTouches[random.next() % kTouches.size()];
    parts.shells = is_one_solid(touch) ? 1 : made.fold + 1;
    made.surface = prism_with_bodies(made.fold, touch, angle(), centre);
    made.description = "bodies that touch a prism, way " + std::to_string(static_cast<int>(touch));
  }
  made.description += ", fold " + std::to_string(made.fold);
  const IndexedSurface indexed{
      made.surface.vertices, {made.surface.triangles.begin(), made.surface.triangles.end()}, {}};
  made.volume = enclosed_volume(indexed, centre) - parts.overlap;
  made.area = surface_area(indexed);
  made.boundary = BoundaryTopology{parts.shells, 2 * (parts.shells - parts.holes)};
  return made;
}

}  // namespace symcell::test
