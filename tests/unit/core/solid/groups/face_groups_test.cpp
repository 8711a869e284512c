// Faces of surfaces as groups: which there are, what they are called, and that a mesh is marked by them.
#include "core/solid/groups/face_groups.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <random>
#include <string>

#include "core/cell/full_mesh.hpp"
#include "core/mesh_model.hpp"
#include "core/solid/groups/shape_fit.hpp"
#include "core/solid/surface/clean_surface.hpp"
#include "tests/support/surface_builders.hpp"

namespace symcell {
namespace {

using solid::fit_shape;
using solid::ShapeFit;

constexpr double kPi = std::numbers::pi;

// The surface turned from a profile in (r, z), open: `sides` strips of `rows` rows, over `angle`.
IndexedSurface turned(const std::function<Point2(double)>& profile,
                      int sides,
                      int rows,
                      double angle,
                      bool inwards = false) {
  IndexedSurface s;
  for (int i = 0; i <= sides; ++i) {
    const double phi = angle * i / sides;
    for (int j = 0; j <= rows; ++j) {
      const Point2 p = profile(static_cast<double>(j) / rows);
      s.points.push_back({p.x * std::cos(phi), p.x * std::sin(phi), p.y});
    }
  }
  const auto id = [&](int i, int j) { return i * (rows + 1) + j; };
  for (int i = 0; i < sides; ++i) {
    for (int j = 0; j < rows; ++j) {
      s.triangles.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
      s.triangles.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
    }
  }
  if (inwards) {
    for (Triangle& t : s.triangles) std::swap(t[1], t[2]);
  }
  return s;
}

// Anywhere in space, as an STL file in single precision has it.
void move(IndexedSurface& s, AxisFrame frame) {
  for (Point3& p : s.points) {
    const Point3 q = frame.to_model(p);
    p = {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z)};
  }
}

std::vector<std::int32_t> all_of(const IndexedSurface& s) {
  std::vector<std::int32_t> all(s.triangles.size());
  for (std::size_t t = 0; t < all.size(); ++t) all[t] = static_cast<std::int32_t>(t);
  return all;
}

double off_line(Point3 p, Point3 origin, Point3 direction) {
  return length(cross(p - origin, direction));
}

TEST(ShapeFit, KnowsCylindersConesAndSpheresAnywhere) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> in(-1, 1);
  const auto cylinder = [](double t) { return Point2{2.5, 3 * t}; };
  const auto cone = [](double t) { return Point2{1 + 1.5 * t, 3 * t}; };
  const auto ball = [](double t) { return Point2{2 * std::cos(1.2 * t), 2 * std::sin(1.2 * t)}; };
  for (int run = 0; run < 40; ++run) {
    const AxisFrame frame = AxisFrame::of_axis({30 * in(random), 30 * in(random), 30 * in(random)},
                                               {in(random), in(random), in(random) + 1e-3});
    const double size = std::pow(10, 3 * in(random));
    const double angle = run % 2 == 0 ? 2 * kPi : 2.0;
    const bool inwards = run % 3 == 0;
    const auto placed = [&](const std::function<Point2(double)>& profile, int rows) {
      IndexedSurface s = turned(profile, 24, rows, angle, inwards);
      move(s, frame);
      for (Point3& p : s.points) p = size * p;
      return s;
    };
    const double noise = size * 2.5e-7 * 60;
    for (const int rows : {1, 3}) {
      const IndexedSurface s = placed(cylinder, rows);
      const ShapeFit fit = fit_shape(s, all_of(s), noise);
      ASSERT_EQ(fit.kind, FaceKind::kCylinder) << run << ", " << rows;
      EXPECT_NEAR(fit.radius, 2.5 * size, 1e-3 * size);
      EXPECT_EQ(fit.concave, inwards);
      EXPECT_EQ(fit.closes, angle > 4);
      EXPECT_LT(off_line(size * frame.origin, fit.origin, fit.direction), 4e-3 * size);
    }
    for (const int rows : {1, 4}) {
      const IndexedSurface s = placed(cone, rows);
      const ShapeFit fit = fit_shape(s, all_of(s), noise);
      ASSERT_EQ(fit.kind, FaceKind::kCone) << run << ", " << rows;
      EXPECT_NEAR(fit.half_angle, std::atan(0.5), 5e-3);
      EXPECT_NEAR(fit.radius, 2.5 * size, 1e-2 * size);
      EXPECT_EQ(fit.concave, inwards);
    }
    const IndexedSurface s = placed(ball, 8);
    const ShapeFit fit = fit_shape(s, all_of(s), noise);
    ASSERT_EQ(fit.kind, FaceKind::kSphere) << run;
    EXPECT_NEAR(fit.radius, 2 * size, 1e-3 * size);
    EXPECT_LT(distance(fit.origin, size * frame.origin), 4e-3 * size);
  }
}

