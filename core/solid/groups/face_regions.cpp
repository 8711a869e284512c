#include "core/solid/groups/face_regions.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "core/base/index.hpp"
#include "core/base/union_find.hpp"
#include "core/geometry/rotation.hpp"

namespace symcell::solid {
namespace {

// A triangle no higher than so many times the noise has a normal that is off by more than some degrees.
constexpr double kThinNoises = 20;
// Of a face so many triangles are turned to see which face they meet; more say the same.
constexpr std::size_t kMostTurned = 2000;
// Cosine: triangles that look another way by more than 60 degrees are no copies.
constexpr double kSameWay = 0.5;
// Limits are looked at every so many triangles.
constexpr std::size_t kCheckedEach = 4096;

struct Side {
  double turn;    // radians
  double length;  // of the edge
  std::int32_t a, b;
};

// The numbers of the classes' roots, made 0, 1, ... in the order of the triangles.
FaceRegions numbered(UnionFind& classes, std::size_t triangles) {
  FaceRegions regions;
  regions.of_triangle.assign(triangles, -1);
  for (std::size_t t = 0; t < triangles; ++t) {
    const std::size_t root = at(classes.root(static_cast<std::int32_t>(t)));
    // A root is the first of its class.
    if (root == t) regions.of_triangle[t] = regions.count++;
    regions.of_triangle[t] = regions.of_triangle[root];
  }
  return regions;
}

double turn_between(Point3 a, Point3 b) {
  return std::atan2(length(cross(a, b)), dot(a, b));
}

}  // namespace

bool is_thin(const IndexedSurface& surface, const Triangle& c, double noise) {
  double longest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    longest =
        std::max(longest, distance(surface.points[at(c[i])], surface.points[at(c[(i + 1) % 3])]));
  }
  return length(area_normal(surface, c)) <= kThinNoises * noise * longest;
}

FaceRegions find_face_regions(const IndexedSurface& surface,
                              double feature_angle,
                              double noise,
                              std::span<const std::int32_t> names) {
  const std::size_t triangles = surface.triangles.size();
  std::vector<Point3> normals(triangles);
  std::vector<char> thin(triangles, 0);
  for (std::size_t t = 0; t < triangles; ++t) {
    normals[t] = area_normal(surface, surface.triangles[t]);
    thin[t] = is_thin(surface, surface.triangles[t], noise) ? 1 : 0;
  }
  std::vector<Side> sides;
  const std::vector<EdgeUse> uses = sorted_edge_uses(surface.triangles);
  for_each_edge(uses, [&](std::size_t begin, std::size_t end) {
    if (end - begin != 2) return;
    const std::int32_t a = uses[begin].triangle, b = uses[begin + 1].triangle;
    if (!names.empty() && names[at(a)] != names[at(b)]) return;
    const double long_as =
        distance(surface.points[at(uses[begin].low)], surface.points[at(uses[begin].high)]);
    sides.push_back({turn_between(normals[at(a)], normals[at(b)]), long_as, a, b});
  });
  UnionFind classes(triangles);
  for (const Side& s : sides) {
    if (thin[at(s.a)] == 0 && thin[at(s.b)] == 0 && s.turn < feature_angle) classes.join(s.a, s.b);
  }
  // Thin ones go with the neighbour at their longest side, and chains of them with one at their ends.
  std::stable_sort(sides.begin(), sides.end(),
                   [](const Side& x, const Side& y) { return x.length > y.length; });
  std::vector<char> settled(triangles, 0);
  for (std::size_t t = 0; t < triangles; ++t) settled[t] = thin[t] == 0 ? 1 : 0;
  for (const Side& s : sides) {
    const std::size_t a = at(classes.root(s.a)), b = at(classes.root(s.b));
    if (a == b || (thin[at(s.a)] == 0 && thin[at(s.b)] == 0)) continue;
    const bool both = settled[a] != 0 && settled[b] != 0;
    if (both) continue;
    const char now = settled[a] != 0 || settled[b] != 0 ? 1 : 0;
    classes.join(s.a, s.b);
    settled[at(classes.root(s.a))] = now;
  }
  return numbered(classes, triangles);
}

Result<FaceRegions> join_copies(const IndexedSurface& surface,
                                const TriangleTree& tree,
                                FaceRegions regions,
                                std::int32_t fold,
                                double reach,
                                std::span<const std::int32_t> names,
                                ExecutionContext& context) {
  if (fold == 1) return regions;
  const RotationTable rotations(fold);
  std::vector<std::size_t> sizes(at(regions.count), 0);
  for (const std::int32_t r : regions.of_triangle) ++sizes[at(r)];
  std::vector<std::size_t> seen(at(regions.count), 0);
  std::vector<std::map<std::int32_t, double>> met(at(regions.count));  // area by face
  std::int32_t last = -1;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (t % kCheckedEach == 0) {
      SYMCELL_TRY(context.check());
    }
    const std::size_t r = at(regions.of_triangle[t]);
    const std::size_t step = sizes[r] / kMostTurned + 1;
    if (seen[r]++ % step != 0) continue;
    const Triangle& c = surface.triangles[t];
    const Point3 middle = (1.0 / 3) * (surface.points[at(c[0])] + surface.points[at(c[1])] +
                                       surface.points[at(c[2])]);
    const Point3 normal = rotations.rotate(area_normal(surface, c), 1);
    const TriangleTree::Hit hit = tree.nearest(rotations.rotate(middle, 1), reach, last);
    if (hit.triangle < 0) continue;
    if (!names.empty() && names[at(hit.triangle)] != names[t]) continue;
    const Point3 other = area_normal(surface, surface.triangles[at(hit.triangle)]);
    if (dot(normal, other) < kSameWay * length(normal) * length(other)) continue;
    met[r][regions.of_triangle[at(hit.triangle)]] += length(normal);
  }
  UnionFind classes(at(regions.count));
  for (std::size_t r = 0; r < met.size(); ++r) {
    const auto most =
        std::max_element(met[r].begin(), met[r].end(),
                         [](const auto& x, const auto& y) { return x.second < y.second; });
    if (most != met[r].end()) classes.join(static_cast<std::int32_t>(r), most->first);
  }
  const FaceRegions joined = numbered(classes, at(regions.count));
  for (std::int32_t& r : regions.of_triangle) r = joined.of_triangle[at(r)];
  regions.count = joined.count;
  return regions;
}

}  // namespace symcell::solid
