// What each level of repair makes of small dirty surfaces.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/base/random.hpp"
#include "core/geometry/self_intersections.hpp"
#include "core/solid/surface/clean_surface.hpp"
#include "tests/support/surface_builders.hpp"

namespace symcell::solid {
namespace {

constexpr Repair kLevels[] = {Repair::kNone, Repair::kSafe, Repair::kAll, Repair::kWrap};

void add_triangle(TriangleSurface& s, Point3 a, Point3 b, Point3 c) {
  const auto first = static_cast<std::int32_t>(s.vertices.size());
  s.vertices.insert(s.vertices.end(), {a, b, c});
  s.triangles.push_back({first, first + 1, first + 2});
}

Point3 turned(Point3 p, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
}

TriangleSurface turned(TriangleSurface surface, double angle) {
  for (Point3& p : surface.vertices) p = turned(p, angle);
  return surface;
}

// A regular prism about the z axis.
TriangleSurface prism(int sides, double radius, double low, double high) {
  TriangleSurface s;
  const auto corner = [&](int i, double z) {
    return turned(Point3{radius, 0, z}, 2 * std::numbers::pi * i / sides);
  };
  for (int i = 0; i < sides; ++i) {
    add_triangle(s, corner(i, low), corner(i + 1, low), corner(i + 1, high));
    add_triangle(s, corner(i, low), corner(i + 1, high), corner(i, high));
    add_triangle(s, {0, 0, high}, corner(i, high), corner(i + 1, high));
    add_triangle(s, {0, 0, low}, corner(i + 1, low), corner(i, low));
  }
  // The last corner is the first.
  for (Point3& p : s.vertices) {
    const Point3 first = corner(sides, p.z);
    if (p == first) p = corner(0, p.z);
  }
  return s;
}

CleanSurface cleaned(const TriangleSurface& surface,
                     Repair repair,
                     double tolerance_rel = kSurfaceSymmetryToleranceRel) {
  ExecutionContext context;
  auto clean = clean_surface(surface, context, tolerance_rel, repair);
  EXPECT_TRUE(clean) << (clean ? "" : clean.error().message);
  return clean ? std::move(*clean) : CleanSurface{};
}

void expect_valid(const CleanSurface& clean) {
  ASSERT_FALSE(clean.problem) << clean.problem->message;
  ExecutionContext context;
  const auto pairs = self_intersections(clean.surface, 1, context);
  ASSERT_TRUE(pairs);
  EXPECT_TRUE(pairs->empty());
  const std::vector<EdgeUse> uses = sorted_edge_uses(clean.surface.triangles);
  for_each_edge(uses, [&](std::size_t begin, std::size_t end) {
    ASSERT_EQ(end - begin, 2U);
    EXPECT_NE(uses[begin].forward, uses[begin + 1].forward);
  });
}

void expect_refused(const CleanSurface& clean, ErrorCode code, const std::string& help) {
  ASSERT_TRUE(clean.problem);
  EXPECT_EQ(clean.problem->code, code);
  EXPECT_NE(clean.problem->message.find(help), std::string::npos) << clean.problem->message;
}

// Mended at every level but none, to this volume and with a sentence.
void expect_mended(const TriangleSurface& surface,
                   ErrorCode code_of_none,
                   double volume,
                   double within = 1e-12) {
  for (const Repair level : kLevels) {
    const CleanSurface clean = cleaned(surface, level);
    if (level == Repair::kNone) {
      expect_refused(clean, code_of_none, "repair=safe");
      continue;
    }
    expect_valid(clean);
    EXPECT_NEAR(clean.volume, volume, within * volume);
    EXPECT_FALSE(clean.repairs.empty());
  }
}

TEST(RepairSurface, UnitesTwoBoxes) {
  TriangleSurface surface = box_surface({0, 0, 0}, {1, 1, 1});
  append(surface, box_surface({0.5, 0.25, 0.125}, {1.5, 1.75, 2}));
  expect_mended(surface, ErrorCode::kSelfIntersection, 1 + 1.5 * 1.875 - 0.5 * 0.75 * 0.875);
}

// Faces in one plane, some shared in part.
TEST(RepairSurface, UnitesBoxesWithFacesInOnePlane) {
  TriangleSurface surface = box_surface({0, 0, 0}, {2, 2, 1});
  append(surface, box_surface({1, 0, 0}, {3, 1, 1}));
  append(surface, box_surface({0, 0, 1}, {1, 2, 2}));
  expect_mended(surface, ErrorCode::kNotWatertight, 4 + 1 + 2);
}

TEST(RepairSurface, UnitesBladesWithTheirHub) {
  TriangleSurface surface = box_surface({-1, -1, 0}, {1, 1, 1});
  for (int i = 0; i < 4; ++i) {
    TriangleSurface blade = box_surface({0.5, -0.25, 0.25}, {3, 0.25, 0.75});
    for (int k = 0; k < i; ++k) {
      for (Point3& p : blade.vertices) p = {-p.y, p.x, p.z};
    }
    append(surface, blade);
  }
  expect_mended(surface, ErrorCode::kSelfIntersection, 4 + 4 * 2 * 0.5 * 0.5);
}

// The blades' boxes lie in the hub's, and each has its first vertex inside the hub.
TEST(RepairSurface, UnitesBladesWithinARing) {
  constexpr int kFold = 7;
  TriangleSurface surface = prism(5 * kFold, 2, 0, 1);
  for (int i = 0; i < kFold; ++i) {
    append(surface, turned(box_surface({0.25, -0.125, 0.5}, {1, 0.125, 1.5}),
                           2 * std::numbers::pi * i / kFold));
  }
  const double hub = 5 * kFold * 2 * std::sin(2 * std::numbers::pi / (5 * kFold));
  const CleanSurface clean = cleaned(surface, Repair::kSafe);
  expect_valid(clean);
  // Above the hub neighbouring blades overlap near the axis: measured in triangles of the section.
  const double half = std::numbers::pi / kFold, x = 0.125 / std::tan(half);
  const double overlap = x > 0.25 ? (x - 0.25) * (0.125 - 0.25 * std::tan(half)) : 0;
  EXPECT_NEAR(clean.volume, hub + 0.5 * kFold * (0.75 * 0.25 - overlap), 2e-3);
}

// Both discs are fans about the axis, and one lies within the other: many points are found in
// triangles that are cut already.
TEST(RepairSurface, UnitesCylindersThatStandOnEachOther) {
  for (const auto& [sides, others] : {std::pair{12, 36}, std::pair{24, 24}, std::pair{30, 12}}) {
    TriangleSurface surface = prism(sides, 1, 0, 1);
    append(surface, prism(others, 2, 1, 2));
    const auto area = [](int n, double r) {
      return 0.5 * n * r * r * std::sin(2 * std::numbers::pi / n);
    };
    const CleanSurface clean = cleaned(surface, Repair::kSafe);
    expect_valid(clean);
    EXPECT_EQ(clean.shells, 1);
    EXPECT_NEAR(clean.volume, area(sides, 1) + area(others, 2), 1e-9);
  }
}

// A hollow of both bodies, or of one, which the other fills.
TEST(RepairSurface, LeavesAHollowInTheOverlapOfTwoBodies) {
  TriangleSurface bodies = box_surface({0, 0, 0}, {6, 6, 6});
  append(bodies, box_surface({3, 1, 1}, {9, 5, 5}));
  TriangleSurface part = box_surface({4, 2, 2}, {5, 3, 3});
  for (const bool inwards : {true, false}) {
    if (inwards) turn_inside_out(part);
    TriangleSurface surface = bodies;
    append(surface, part);
    expect_refused(cleaned(surface, Repair::kSafe), ErrorCode::kSelfIntersection,
                   "whether it is a hollow of all of them or of one");
    const CleanSurface clean = cleaned(surface, Repair::kAll);
    expect_valid(clean);
    EXPECT_NEAR(clean.volume, 216 + 3 * 16, 1e-9);
  }
}

// The overlap is no deeper than either body.
TEST(RepairSurface, KeepsTheHollowOfOneOfTwoBodies) {
  TriangleSurface surface = box_surface({0, 0, 0}, {6, 6, 6});
  append(surface, box_surface({3, 1, 1}, {9, 5, 5}));
  TriangleSurface hollow = box_surface({1, 2, 2}, {2, 3, 3});
  turn_inside_out(hollow);
  append(surface, hollow);
  const CleanSurface clean = cleaned(surface, Repair::kSafe);
  expect_valid(clean);
  EXPECT_NEAR(clean.volume, 216 + 3 * 16 - 1, 1e-9);
}

TEST(RepairSurface, SplitsAnEdgeOfTwoBoxes) {
  TriangleSurface surface = box_surface({0, 0, 0}, {1, 1, 1});
  append(surface, box_surface({-1, -1, 0}, {0, 0, 1}));
  expect_mended(surface, ErrorCode::kNotWatertight, 2, 1e-4);
  const CleanSurface clean = cleaned(surface, Repair::kSafe);
  EXPECT_EQ(clean.shells, 2);
}

// A ring of four boxes in which two neighbours touch along an edge only.
TEST(RepairSurface, SplitsAnEdgeOfOneBody) {
  TriangleSurface surface = box_surface({0, 0, 0}, {1, 1, 1});
  append(surface, box_surface({-1, -1, 0}, {0, 0, 1}));
  append(surface, box_surface({-1, -1, 1}, {1, 1, 2}));
  expect_mended(surface, ErrorCode::kNotWatertight, 2 + 4, 1e-4);
}

TEST(RepairSurface, ClosesAHoleWhenAsked) {
  TriangleSurface surface = box_surface({0, 0, 0}, {1, 1, 1});
  surface.triangles.pop_back();
  expect_refused(cleaned(surface, Repair::kNone), ErrorCode::kNotWatertight, "repair=safe");
  expect_refused(cleaned(surface, Repair::kSafe), ErrorCode::kNotWatertight, "repair=all");
  for (const Repair level : {Repair::kAll, Repair::kWrap}) {
    const CleanSurface clean = cleaned(surface, level);
    expect_valid(clean);
    EXPECT_DOUBLE_EQ(clean.volume, 1);
    EXPECT_EQ(clean.repairs.size(), 1U);
  }
}

// A small triangle missing in a side.
TEST(RepairSurface, ClosesASmallPlanarHole) {
  TriangleSurface surface = box_surface({0, 0, 0}, {1, 1, 1});
  surface.triangles.erase(surface.triangles.begin(), surface.triangles.begin() + 2);  // the bottom
  const Point3 a{0.5, 0.5, 0}, b{0.5, 0.515625, 0}, c{0.515625, 0.5, 0};
  add_triangle(surface, {0, 0, 0}, {0, 1, 0}, b);
  add_triangle(surface, {0, 1, 0}, {1, 1, 0}, b);
  add_triangle(surface, {1, 1, 0}, c, b);
  add_triangle(surface, {1, 1, 0}, {1, 0, 0}, c);
  add_triangle(surface, {1, 0, 0}, {0, 0, 0}, c);
  add_triangle(surface, {0, 0, 0}, a, c);
  add_triangle(surface, {0, 0, 0}, b, a);
  expect_mended(surface, ErrorCode::kNotWatertight, 1);
}

// The annular end of a tube: both rims are closed, and what covers the bore twice cancels.
TEST(RepairSurface, ClosesAnAnnulus) {
  TriangleSurface outer = prism(12, 2, 0, 1), inner = prism(12, 1, 0, 1);
  turn_inside_out(inner);
  TriangleSurface tube;
  for (const TriangleSurface* part : {&outer, &inner}) {
    for (std::size_t t = 0; t < part->triangles.size(); ++t) {
      if (t % 4 >= 2) continue;  // walls only
      const auto& v = part->triangles[t];
      add_triangle(tube, part->vertices[v[0]], part->vertices[v[1]], part->vertices[v[2]]);
    }
  }
  expect_refused(cleaned(tube, Repair::kSafe), ErrorCode::kNotWatertight, "repair=all");
  const CleanSurface clean = cleaned(tube, Repair::kAll);
  expect_valid(clean);
  EXPECT_NEAR(clean.volume, 12 * 0.5 * (4 - 1) * std::sin(std::numbers::pi / 6), 1e-12);
}

TEST(RepairSurface, TakesAReversedDoubleOfATriangleAway) {
  TriangleSurface surface = box_surface({0, 0, 0}, {1, 1, 1});
  const auto& v = surface.triangles[5];
  add_triangle(surface, surface.vertices[v[0]], surface.vertices[v[2]], surface.vertices[v[1]]);
  expect_mended(surface, ErrorCode::kSelfIntersection, 1);
}

TEST(RepairSurface, TurnsATriangle) {
  TriangleSurface surface = box_surface({0, 0, 0}, {1, 1, 1});
  std::swap(surface.triangles[3][0], surface.triangles[3][1]);
  expect_mended(surface, ErrorCode::kNotWatertight, 1);
}

// A prism whose top has a fold: ten triangles of it cross its neighbours.
TEST(RepairSurface, UnfoldsCrossingTriangles) {
  TriangleSurface surface = prism(20, 1, 0, 1);
  for (Point3& p : surface.vertices) {
    // Two corners of the rim trade places, nearly: the triangles beside them cross.
    if (p.z == 1 && p == turned(Point3{1, 0, 1}, 2 * std::numbers::pi * 3 / 20)) {
      p = turned(Point3{1, 0, 1}, 2 * std::numbers::pi * 4.0004 / 20);
    }
  }
  const CleanSurface before = cleaned(surface, Repair::kNone);
  ASSERT_TRUE(before.problem);
  const CleanSurface clean = cleaned(surface, Repair::kSafe);
  expect_valid(clean);
  EXPECT_NEAR(clean.volume, before.volume, 1e-3);
}

TEST(RepairSurface, WrapsOpenSheetsOnly) {
  TriangleSurface surface = box_surface({0, 0, 0}, {1, 1, 1});
  add_triangle(surface, {2, 0, 0}, {3, 0, 0}, {3, 0, 1});
  add_triangle(surface, {2, 0, 0}, {3, 0, 1}, {2, 0, 1});
  for (const Repair level : {Repair::kSafe, Repair::kAll}) {
    expect_refused(cleaned(surface, level), ErrorCode::kNotWatertight, "repair=wrap");
  }
  constexpr double kTolerance = 5e-3;
  const CleanSurface clean = cleaned(surface, Repair::kWrap, kTolerance);
  expect_valid(clean);
  const double offset = 0.5 * kTolerance * std::sqrt(3.0 * 3 + 1 + 1);
  EXPECT_NEAR(clean.volume, std::pow(1 + 2 * offset, 3) + 2 * offset * (1 + 2 * offset), 0.02);
  ASSERT_EQ(clean.repairs.size(), 1U);
  EXPECT_NE(clean.repairs.front().find("wrapped"), std::string::npos);
}

TEST(RepairSurface, DropsSmallPartsWhenAsked) {
  TriangleSurface surface = box_surface({0, 0, 0}, {1, 1, 1});
  append(surface, box_surface({2, 0, 0}, {2.0005, 0.0005, 0.0005}));
  surface.triangles.pop_back();
  EXPECT_EQ(cleaned(surface, Repair::kAll).shells, 1);
  EXPECT_DOUBLE_EQ(cleaned(surface, Repair::kAll).volume, 1);
}

// A wrap has no hollows: that it filled one is told.
TEST(RepairSurface, WhatAWrapFillsIsTold) {
  constexpr double kTolerance = 5e-3;
  TriangleSurface surface = box_surface({0, 0, 0}, {4, 4, 4});
  add_triangle(surface, {5, 0, 0}, {6, 0, 0},
               {6, 0, 1});  // a sheet: nothing else than wrapping helps
  const auto told = [](const CleanSurface& clean) {
    EXPECT_FALSE(clean.problem);
    return std::ranges::any_of(clean.repairs, [](const std::string& repair) {
      return repair.find("within the wrap is filled") != std::string::npos;
    });
  };
  EXPECT_FALSE(told(cleaned(surface, Repair::kWrap, kTolerance)));
  TriangleSurface hollow = box_surface({1, 1, 1}, {3, 3, 3});
  turn_inside_out(hollow);
  append(surface, hollow);
  EXPECT_TRUE(told(cleaned(surface, Repair::kWrap, kTolerance)));
}

// A body and what may be a hollow reach through each other.
TEST(RepairSurface, LeavesWhatMayBeAHollow) {
  TriangleSurface surface = box_surface({0, 0, 0}, {2, 2, 2}), other = surface;
  for (Point3& p : other.vertices) p = p + Point3{1, 1, 1};
  turn_inside_out(other);
  append(surface, other);
  expect_refused(cleaned(surface, Repair::kSafe), ErrorCode::kSelfIntersection, "hollow");
  const CleanSurface clean = cleaned(surface, Repair::kAll);
  expect_valid(clean);
  EXPECT_NEAR(clean.volume, 15, 1e-12);
}

// A prism over a polygon round the origin, whose corners come in pairs hardly apart.
TriangleSurface prism_of_close_corners(int pairs, double apart) {
  std::vector<Point3> low;
  for (int i = 0; i < pairs; ++i) {
    const double angle = 2 * std::numbers::pi * i / pairs;
    low.push_back(turned(Point3{1, 0, 0}, angle));
    low.push_back(turned(Point3{1, 0, 0}, angle + apart));
  }
  TriangleSurface s;
  const Point3 up{0, 0, 1};
  for (std::size_t i = 0; i < low.size(); ++i) {
    const Point3 a = low[i], b = low[(i + 1) % low.size()];
    add_triangle(s, a, b, b + up);
    add_triangle(s, a, b + up, a + up);
    add_triangle(s, up, a + up, b + up);
    add_triangle(s, {0, 0, 0}, b, a);
  }
  return s;
}

TEST(RepairSurface, CollapsesEdgesFarBelowTheTolerance) {
  constexpr int kPairs = 7;
  const auto points_of = [](double apart, Repair repair) {
    const CleanSurface clean = cleaned(prism_of_close_corners(kPairs, apart), repair, 1e-2);
    expect_valid(clean);
    // It is no mend: the shape is the same to within the tolerance.
    EXPECT_TRUE(clean.repairs.empty());
    EXPECT_LE(clean.joined, 0.11 * 1e-2 * clean.diameter);
    EXPECT_NEAR(clean.volume, 0.5 * kPairs * std::sin(2 * std::numbers::pi / kPairs), 1.5 * apart);
    return clean.surface.points.size();
  };
  constexpr std::size_t kOfAll = 4 * kPairs + 2;
  EXPECT_EQ(points_of(1e-3, Repair::kNone), kOfAll);
  EXPECT_EQ(points_of(1e-3, Repair::kSafe), kOfAll - 2 * kPairs);
  EXPECT_EQ(points_of(1e-2, Repair::kSafe), kOfAll);
}

// A finely divided circle is one of short edges only: no point goes farther than allowed for it.
TEST(RepairSurface, CollapsesNoChains) {
  constexpr int kSides = 2500;
  const CleanSurface clean = cleaned(prism(kSides, 1, 0, 1), Repair::kSafe, 1e-2);
  expect_valid(clean);
  EXPECT_GT(clean.joined, 0);
  EXPECT_NEAR(clean.volume, std::numbers::pi, 2 * std::numbers::pi * clean.joined);
  for (const Point3& p : clean.surface.points) {
    const double r = std::hypot(p.x, p.y);
    EXPECT_TRUE(r < 1e-12 || std::abs(r - 1) < 1e-12);
  }
}

TEST(RepairSurface, HeedsCancelling) {
  TriangleSurface surface = box_surface({0, 0, 0}, {1, 1, 1});
  append(surface, box_surface({0.5, 0.5, 0.5}, {1.5, 1.5, 1.5}));
  for (const Repair level : {Repair::kSafe, Repair::kWrap}) {
    ExecutionContext context;
    context.cancel();
    const auto clean = clean_surface(surface, context, kSurfaceSymmetryToleranceRel, level);
    ASSERT_FALSE(clean);
    EXPECT_EQ(clean.error().code, ErrorCode::kCancelled);
  }
}

struct RandomBox {
  Point3 low, high;
  double angle;