TEST(ShapeFit, KnowsToriAboutTheAxis) {
  const auto fillet = [](double t) {
    return Point2{5 - std::cos(kPi / 2 * t), std::sin(kPi / 2 * t)};
  };
  const IndexedSurface s = turned(fillet, 36, 6, 2 * kPi);
  const ShapeFit fit = fit_shape(s, all_of(s), 1e-6);
  ASSERT_EQ(fit.kind, FaceKind::kTorus);
  EXPECT_NEAR(fit.radius, 5, 1e-6);
  EXPECT_NEAR(fit.tube_radius, 1, 1e-6);
}

TEST(ShapeFit, CallsNothingByAKindForBeingNearToIt) {
  const auto barrel = [](double t) { return Point2{2 + 0.1 * std::sin(kPi * t), 3 * t}; };
  const auto bent = [](double t) { return Point2{2 + t * t, 3 * t}; };
  for (const auto& profile : {std::function<Point2(double)>(barrel), {bent}}) {
    const IndexedSurface s = turned(profile, 24, 5, 2);
    const FaceKind kind = fit_shape(s, all_of(s), 1e-6).kind;
    EXPECT_NE(kind, FaceKind::kCylinder);
    EXPECT_NE(kind, FaceKind::kCone);
    EXPECT_NE(kind, FaceKind::kPlane);
  }
  // A plate that is bent once lies on many cylinders, and on none with certainty.
  const IndexedSurface plate = turned([](double t) { return Point2{2, 3 * t}; }, 2, 1, 0.6);
  EXPECT_EQ(fit_shape(plate, all_of(plate), 1e-6).kind, FaceKind::kSurface);
}

TEST(ShapeFit, PointsGoToTheNearestOfTheSurface) {
  ShapeFit cone;
  cone.kind = FaceKind::kCone;
  cone.direction = {0, 0, 1};
  cone.half_angle = kPi / 4;
  const Point3 p = project_onto(cone, {2, 0, 1});
  EXPECT_NEAR(p.x, 1.5, 1e-12);
  EXPECT_NEAR(p.z, 1.5, 1e-12);
  ShapeFit cylinder;
  cylinder.kind = FaceKind::kCylinder;
  cylinder.direction = {0, 0, 1};
  cylinder.radius = 3;
  EXPECT_LT(distance(project_onto(cylinder, {1, 0, 7}), {3, 0, 7}), 1e-12);
}

// A bore whose ends are chamfered by less than the feature angle: four places always lie on a circle.
TEST(ShapeFit, AChamferedBoreIsNoTorus) {
  const std::array<Point2, 4> profile{{{2.06, 0}, {2, 0.2}, {2, 1.8}, {2.06, 2}}};
  const auto bore = [&](double t) { return profile[static_cast<std::size_t>(std::lround(3 * t))]; };
  const IndexedSurface s = turned(bore, 36, 3, 2 * kPi, true);
  EXPECT_EQ(fit_shape(s, all_of(s), 1e-6).kind, FaceKind::kSurface);
  // Nor is one whose wall bends no more than its vertices may be off.
  const auto barrel = [](double t) { return Point2{2 + 0.004 * std::sin(kPi * t), 2 * t}; };
  const IndexedSurface bent = turned(barrel, 36, 6, 2 * kPi, true);
  EXPECT_NE(fit_shape(bent, all_of(bent), 1e-6).kind, FaceKind::kTorus);
}

Inspection inspected(const TriangleSurface& surface, const MeshOptions& options) {
  ExecutionContext context;
  auto found = inspect_model(surface, options, context);
  EXPECT_TRUE(found) << (found ? "" : found.error().message);
  return found ? *found : Inspection(SolidInspection{});
}

