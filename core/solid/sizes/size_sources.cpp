#include "core/solid/sizes/size_sources.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "core/model/describe.hpp"

namespace symcell::solid {
namespace {

// Turns of less, in radians, are noise and not curvature.
constexpr double kLeastTurn = 0.01;
// Names in a message.
constexpr std::size_t kMostListed = 30;

std::size_t at(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

std::string listed(const std::vector<MarkerName>& names) {
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kMostListed); ++i) {
    text += (i == 0 ? "" : ", ") + names[i].name;
  }
  return text + (names.size() > kMostListed ? ", ..." : "");
}

class Sources {
 public:
  Sources(const SizedModel& model, const MeshOptions& options) : model_(model), options_(options) {}

  Result<std::vector<SizeSource>> find() {
    for (const SizeRequest& s : options_.sizes) {
      switch (s.kind) {
        case SizeRequest::Kind::kMarker: SYMCELL_TRY(add_marker(s.id, s.size)); break;
        case SizeRequest::Kind::kGroup: SYMCELL_TRY(add_group(s)); break;
        case SizeRequest::Kind::kVertex: SYMCELL_TRY(add_vertex(s)); break;
        case SizeRequest::Kind::kPoint: add_point(s.point, s.size); break;
        case SizeRequest::Kind::kRegion: break;
      }
    }
    return std::move(sources_);
  }

 private:
  static Failure refuse(const std::string& what) {
    return fail(ErrorCode::kBadOption, "sizes: " + what, {}, "/options/sizes");
  }

  Result<void> add_marker(std::int64_t marker, double size) {
    const std::size_t before = sources_.size();
    for (std::size_t t = 0; t < model_.markers.size(); ++t) {
      if (model_.markers[t] != marker) continue;
      const Triangle& c = model_.surface.triangles[t];
      sources_.push_back({{model_.surface.points[at(c[0])], model_.surface.points[at(c[1])],
                           model_.surface.points[at(c[2])]},
                          size});
    }
    if (sources_.size() > before) return {};
    return refuse("no facet has the marker " + std::to_string(marker) + known());
  }

  Result<void> add_group(const SizeRequest& s) {
    const auto name = std::find_if(model_.names.begin(), model_.names.end(),
                                   [&](const MarkerName& n) { return n.name == s.group; });
    if (name != model_.names.end()) return add_marker(name->marker, s.size);
    return refuse("there is no group \"" + s.group + "\"" + known());
  }

  [[nodiscard]] std::string known() const {
    if (!model_.names.empty()) return "; the groups are " + listed(model_.names);
    const std::set<std::int32_t> markers(model_.markers.begin(), model_.markers.end());
    std::string text;
    for (const std::int32_t m : markers) {
      if (m != 0) text += (text.empty() ? "; the markers are " : ", ") + std::to_string(m);
    }
    return text.empty() ? std::string("; the model has no groups") : text;
  }

  Result<void> add_vertex(const SizeRequest& s) {
    if (s.id < 0 || s.id >= static_cast<std::int64_t>(model_.vertices.size())) {
      return refuse("there is no vertex " + std::to_string(s.id) + "; the model has " +
                    std::to_string(model_.vertices.size()) + ", counted from 0");
    }
    add_point(model_.vertices[static_cast<std::size_t>(s.id)], s.size);
    return {};
  }

  void add_point(Point3 p, double size) {
    const Point3 local = model_.frame.to_local(p);
    sources_.push_back({{local, local, local}, size});
  }

