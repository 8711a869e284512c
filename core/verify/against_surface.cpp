#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/geometry/indexed_surface.hpp"
#include "core/geometry/surface_distance.hpp"
#include "core/geometry/triangle_tree.hpp"
#include "core/geometry/winding.hpp"
#include "core/verify/against_model.hpp"

namespace symcell::internal {
namespace {

// What is within the tolerance by less than this share of it may be told as beyond, by looking at all of
// a triangle (DistanceBound): so much more is allowed there.
constexpr double kSlack = 1 + 1.0 / 32;
// Samples of the surface: enough to notice a missing feature that is not much smaller than the
// tolerance in area, few enough to take seconds.
constexpr double kSamples = 100'000;
constexpr std::size_t kSamplesATriangle = 2000;
// Solid angles that are computed to tell what lies within the mesh: a second's work.
constexpr std::size_t kMostSolidAngles = 30'000'000;

using Corners = std::array<Point3, 3>;

// f(Point3) for points spread evenly over a triangle, `count` of them about, one at least.
template <class F>
void each_sample(const Corners& p, std::size_t count, F f) {
  const auto steps = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count))));
  for (std::size_t i = 0; i < steps; ++i) {
    for (std::size_t j = 0; j + i < steps; ++j) {
      const double u = (static_cast<double>(i) + 1.0 / 3) / static_cast<double>(steps);
      const double v = (static_cast<double>(j) + 1.0 / 3) / static_cast<double>(steps);
      f(p[0] + u * (p[1] - p[0]) + v * (p[2] - p[0]));
    }
  }
}

double area_of(const Corners& p) {
  return 0.5 * length(cross(p[1] - p[0], p[2] - p[0]));
}

// A point of the surface, and the side that its triangle looks to.
struct Sample {
  Point3 place;
  Point3 normal;  // of unit length, or zero
};

// The largest distance seen and where; points beyond the tolerance are all that need to be exact.
struct Farthest {
  double tolerance = 0;
  std::size_t beyond = 0;
  double distance = 0;
  std::string where;
  // If not null, points beyond are kept instead of being counted.
  std::vector<Sample>* kept = nullptr;

  // Whether the point is near.
  bool look(const TriangleTree& tree, const Point3& p, const char* what, Point3 normal = {}) {
    const auto near = tree.nearest(p, tolerance);
    if (near.triangle >= 0) {
      distance = std::max(distance, std::sqrt(near.squared));
      return true;
    }
    keep(p, what, normal);
    return false;
  }
  void keep(const Point3& p, const char* what, Point3 normal) {
    if (kept != nullptr) {
      kept->push_back({p, normal});
    } else {
      count(p, what);
    }
  }
  void count(const Point3& p, const char* what) {
    if (beyond++ > 0) return;
    where = std::string(what) + " at (" + shown(p.x) + ", " + shown(p.y) + ", " + shown(p.z) + ")";
  }
  [[nodiscard]] std::string text() const {
    return beyond == 0 ? "farthest " + shown(distance)
                       : where + " is farther than " + shown(tolerance) + "; " +
                             std::to_string(beyond) + " such points";
  }
};

class SurfaceChecker {
 public:
  SurfaceChecker(const FacetedMesh& full,
                 const SurfaceModel& model,
                 double tolerance,
                 Checks& checks)
      : full_(full),
        surface_(model),
        model_(*model.given),
        tolerance_(tolerance),
        checks_(checks) {}