std::map<std::string, FaceGroup> groups_of(const TriangleSurface& surface,
                                           const MeshOptions& options) {
  std::map<std::string, FaceGroup> by_name;
  const Inspection found = inspected(surface, options);
  for (const FaceGroup& g : std::get<SolidInspection>(found).groups) {
    by_name[g.name] = g;
  }
  return by_name;
}

MeshOptions with_fold(std::int32_t fold) {
  MeshOptions options;
  options.fold = fold;
  options.axis_origin = Point3{0, 0, 0};
  options.axis_direction = Point3{0, 0, 1};
  return options;
}

// What a regular polygon's prism has of a ring.
double polygon_area(int sides, double radius) {
  return 0.5 * sides * radius * radius * std::sin(2 * kPi / sides);
}

TEST(FaceGroups, OfARing) {
  const auto groups = groups_of(ring_surface(48, 4, 2, 3), with_fold(8));
  ASSERT_EQ(groups.size(), 4U);
  ASSERT_TRUE(groups.contains("bore") && groups.contains("rim"));
  const FaceGroup& bore = groups.at("bore");
  EXPECT_EQ(bore.kind, FaceKind::kCylinder);
  EXPECT_TRUE(bore.concave);
  EXPECT_NEAR(*bore.radius, 2, 1e-9);
  EXPECT_NEAR(bore.area, 48 * 4 * std::sin(kPi / 48) * 3, 1e-9);
  EXPECT_NEAR(*groups.at("rim").radius, 4, 1e-9);
  const double flat = polygon_area(48, 4) - polygon_area(48, 2);
  for (const char* name : {"plane_1", "plane_2"}) {
    const FaceGroup& plane = groups.at(name);
    EXPECT_NEAR(plane.area, flat, 1e-9);
    EXPECT_NEAR(std::abs(plane.normal->z), 1, 1e-9);
    EXPECT_NEAR(plane.normal->z, plane.centroid.z > 1 ? 1 : -1, 1e-9);
  }
  std::map<std::int32_t, int> numbers;
  for (const auto& [name, g] : groups) ++numbers[g.marker];
  EXPECT_EQ(numbers.size(), 4U);
  EXPECT_EQ(numbers.begin()->first, 1);
}

TEST(FaceGroups, CopiesAreOneGroup) {
  const TriangleSurface box = box_surface({-1, -1, 0}, {1, 1, 3});
  const auto one = groups_of(box, with_fold(1));
  EXPECT_EQ(one.size(), 6U);
  const auto four = groups_of(box, with_fold(4));
  ASSERT_EQ(four.size(), 3U);
  EXPECT_EQ(four.at("plane_1").faces, 4);
  EXPECT_NEAR(four.at("plane_1").area, 24, 1e-9);
  EXPECT_EQ(four.at("plane_2").faces, 1);
}

TEST(FaceGroups, TheAngleDecides) {
  MeshOptions options = with_fold(4);
  options.feature_angle_deg = 0;
  EXPECT_TRUE(groups_of(box_surface({-1, -1, 0}, {1, 1, 3}), options).empty());
  options = with_fold(10);
  // Sides of a ring of 10 turn by 36 degrees.
  const TriangleSurface ring = ring_surface(10, 4, 2, 3);
  EXPECT_EQ(groups_of(ring, options).size(), 4U);
  EXPECT_EQ(groups_of(ring, options).at("plane_1").faces, 10);
  options.feature_angle_deg = 40;
  EXPECT_TRUE(groups_of(ring, options).contains("bore"));
}

TEST(FaceGroups, OrderAndPlaceOfTrianglesDoNotMatter) {
  PrismShape shape;
  const auto groups = groups_of(asymmetric_prism(shape, 3), with_fold(5));
  std::map<std::string, double> areas;
  for (const auto& [name, g] : groups) areas[name] = g.area;
  TriangleSurface other = asymmetric_prism(shape, 11);
  std::reverse(other.triangles.begin(), other.triangles.end());
  const auto again = groups_of(other, with_fold(5));
  ASSERT_EQ(again.size(), areas.size());
  for (const auto& [name, g] : again) EXPECT_NEAR(g.area, areas[name], 1e-6) << name;
}

struct Measured {
  std::map<std::string, double> areas;  // of the full mesh
  SymmetryCellMesh cell;
};