  [[nodiscard]] bool contains(Point3 p) const {
    const Point3 q = turned(p, -angle);
    return q.x >= low.x && q.x <= high.x && q.y >= low.y && q.y <= high.y && q.z >= low.z &&
           q.z <= high.z;
  }
};

// None wholly inside another, which would be a hollow.
std::vector<RandomBox> random_boxes(Random& random, bool aligned) {
  std::vector<RandomBox> boxes;
  const auto range = [&](double& low, double& high) {
    // On a grid, so that many faces lie in one plane.
    const auto place = [&] {
      return aligned ? std::floor(6 * random.uniform()) / 4 : 1.5 * random.uniform();
    };
    low = place();
    high = low + 0.25 + place() / 2;
  };
  const auto within = [](const RandomBox& a, const RandomBox& b) {
    bool all = true;
    for (int i = 0; i < 8; ++i) {
      const Point3 corner{(i & 1) != 0 ? a.low.x : a.high.x, (i & 2) != 0 ? a.low.y : a.high.y,
                          (i & 4) != 0 ? a.low.z : a.high.z};
      all &= b.contains(turned(corner, a.angle));
    }
    return all;
  };
  while (boxes.size() < 5) {
    RandomBox box{};
    range(box.low.x, box.high.x);
    range(box.low.y, box.high.y);
    range(box.low.z, box.high.z);
    box.angle = aligned ? 0 : 2 * std::numbers::pi * random.uniform();
    const bool nested = std::any_of(boxes.begin(), boxes.end(), [&](const RandomBox& b) {
      return within(b, box) || within(box, b);
    });
    if (!nested) boxes.push_back(box);
  }
  return boxes;
}

// By the cells that all coordinates make.
double union_volume(const std::vector<RandomBox>& boxes) {
  std::vector<double> x, y, z;
  for (const RandomBox& b : boxes) {
    x.insert(x.end(), {b.low.x, b.high.x});
    y.insert(y.end(), {b.low.y, b.high.y});
    z.insert(z.end(), {b.low.z, b.high.z});
  }
  for (auto* axis : {&x, &y, &z}) std::sort(axis->begin(), axis->end());
  double volume = 0;
  for (std::size_t i = 1; i < x.size(); ++i) {
    for (std::size_t j = 1; j < y.size(); ++j) {
      for (std::size_t k = 1; k < z.size(); ++k) {
        const Point3 middle{(x[i] + x[i - 1]) / 2, (y[j] + y[j - 1]) / 2, (z[k] + z[k - 1]) / 2};
        const bool inside = std::any_of(boxes.begin(), boxes.end(),
                                        [&](const RandomBox& b) { return b.contains(middle); });
        if (inside) volume += (x[i] - x[i - 1]) * (y[j] - y[j - 1]) * (z[k] - z[k - 1]);
      }
    }
  }
  return volume;
}

TEST(RepairSurface, UnionsOfRandomBoxesHaveTheirVolume) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed);
    const std::vector<RandomBox> boxes = random_boxes(random, true);
    TriangleSurface surface;
    for (const RandomBox& b : boxes) append(surface, box_surface(b.low, b.high));
    const CleanSurface clean = cleaned(surface, Repair::kSafe);
    SCOPED_TRACE(seed);
    expect_valid(clean);
    EXPECT_NEAR(clean.volume, union_volume(boxes), 1e-4);
  }
}

TEST(RepairSurface, UnionsOfTurnedBoxesHaveTheirVolume) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(100 + seed);
    const std::vector<RandomBox> boxes = random_boxes(random, false);
    TriangleSurface surface;
    for (const RandomBox& b : boxes) append(surface, turned(box_surface(b.low, b.high), b.angle));
    const CleanSurface clean = cleaned(surface, Repair::kSafe);
    SCOPED_TRACE(seed);
    expect_valid(clean);
    constexpr int kSamples = 200'000;
    const Point3 size = clean.box.high - clean.box.low;
    int inside = 0;
    for (int i = 0; i < kSamples; ++i) {
      const Point3 p = clean.box.low + Point3{size.x * random.uniform(), size.y * random.uniform(),
                                              size.z * random.uniform()};
      inside += std::any_of(boxes.begin(), boxes.end(),
                            [&](const RandomBox& b) { return b.contains(p); });
    }
    const double whole = size.x * size.y * size.z;
    const double share = static_cast<double>(inside) / kSamples;
    // Five standard deviations.
    EXPECT_NEAR(clean.volume, share * whole, 5 * whole * std::sqrt(share * (1 - share) / kSamples));
  }
}

}  // namespace
}  // namespace symcell::solid
