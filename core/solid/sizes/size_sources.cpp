#include "core/solid/sizes/size_sources.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "core/base/index.hpp"
#include "core/model/describe.hpp"

namespace symcell::solid {
namespace {

// Turns of less, in radians, are noise and not curvature.
constexpr double kLeastTurn = 0.01;
// Names in a message.
constexpr std::size_t kMostListed = 30;

std::string listed(const std::vector<MarkerName>& names) {
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kMostListed); ++i) {
    text += (i == 0 ? "" : ", ") + names[i].name;
  }
  return text + (names.size() > kMostListed ? ", ..." : "");
}

// As it is written in the option, but for the word before a group's name.
std::string as_written(const SizeRequest& s) {
  std::string subject;
  switch (s.kind) {
    case SizeRequest::Kind::kMarker: subject = "marker:" + std::to_string(s.id); break;
    case SizeRequest::Kind::kVertex: subject = "vertex:" + std::to_string(s.id); break;
    case SizeRequest::Kind::kRegion: subject = "region:" + std::to_string(s.id); break;
    case SizeRequest::Kind::kGroup: subject = s.group; break;
    case SizeRequest::Kind::kPoint:
      subject = "point:" + describe_number(s.point.x) + "/" + describe_number(s.point.y) + "/" +
                describe_number(s.point.z);
      break;
  }
  return subject + "=" + describe_number(s.size);
}

class Sources {
 public:
  Sources(const SizedModel& model, const MeshOptions& options)
      : model_(model), options_(options), box_(bounding_box(model.surface.points)) {}

  Result<AskedSizes> find() {
    for (const SizeRequest& s : options_.sizes) {
      switch (s.kind) {
        case SizeRequest::Kind::kMarker: SYMCELL_TRY(add_marker(s, s.id)); break;
        case SizeRequest::Kind::kGroup: SYMCELL_TRY(add_group(s)); break;
        case SizeRequest::Kind::kVertex: SYMCELL_TRY(add_vertex(s)); break;
        case SizeRequest::Kind::kPoint: add_point(s, s.point); break;
        case SizeRequest::Kind::kRegion: SYMCELL_TRY(check_region(s)); break;
      }
    }
    if (!idle_.empty()) result_.warnings.push_back(sizes_without_effect_warning(idle_));
    return std::move(result_);
  }

 private:
  // What a size is asked for of: markers by their names are markers.
  using Subject = std::tuple<SizeRequest::Kind, std::int64_t, double, double, double>;

  static Failure refuse(const std::string& what) {
    return fail(ErrorCode::kBadOption, "sizes: " + what, {}, "/options/sizes");
  }

  Result<void> add_marker(const SizeRequest& s, std::int64_t marker) {
    const std::size_t before = result_.sources.size();
    for (std::size_t t = 0; t < model_.markers.size(); ++t) {
      if (model_.markers[t] != marker) continue;
      const Triangle& c = model_.surface.triangles[t];
      result_.sources.push_back({{model_.surface.points[at(c[0])], model_.surface.points[at(c[1])],
                                  model_.surface.points[at(c[2])]},
                                 s.size});
    }
    if (result_.sources.size() == before) {
      return refuse("no facet has the marker " + std::to_string(marker) + known());
    }
    tell_if_idle(s, {SizeRequest::Kind::kMarker, marker, 0, 0, 0}, 0);
    return {};
  }

  Result<void> add_group(const SizeRequest& s) {
    const auto name = std::find_if(model_.names.begin(), model_.names.end(),
                                   [&](const MarkerName& n) { return n.name == s.group; });
    if (name != model_.names.end()) return add_marker(s, name->marker);
    return refuse("there is no group \"" + s.group + "\"" + known());
  }

  [[nodiscard]] std::string known() const {
    if (!model_.names.empty()) {
      const bool rest =
          std::ranges::find(model_.names, kRestOfFaces, &MarkerName::name) != model_.names.end();
      return "; the groups are " + listed(model_.names) +
             (rest ? "; the smaller ones are in \"" + std::string(kRestOfFaces) + "\"" : "");
    }
    const std::set<std::int32_t> markers(model_.markers.begin(), model_.markers.end());
    std::string text;
    for (const std::int32_t m : markers) {
      if (m != 0) text += (text.empty() ? "; the markers are " : ", ") + std::to_string(m);
    }
    return text.empty() ? std::string("; the model has no groups") : text;
  }

  Result<void> check_region(const SizeRequest& s) {
    if (model_.regions.empty()) {
      return refuse("there is no region " + std::to_string(s.id) +
                    "; a surface has none, only complexes of facets (poly, JSON) do");
    }
    if (std::ranges::find(model_.regions, s.id) == model_.regions.end()) {
      std::string text;
      for (std::size_t i = 0; i < std::min(model_.regions.size(), kMostListed); ++i) {
        text += (i == 0 ? "" : ", ") + std::to_string(model_.regions[i]);
      }
      return refuse("there is no region " + std::to_string(s.id) + "; the regions are " + text +
                    (model_.regions.size() > kMostListed ? ", ..." : ""));
    }
    tell_if_idle(s, {s.kind, s.id, 0, 0, 0}, 0);
    return {};
  }

  Result<void> add_vertex(const SizeRequest& s) {
    if (s.id < 0 || s.id >= static_cast<std::int64_t>(model_.vertices.size())) {
      return refuse("there is no vertex " + std::to_string(s.id) + "; the model has " +
                    std::to_string(model_.vertices.size()) + ", counted from 0");
    }
    add_point(s, model_.vertices[static_cast<std::size_t>(s.id)]);
    return {};
  }

  void add_point(const SizeRequest& s, Point3 p) {
    const Point3 local = model_.frame.to_local(p);
    result_.sources.push_back({{local, local, local}, s.size});
    const Point3 nearest{std::clamp(local.x, box_.low.x, box_.high.x),
                         std::clamp(local.y, box_.low.y, box_.high.y),
                         std::clamp(local.z, box_.low.z, box_.high.z)};
    tell_if_idle(s, {SizeRequest::Kind::kPoint, 0, local.x, local.y, local.z},
                 distance(local, nearest));
  }

  // `away`: all of the model is at least as far.
  void tell_if_idle(const SizeRequest& s, const Subject& subject, double away) {
    const double most = std::min(box_.diagonal(), options_.max_edge);
    const double slope =
        (std::isfinite(options_.gradation) ? options_.gradation : kStandardGradation) - 1;
    if (allowed_at(s.size, away, slope) >= most) {
      idle_.push_back(as_written(s) + (away > 0 ? " is too far away" : " is too long"));
      return;
    }
    const auto [other, fresh] = least_.try_emplace(subject, &s);
    if (fresh) return;
    const SizeRequest* shorter = other->second;
    const SizeRequest* longer = &s;
    if (longer->size < shorter->size) std::swap(shorter, longer);
    other->second = shorter;
    idle_.push_back(as_written(*longer) + " beside " + as_written(*shorter));
  }

  const SizedModel& model_;
  const MeshOptions& options_;
  Box3 box_;
  AskedSizes result_;
  std::map<Subject, const SizeRequest*> least_;  // the shortest so far
  std::vector<std::string> idle_;
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

Result<AskedSizes> size_sources(const SizedModel& model, const MeshOptions& options) {
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