Measured meshed(const TriangleSurface& surface, const MeshOptions& options) {
  ExecutionContext context;
  Measured measured;
  auto outcome = mesh_model(surface, options, context);
  EXPECT_TRUE(outcome) << (outcome ? "" : outcome.error().message);
  if (!outcome) return measured;
  measured.cell = std::move(outcome->mesh);
  const SymmetryCellMesh& cell = measured.cell;
  const FullMeshView view(cell);
  std::map<std::int32_t, std::string> names;
  for (const MarkerName& n : cell.marker_names) names[n.marker] = n.name;
  const auto corners = static_cast<std::size_t>(cell.nodes_per_facet);
  for (std::size_t b = 0; b < cell.facet_count(); ++b) {
    std::array<Point3, 3> p;
    for (std::size_t i = 0; i < 3; ++i) {
      p[i] = view.cell_node_position(static_cast<std::size_t>(cell.boundary[b * corners + i]));
    }
    const double area = length(area_normal(p[0], p[1], p[2])) / 2;
    for (std::int32_t s = 0; s < cell.fold; ++s) {
      measured.areas[names[cell.boundary_marker(b, s)]] += area;
    }
  }
  return measured;
}

TEST(FaceGroups, MeshesAreMarkedByThem) {
  for (const std::int32_t order : {1, 2}) {
    MeshOptions options = with_fold(8);
    options.max_edge = 0.8;
    options.order = order;
    const TriangleSurface ring = ring_surface(48, 4, 2, 3);
    const auto groups = groups_of(ring, options);
    const Measured mesh = meshed(ring, options);
    ASSERT_EQ(mesh.areas.size(), groups.size());
    for (const auto& [name, g] : groups) {
      EXPECT_NEAR(mesh.areas.at(name), g.area, 5e-3 * g.area) << name;
    }
    // Of two groups at a node the smaller number is its marker.
    EXPECT_GT(std::ranges::count(mesh.cell.node_markers, 1), 0);
  }
}

// A cube with its top named otherwise, one corner of the sides too.
TriangleSurface named_box() {
  TriangleSurface box = box_surface({-1, -1, 0}, {1, 1, 3});
  box.group_names = {"walls", "lid", "door"};
  for (const auto& t : box.triangles) {
    const bool top = std::ranges::all_of(
        t, [&](std::int32_t v) { return box.vertices[static_cast<std::size_t>(v)].z == 3; });
    const bool east = std::ranges::all_of(
        t, [&](std::int32_t v) { return box.vertices[static_cast<std::size_t>(v)].x == 1; });
    box.groups.push_back(top ? 1 : east ? 2 : 0);
  }
  return box;
}

TEST(FaceGroups, NamesOfTheFileAreGroups) {
  const TriangleSurface box = named_box();
  const auto groups = groups_of(box, with_fold(4));
  ASSERT_EQ(groups.size(), 3U);
  EXPECT_NEAR(groups.at("lid").area, 4, 1e-9);
  EXPECT_NEAR(groups.at("door").area, 6, 1e-9);
  EXPECT_NEAR(groups.at("walls").area, 22, 1e-9);
  EXPECT_EQ(groups.at("lid").kind, FaceKind::kPlane);
  MeshOptions options = with_fold(4);
  options.max_edge = 0.6;
  const Measured mesh = meshed(box, options);
  // The door is in one sector only.
  EXPECT_FALSE(mesh.cell.sector_boundary_markers.empty());
  EXPECT_NEAR(mesh.areas.at("lid"), 4, 1e-9);
  EXPECT_NEAR(mesh.areas.at("door"), 6, 1e-9);
  EXPECT_NEAR(mesh.areas.at("walls"), 22, 1e-9);
}

TEST(FaceGroups, NamesAndAnAngleDivideTogether) {
  MeshOptions options = with_fold(4);
  options.feature_angle_deg = 30;
  const auto groups = groups_of(named_box(), options);
  EXPECT_TRUE(groups.contains("lid"));
  EXPECT_TRUE(groups.contains("door"));
  EXPECT_FALSE(groups.contains("walls"));
  EXPECT_TRUE(groups.contains("walls_plane_1"));
}