  const SizedModel& model_;
  const MeshOptions& options_;
  std::vector<SizeSource> sources_;
};

// Longest chord whose middle is within that share of the radius from the arc.
double longest_chord(double radius, double error_rel) {
  return 2 * radius * std::sqrt(error_rel * (2 - error_rel));
}

// Per triangle the radius that the surface turns with at its sides; kInfinity where it is flat.
std::vector<double> turning_radii(const IndexedSurface& s, const FaceGroups& groups) {
  std::vector<double> radii(s.triangles.size(), kInfinity);
  const std::vector<EdgeUse> uses = sorted_edge_uses(s.triangles);
  for_each_edge(uses, [&](std::size_t begin, std::size_t end) {
    if (end - begin != 2) return;
    const std::int32_t a = uses[begin].triangle, b = uses[begin + 1].triangle;
    if (groups.of_triangle[at(a)] != groups.of_triangle[at(b)]) return;
    const Point3 n = area_normal(s, s.triangles[at(a)]), m = area_normal(s, s.triangles[at(b)]);
    const double turn = std::atan2(length(cross(n, m)), dot(n, m));
    if (turn < kLeastTurn) return;
    const double side = distance(s.points[at(uses[begin].low)], s.points[at(uses[begin].high)]);
    // Heights over the side: half of each lies between the places where the normals hold.
    const double between = (length(n) + length(m)) / (2 * side);
    for (const std::int32_t t : {a, b}) radii[at(t)] = std::min(radii[at(t)], between / turn);
  });
  return radii;
}

// The smaller radius of curvature of a fitted face at p, for which it is round in the chord's direction.
double radius_at(const ShapeFit& fit, Point3 p) {
  switch (fit.kind) {
    case FaceKind::kCylinder:
    case FaceKind::kSphere: return fit.radius;
    case FaceKind::kTorus: return std::min(fit.tube_radius, fit.radius);
    case FaceKind::kCone: {
      const double along = dot(p - fit.apex, fit.direction);
      // Toward an apex it would go to nothing.
      constexpr double kLeastShare = 0.1;
      return std::max(along * std::tan(fit.half_angle), kLeastShare * fit.radius) /
             std::cos(fit.half_angle);
    }
    case FaceKind::kPlane:
    case FaceKind::kSurface: break;
  }
  return kInfinity;
}

}  // namespace

Result<std::vector<SizeSource>> size_sources(const SizedModel& model, const MeshOptions& options) {
  return Sources(model, options).find();
}

std::vector<SizeSource> of_first_sector(const std::vector<SizeSource>& sources, std::int32_t fold) {
  // Share of a sector: what ends at its bound is taken, for copies come from rotations that round.
  constexpr double kSlack = 1e-6;
  std::vector<SizeSource> first;
  for (const SizeSource& s : sources) {
    const SectorRange range = sectors_of(s, fold);
    const auto meets = [&](double turn) {
      return range.last + turn >= -kSlack && range.first + turn <= 1 + kSlack;
    };
    const bool is_point = s.place[0] == s.place[1] && s.place[0] == s.place[2];
    if (is_point || meets(0) || meets(fold) || meets(-fold)) first.push_back(s);
  }
  return first;
}

std::vector<SizeSource> curvature_sources(const IndexedSurface& surface,
                                          const FaceGroups& groups,
                                          double chord_error_rel) {
  std::vector<SizeSource> sources;
  if (groups.groups.empty()) return sources;
  const std::vector<double> turning = turning_radii(surface, groups);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const std::int32_t group = groups.of_triangle[t];
    if (group == 0) continue;
    const ShapeFit& fit = groups.fits[at(group - 1)];
    const Triangle& c = surface.triangles[t];
    const SizeSource source{
        {surface.points[at(c[0])], surface.points[at(c[1])], surface.points[at(c[2])]}, 0};
    double radius = turning[t];
    if (fit.kind == FaceKind::kPlane) continue;
    if (fit.kind != FaceKind::kSurface) {
      // One face stands for its copies.
      radius = radius_at(fit, (1.0 / 3) * (source.place[0] + source.place[1] + source.place[2]));
    }
    if (!std::isfinite(radius)) continue;
    sources.push_back({source.place, longest_chord(radius, chord_error_rel)});
  }
  return sources;
}

}  // namespace symcell::solid