  std::vector<char> run() {
    IndexedSurface outside;
    outside.points = full_.mesh.points;
    std::vector<Triangle>& faces = outside.triangles;
    for (std::size_t g = 0; g < full_.group_count(); ++g) {
      if (full_.sides(g) != 1) continue;
      faces.push_back(full_.first(g).nodes);
      if (!full_.first(g).even) std::swap(faces.back()[1], faces.back()[2]);
    }
    const TriangleTree surface(model_.vertices, model_.triangles);
    const TriangleTree boundary(outside.points, faces);

    Farthest from_mesh{tolerance_, 0, 0, {}, nullptr};
    DistanceBound of_faces(surface, kSlack * tolerance_);
    std::vector<char> seen(full_.mesh.points.size(), 0);
    for (const Triangle& face : faces) {
      Corners p;
      bool near = true;
      for (std::size_t i = 0; i < 3; ++i) {
        const auto at = static_cast<std::size_t>(face[i]);
        p[i] = full_.mesh.points[at];
        if (seen[at]++ == 0) near = from_mesh.look(surface, p[i], "the node") && near;
      }
      near =
          from_mesh.look(surface, (1.0 / 3) * (p[0] + p[1] + p[2]), "the middle of a face") && near;
      if (!near) continue;
      if (const auto beyond = of_faces.beyond(p)) from_mesh.count(*beyond, "a face");
    }
    checks_.add("model.on_surface", from_mesh.beyond == 0, from_mesh.text());

    std::vector<Sample> far;
    Farthest from_surface{tolerance_, 0, 0, {}, &far};
    DistanceBound of_surface(boundary, kSlack * tolerance_);
    double area = 0;
    for (const Triangle& t : model_.triangles) area += area_of(corners(t));
    for (const Triangle& t : model_.triangles) {
      const Corners p = corners(t);
      const Point3 n = cross(p[1] - p[0], p[2] - p[0]);
      const Point3 normal = length(n) > 0 ? (1 / length(n)) * n : Point3{};
      bool near = true;
      const auto look = [&](const Point3& sample) {
        near = from_surface.look(boundary, sample, "the surface", normal) && near;
      };
      for (const Point3& corner : p) look(corner);
      const double share = area > 0 ? kSamples * area_of(p) / area : 1;
      each_sample(p, std::min(static_cast<std::size_t>(share) + 1, kSamplesATriangle), look);
      if (!near) continue;
      if (const auto beyond = of_surface.beyond(p)) {
        from_surface.keep(*beyond, "the surface", normal);
      }
    }
    // Walls between bodies that overlap lie within the solid, and walls of no thickness, where a face lies
    // on another that looks the other way, bound nothing. A fair share of them is looked at.
    const std::size_t step =
        1 + far.size() * (faces.size() + 2 * model_.triangles.size()) / kMostSolidAngles;
    for (std::size_t i = 0; i < far.size(); i += step) {
      if (surface_.crosses && std::abs(winding_number(outside, far[i].place)) > 0.5) continue;
      if (!is_wall(far[i])) continue;
      from_surface.count(far[i].place, "the surface");
    }
    checks_.add("model.covered", from_surface.beyond == 0, from_surface.text());

    check_topology(faces);
    // Inner faces are free, as surfaces have no internal facets.
    return std::vector<char>(full_.group_count(), 0);
  }

 private:
  // Whether the surface has its inside on one side of a sample of it and its outside on the other.
  [[nodiscard]] bool is_wall(const Sample& s) const {
    const Point3 step = tolerance_ * s.normal;
    const double change = winding_number(surface_.welded, s.place + step) -
                          winding_number(surface_.welded, s.place - step);
    return std::abs(change) > 0.5;
  }

  // A mesh with a crack, a void or a missing element is near the surface everywhere and still has
  // another boundary.
  void check_topology(const std::vector<Triangle>& boundary) {
    if (!surface_.manifold) {
      checks_.skip("model.topology", surface_.crosses
                                         ? "the surface intersects itself"
                                         : "the surface is not closed with two triangles at each "
                                           "edge");
      return;
    }
    const auto text = [](const SurfaceTopology& t) {
      return std::to_string(t.shells) + " shells of Euler characteristic " +
             std::to_string(t.euler);
    };
    const SurfaceTopology mesh = topology_of(boundary);
    const SurfaceTopology wanted = topology_of(surface_.welded.triangles);
    checks_.add("model.topology", mesh == wanted,
                "the mesh's boundary has " + text(mesh) + ", the surface " + text(wanted));
  }

  [[nodiscard]] Corners corners(const Triangle& t) const {
    Corners p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = model_.vertices[static_cast<std::size_t>(t[i])];
    return p;
  }

  const FacetedMesh& full_;
  const SurfaceModel& surface_;
  const TriangleSurface& model_;
  double tolerance_;
  Checks& checks_;
};

}  // namespace

std::vector<char> check_model(const FacetedMesh& full,
                              const SurfaceModel& model,
                              double tolerance,
                              double /*diameter*/,
                              Checks& checks) {
  return SurfaceChecker(full, model, tolerance, checks).run();
}

}  // namespace symcell::internal