// A gear with teeth of three chords at the tip and at the root, filled to the axis.
TriangleSurface gear(int teeth, double tip, double root) {
  TriangleSurface s;
  s.vertices = {{0, 0, 0}, {0, 0, 2}};
  std::vector<Point2> outline;
  for (int i = 0; i < teeth; ++i) {
    for (int j = 0; j < 8; ++j) {
      const double r = j < 4 ? tip : root, phi = 2 * kPi * (i + j / 8.0) / teeth;
      outline.push_back({r * std::cos(phi), r * std::sin(phi)});
    }
  }
  const auto n = static_cast<std::int32_t>(outline.size());
  for (const double z : {0.0, 2.0}) {
    for (const Point2& p : outline) s.vertices.push_back({p.x, p.y, z});
  }
  for (std::int32_t i = 0; i < n; ++i) {
    const std::int32_t a = 2 + i, b = 2 + (i + 1) % n;
    s.triangles.push_back({0, b, a});
    s.triangles.push_back({1, a + n, b + n});
    s.triangles.push_back({a, b, b + n});
    s.triangles.push_back({a, b + n, a + n});
  }
  return s;
}

TEST(FaceGroups, ToothTipsAreTheRimTogether) {
  const auto groups = groups_of(gear(12, 5, 4), with_fold(12));
  ASSERT_TRUE(groups.contains("rim"));
  EXPECT_EQ(groups.at("rim").faces, 12);
  EXPECT_NEAR(*groups.at("rim").radius, 5, 1e-9);
  ASSERT_TRUE(groups.contains("cylinder_r4_1"));
  EXPECT_EQ(groups.at("cylinder_r4_1").faces, 12);
}

// Of the names a file gives more than can be groups, the largest parts are.
TEST(FaceGroups, TheLargestOfManyNamesAreGroups) {
  TriangleSurface ring = ring_surface(500, 4, 2, 3);
  for (std::size_t t = 0; t < ring.triangles.size(); ++t) {
    // The first two of eight triangles a side are outside, as ring_surface has them.
    const auto side = static_cast<std::int32_t>(t / 8);
    ring.groups.push_back(t % 8 < 2 ? side : 500);
  }
  for (int side = 0; side < 500; ++side) ring.group_names.push_back("side " + std::to_string(side));
  ring.group_names.push_back("body");
  const auto groups = groups_of(ring, with_fold(1));
  EXPECT_EQ(groups.size(), 400U);
  EXPECT_TRUE(groups.contains("body"));
  ASSERT_TRUE(groups.contains("rest"));
  MeshOptions options = with_fold(1);
  options.sizes = {{SizeRequest::Kind::kGroup, 0, 0.5, "no part"}};
  ExecutionContext context;
  const auto refused = mesh_model(ring, options, context);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("smaller ones are in \"rest\""), std::string::npos)
      << refused.error().message;
}

// Nodes on the axis, at the apex of a cone, have a place on it.
TEST(FaceGroups, AConeIsCurvedUpToItsApex) {
  TriangleSurface cone;
  const int sides = 48, rows = 3;
  const auto add = [&](double r, double z) {
    for (int i = 0; i < sides; ++i) {
      const double phi = 2 * kPi * i / sides;
      cone.vertices.push_back({r * std::cos(phi), r * std::sin(phi), z});
    }
  };
  cone.vertices = {{0, 0, 0}, {0, 0, 3}};
  for (int j = 0; j < rows; ++j) add(2 - 0.6 * j, 0.9 * j);
  const auto id = [&](int i, int j) { return 2 + j * sides + i % sides; };
  for (int i = 0; i < sides; ++i) {
    cone.triangles.push_back({0, id(i + 1, 0), id(i, 0)});
    cone.triangles.push_back({1, id(i, rows - 1), id(i + 1, rows - 1)});
    for (int j = 0; j + 1 < rows; ++j) {
      cone.triangles.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
      cone.triangles.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
    }
  }
  MeshOptions options = with_fold(8);
  options.order = 2;
  options.curved = true;
  options.max_edge = 1;
  ExecutionContext context;
  const auto outcome = mesh_model(cone, options, context);
  ASSERT_TRUE(outcome) << outcome.error().message;
  ASSERT_TRUE(outcome->statistics.curving);
  EXPECT_EQ(outcome->statistics.curving->faces, 2U);
  EXPECT_EQ(outcome->statistics.curving->other_faces, 0U);
  EXPECT_NEAR(outcome->statistics.cell.measure * 8, kPi * 4 * 3 / 3, 1e-3 * kPi * 4);
}

}  // namespace
}  // namespace symcell
