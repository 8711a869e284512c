#include "core/solid/groups/label_boundary.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/index.hpp"
#include "core/geometry/rotation.hpp"

namespace symcell::solid {
namespace {

// Where the facet is looked up, in shares of its corners: its middle and near its corners, away from
// its sides, which as a rule lie on edges of the surface.
constexpr std::array<std::array<double, 3>, 4> kPlaces = {
    {{1.0 / 3, 1.0 / 3, 1.0 / 3}, {0.6, 0.2, 0.2}, {0.2, 0.6, 0.2}, {0.2, 0.2, 0.6}}};
// Cosine: of triangles near by that look another way by more than 45 degrees the next one is asked for.
constexpr double kSameWay = 0.7;
// Limits are looked at every so many facets.
constexpr std::size_t kCheckedEach = 1024;
// A place is looked for again from so many sides of a facet, along its normal: the surface round an
// edge looks another way than the facet, and what is right above or below it as a rule does not.
constexpr std::array<double, 2> kAlongNormal = {0.25, -0.25};

class Labels {
 public:
  Labels(const FaceGroups& groups, const IndexedSurface& surface, const TriangleTree& tree)
      : groups_(groups), surface_(surface), tree_(tree) {}

  [[nodiscard]] std::int32_t marker(const std::array<Point3, 3>& p) {
    const Point3 normal = area_normal(p[0], p[1], p[2]);
    const double size = std::sqrt(length(normal));
    const Point3 step = size > 0 ? (size / length(normal)) * normal : Point3{};
    votes_.clear();
    for (std::size_t i = 0; i < kPlaces.size(); ++i) {
      const auto& w = kPlaces[i];
      const Point3 place = w[0] * p[0] + w[1] * p[1] + w[2] * p[2];
      std::int32_t hit = nearest(place);
      for (std::size_t j = 0; j < kAlongNormal.size() && !looks_as(hit, normal); ++j) {
        const std::int32_t other = nearest(place + kAlongNormal[j] * step);
        if (looks_as(other, normal)) hit = other;
      }
      if (hit < 0) continue;
      // The middle decides between equals.
      votes_.push_back(
          {groups_.of_triangle[at(hit)], (looks_as(hit, normal) ? 8 : 1) * (i == 0 ? 1.5 : 1)});
    }
    std::int32_t best = 0;
    double most = 0;
    for (const Vote& v : votes_) {
      double sum = 0;
      for (const Vote& other : votes_) sum += other.group == v.group ? other.weight : 0;
      if (sum > most) best = v.group;
      most = std::max(most, sum);
    }
    return best;
  }

 private:
  struct Vote {
    std::int32_t group;
    double weight;
  };

  [[nodiscard]] std::int32_t nearest(Point3 p) {
    return tree_.nearest(p, std::numeric_limits<double>::max(), last_).triangle;
  }
  [[nodiscard]] bool looks_as(std::int32_t triangle, Point3 normal) const {
    if (triangle < 0) return false;
    const Point3 other = area_normal(surface_, surface_.triangles[at(triangle)]);
    return dot(normal, other) >= kSameWay * length(normal) * length(other);
  }

  const FaceGroups& groups_;
  const IndexedSurface& surface_;
  const TriangleTree& tree_;
  std::vector<Vote> votes_;
  std::int32_t last_ = -1;
};

// Of several markers at a node's orbit the smallest but 0 is its own.
void mark_nodes(SymmetryCellMesh& cell) {
  std::vector<std::int32_t> of_orbit(cell.orbit_points.size(), 0);
  const auto mark = [&](std::int32_t node, std::int32_t marker) {
    std::int32_t& own = of_orbit[at(cell.nodes[at(node)].orbit)];
    if (marker != 0 && (own == 0 || marker < own)) own = marker;
  };
  for (std::size_t b = 0; b < cell.facet_count(); ++b) {
    for (std::size_t i = 0; i < 3; ++i) mark(cell.boundary[3 * b + i], cell.boundary_markers[b]);
  }
  for (std::size_t n = 0; n < cell.nodes.size(); ++n) {
    cell.node_markers[n] = of_orbit[at(cell.nodes[n].orbit)];
  }
}

}  // namespace

Result<void> label_boundary(const FaceGroups& groups,
                            const IndexedSurface& surface,
                            const TriangleTree& tree,
                            SymmetryCellMesh& cell,
                            ExecutionContext& context) {
  cell.marker_names.clear();
  if (groups.groups.empty()) return {};
  for (const FaceGroup& g : groups.groups) cell.marker_names.push_back({g.marker, g.name});
  const RotationTable rotations(cell.fold);
  Labels labels(groups, surface, tree);
  const std::int32_t sectors = groups.named ? cell.fold : 1;
  std::vector<std::int32_t> of_sectors;  // per facet and sector
  bool differ = false;
  for (std::size_t b = 0; b < cell.facet_count(); ++b) {
    if (b % kCheckedEach == 0) {
      SYMCELL_TRY(context.check());
    }
    for (std::int32_t s = 0; s < sectors; ++s) {
      std::array<Point3, 3> p;
      for (std::size_t i = 0; i < 3; ++i) {
        const OrbitVertex v = cell.nodes[at(cell.boundary[3 * b + i])];
        p[i] = rotations.rotate(cell.orbit_points[at(v.orbit)], rotations.reduce(v.exponent + s));
      }
      const std::int32_t marker = labels.marker(p);
      if (s == 0) cell.boundary_markers[b] = marker;
      differ = differ || marker != cell.boundary_markers[b];
      if (sectors > 1) of_sectors.push_back(marker);
    }
  }
  if (differ) cell.sector_boundary_markers = std::move(of_sectors);
  mark_nodes(cell);
  return {};
}

}  // namespace symcell::solid
