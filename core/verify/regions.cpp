// Holes and regions of a model against the elements of its full mesh.
#include <algorithm>
#include <limits>

#include "core/verify/against_model.hpp"

namespace symcell::internal {
namespace {

// Rounding of an element's measure against its bound.
constexpr double kMeasureRounding = 1e-9;
constexpr double kNone = std::numeric_limits<double>::infinity();  // no bound

class RegionChecker {
 public:
  RegionChecker(const FacetedMesh& full,
                const std::vector<char>& constrained,
                const std::vector<Point3>& holes,
                const std::vector<RegionSeed>& regions)
      : full_(full),
        mesh_(full.mesh),
        constrained_(constrained),
        holes_(holes),
        regions_(regions),
        parts_(full.mesh.element_count()),
        limit_(full.mesh.element_count(), kNone) {}

  void run(Checks& checks) {
    flood();
    look_at_seeds();
    Flaws large;
    for (std::size_t e = 0; e < mesh_.element_count(); ++e) look_at_measure(e, large);
    holes_found_.report(checks, "model.holes");
    seeds_.report(checks, "model.regions");
    borders_.report(checks, "model.region_borders");
    large.report_beyond_bound(checks, "model.region_measure");
  }

 private:
  // Subdomains are what hangs together without crossing a constraint.
  void flood() {
    for (std::size_t g = 0; g < full_.group_count(); ++g) {
      if (full_.sides(g) != 2 || constrained_[g] != 0) continue;
      const auto a = static_cast<std::size_t>(full_.first(g).element);
      const auto b = static_cast<std::size_t>(full_.second(g).element);
      parts_.join(static_cast<std::int32_t>(a), static_cast<std::int32_t>(b));
      if (mesh_.regions[a] == mesh_.regions[b]) continue;
      borders_.note([&] {
        return "the region changes across " + facet_name(full_.first(g).nodes) +
               ", where the model has nothing";
      });
    }
  }

  void look_at_seeds() {
    std::vector<Point3> points = holes_;
    for (const RegionSeed& seed : regions_) points.push_back(seed.point);
    std::vector<char> found(points.size(), 0);
    each_holding_element(mesh_, points, [&](std::size_t i, std::size_t e) {
      found[i] = 1;
      if (i < holes_.size()) {
        holes_found_.note([&] {
          return "element " + std::to_string(e) + " covers the seed of hole " + std::to_string(i);
        });
      } else {
        look_at_region(i - holes_.size(), e);
      }
    });
    for (std::size_t i = holes_.size(); i < found.size(); ++i) {
      if (found[i] != 0) continue;
      seeds_.note(
          [&] { return "no element at the seed of region " + std::to_string(i - holes_.size()); });
    }
  }

  void look_at_region(std::size_t region, std::size_t element) {
    const RegionSeed& seed = regions_[region];
    double& limit =
        limit_[static_cast<std::size_t>(parts_.root(static_cast<std::int32_t>(element)))];
    limit = std::min(limit, seed.max_measure);
    if (mesh_.regions[element] == seed.attribute) return;
    seeds_.note([&] {
      return "element " + std::to_string(element) + " at the seed of region " +
             std::to_string(region) + " has attribute " + std::to_string(mesh_.regions[element]);
    });
  }

  void look_at_measure(std::size_t e, Flaws& large) {
    const double limit =
        limit_[static_cast<std::size_t>(parts_.root(static_cast<std::int32_t>(e)))];
    if (limit == kNone) return;
    const std::array<Point3, 4> p = corners_of(mesh_, e);
    const Point3 normal = cross(p[1] - p[0], p[2] - p[0]);
    const double size = mesh_.dimension == 2 ? 0.5 * normal.z : dot(normal, p[3] - p[0]) / 6;
    if (size <= limit * (1 + kMeasureRounding)) return;
    large.note([&] {
      return "element " + std::to_string(e) + " measures " + shown(size) +
             ", more than its region's " + shown(limit);
    });
  }

  const FacetedMesh& full_;
  const MeshData& mesh_;
  const std::vector<char>& constrained_;
  const std::vector<Point3>& holes_;
  const std::vector<RegionSeed>& regions_;
  UnionFind parts_;
  std::vector<double> limit_;  // at the roots
  Flaws holes_found_, seeds_, borders_;
};

}  // namespace

void check_regions(const FacetedMesh& full,
                   const std::vector<char>& constrained,
                   const std::vector<Point3>& holes,
                   const std::vector<RegionSeed>& regions,
                   Checks& checks) {
  RegionChecker(full, constrained, holes, regions).run(checks);
}

}  // namespace symcell::internal
