#include "core/solid/groups/face_groups.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <string>
#include <utility>

#include "core/base/index.hpp"
#include "core/base/union_find.hpp"
#include "core/geometry/rotation.hpp"
#include "core/geometry/tolerances.hpp"
#include "core/solid/groups/face_regions.hpp"

namespace symcell::solid {
namespace {

// A scan may have a sharp edge at every other triangle, and a file may name each of its parts. The largest so many
// faces are groups.
constexpr std::size_t kMostGroups = 400;
constexpr double kWholeTurnDeg = 360;
// Limits are looked at every so many triangles.
constexpr std::size_t kCheckedEach = 4096;
// An axis is that of symmetry if their directions differ by less, in radians, and their distance is
// within twice the reach of copies.
constexpr double kSameAxis = 5e-3;

// Four digits: 12.5, 0.003.
std::string short_number(double value) {
  std::array<char, 32> text{};
  const auto [end, error] =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 4);
  return error == std::errc{} ? std::string(text.data(), end) : std::string("0");
}

class Grouper {
 public:
  Grouper(const IndexedSurface& surface,
          const TriangleTree& tree,
          const TriangleSurface& given,
          const GroupingOptions& options,
          ExecutionContext& context)
      : surface_(surface), tree_(tree), given_(given), options_(options), context_(context) {}

  Result<FaceGroups> run() {
    if (!given_.cad_faces.empty()) return run_of_cad();
    const bool has_names = given_.group_names.size() > 1;
    if (has_names) {
      SYMCELL_TRY(find_names(given_.groups));
    }
    by_name_ = has_names;
    result_.named = has_names;
    result_.of_triangle.assign(surface_.triangles.size(), 0);
    const double angle =
        options_.feature_angle_deg.value_or(has_names ? 0 : kDefaultFeatureAngleDeg);
    if (angle == 0 && !has_names) return std::move(result_);
    FaceRegions regions;
    if (angle == 0) {
      regions.count = static_cast<std::int32_t>(given_.group_names.size());
      regions.of_triangle = names_;
    } else {
      regions = find_face_regions(surface_, angle * kRadiansADegree, options_.noise, names_);
    }
    SYMCELL_TRY(context_.check());
    pieces_ = angle == 0 ? pieces_by_name() : regions;
    if (angle != 0) {
      auto joined = join_copies(surface_, tree_, std::move(regions), options_.fold, options_.reach,
                                names_, context_);
      if (!joined) return error_of(joined);
      regions = std::move(*joined);
    }
    make_groups(regions);
    name_groups();
    // Parts that the file names hold faces of many shapes.
    if (options_.pieces) fit_pieces(angle == 0 ? pieces_.of_triangle : regions.of_triangle);
    return std::move(result_);
  }

 private:
  // The faces of the file; an angle divides them only where it is asked for. Copies with one name and
  // colour are one group.
  Result<FaceGroups> run_of_cad() {
    result_.of_triangle.assign(surface_.triangles.size(), 0);
    if (options_.feature_angle_deg == 0) return std::move(result_);
    SYMCELL_TRY(find_names(given_.cad_face));
    const double angle = options_.feature_angle_deg.value_or(kWholeTurnDeg) * kRadiansADegree;
    FaceRegions regions = find_face_regions(surface_, angle, options_.noise, names_);
    SYMCELL_TRY(context_.check());
    pieces_ = regions;
    std::map<std::pair<std::string, std::int32_t>, std::int32_t> numbers;
    std::vector<std::int32_t> label_of_face;
    for (const CadFace& face : given_.cad_faces) {
      const auto next = static_cast<std::int32_t>(numbers.size());
      label_of_face.push_back(numbers.try_emplace({face.name, face.colour}, next).first->second);
    }
    std::vector<std::int32_t> labels;
    for (const std::int32_t face : names_) labels.push_back(label_of_face[at(face)]);
    // With one label for all, copies are in one group.
    result_.named = numbers.size() > 1;
    auto joined = join_copies(surface_, tree_, std::move(regions), options_.fold, options_.reach,
                              labels, context_);
    if (!joined) return error_of(joined);
    make_groups(*joined);
    name_groups();
    if (options_.pieces) fit_pieces(joined->of_triangle);
    return std::move(result_);
  }

  // What a group has beside its figures.
  struct Draft {
    double area = 0;
    Point3 moment;  // area times centroid
    std::vector<std::int32_t> triangles;
  };

  // Names of the file, from the nearest triangle of it. Of one sector the copies are looked up.
  Result<void> find_names(const std::vector<std::int32_t>& of_file) {
    IndexedSurface file;
    file.triangles.reserve(given_.triangles.size());
    for (const Point3& p : given_.vertices) file.points.push_back(options_.frame.to_local(p));
    for (const auto& t : given_.triangles) file.triangles.push_back(t);
    const TriangleTree tree(file.points, file.triangles);
    const std::int32_t sectors = options_.sector.value_or(1);
    const RotationTable rotations(sectors);
    const std::int32_t fallback = 0;
    names_.assign(surface_.triangles.size(), fallback);
    std::int32_t last = -1;
    for (std::size_t t = 0; t < surface_.triangles.size(); ++t) {
      if (t % kCheckedEach == 0) {
        SYMCELL_TRY(context_.check());
      }
      const Triangle& c = surface_.triangles[t];
      const Point3 middle = (1.0 / 3) * (surface_.points[at(c[0])] + surface_.points[at(c[1])] +
                                         surface_.points[at(c[2])]);
      TriangleTree::Hit best;
      for (std::int32_t k = 0; k < sectors; ++k) {
        const double reach = std::isfinite(best.squared) ? std::sqrt(best.squared)
                                                         : std::numeric_limits<double>::max();
        const TriangleTree::Hit hit = tree.nearest(rotations.rotate(middle, k), reach, last);
        if (hit.triangle >= 0 && hit.squared < best.squared) best = hit;
      }
      if (best.triangle >= 0) names_[t] = of_file[at(best.triangle)];
    }
    return {};
  }

  // Pieces that hang together within a name.
  [[nodiscard]] FaceRegions pieces_by_name() const {
    return find_face_regions(surface_, 2 * std::numbers::pi, options_.noise, names_);
  }

  void make_groups(const FaceRegions& regions) {
    std::vector<Draft> drafts(at(regions.count));
    for (std::size_t t = 0; t < surface_.triangles.size(); ++t) {
      Draft& d = drafts[at(regions.of_triangle[t])];
      const Triangle& c = surface_.triangles[t];
      const double area = length(area_normal(surface_, c)) / 2;
      d.area += area;
      d.moment = d.moment + (area / 3) * (surface_.points[at(c[0])] + surface_.points[at(c[1])] +
                                          surface_.points[at(c[2])]);
      d.triangles.push_back(static_cast<std::int32_t>(t));
    }
    std::erase_if(drafts, [](const Draft& d) { return d.triangles.empty(); });
    if (!by_name_) {
      std::stable_sort(drafts.begin(), drafts.end(),
                       [](const Draft& a, const Draft& b) { return a.area > b.area; });
    }
    if (drafts.size() > kMostGroups) join_smallest(drafts);
    for (const Draft& d : drafts) add_group(d);
  }

  // The smallest become one, the last; the others stay in their order.
  void join_smallest(std::vector<Draft>& drafts) {
    std::vector<std::size_t> by_area(drafts.size());
    std::iota(by_area.begin(), by_area.end(), std::size_t{0});
    std::stable_sort(by_area.begin(), by_area.end(),
                     [&](std::size_t a, std::size_t b) { return drafts[a].area > drafts[b].area; });
    std::vector<char> is_large(drafts.size(), 0);
    for (std::size_t i = 0; i + 1 < kMostGroups; ++i) is_large[by_area[i]] = 1;
    Draft rest;
    std::vector<Draft> kept;
    for (std::size_t i = 0; i < drafts.size(); ++i) {
      Draft& d = drafts[i];
      if (is_large[i] != 0) {
        kept.push_back(std::move(d));
        continue;
      }
      rest.area += d.area;
      rest.moment = rest.moment + d.moment;
      rest.triangles.insert(rest.triangles.end(), d.triangles.begin(), d.triangles.end());
    }
    kept.push_back(std::move(rest));
    drafts = std::move(kept);
    has_rest_ = true;
  }

  void add_group(const Draft& d) {
    const auto number = static_cast<std::int32_t>(result_.groups.size() + 1);
    // The largest piece stands for all.
    std::map<std::int32_t, double> areas;
    for (const std::int32_t t : d.triangles) {
      result_.of_triangle[at(t)] = number;
      areas[pieces_.of_triangle[at(t)]] += length(area_normal(surface_, surface_.triangles[at(t)]));
    }
    const auto largest =
        std::max_element(areas.begin(), areas.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    std::vector<std::int32_t> own;
    std::int32_t widest = d.triangles.front();
    double most = -1;
    for (const std::int32_t t : d.triangles) {
      if (pieces_.of_triangle[at(t)] != largest->first) continue;
      own.push_back(t);
      const double area = length(area_normal(surface_, surface_.triangles[at(t)]));
      if (area > most) widest = t;
      most = std::max(most, area);
    }
    const bool rest = has_rest_ && at(number) == kMostGroups;
    ShapeFit fit;
    if (!rest) {
      fit = shape_of(own);
      shapes_[largest->first] = fit;
      if (fit.kind == FaceKind::kSurface) fit = shape_of_copies(d.triangles, fit);
    }
    FaceGroup group;
    group.marker = number;
    group.kind = fit.kind;
    group.faces = static_cast<std::int32_t>(areas.size());
    group.area = d.area;
    group.centroid = options_.frame.to_model(d.area > 0 ? (1 / d.area) * d.moment : d.moment);
    const Triangle& c = surface_.triangles[at(widest)];
    group.point =
        options_.frame.to_model((1.0 / 3) * (surface_.points[at(c[0])] + surface_.points[at(c[1])] +
                                             surface_.points[at(c[2])]));
    describe(fit, group);
    if (by_name_) {
      file_name_.push_back(rest ? std::string()
                                : given_.group_names[at(names_[at(d.triangles.front())])]);
    }
    if (!given_.cad_faces.empty()) {
      const CadFace& face = given_.cad_faces[at(names_[at(own.front())])];
      if (!rest) group.colour = face.colour;
      file_name_.push_back(rest ? std::string() : face.name);
    }
    result_.fits.push_back(fit);
    result_.groups.push_back(std::move(group));
  }

  // Of triangles of one face.
  [[nodiscard]] ShapeFit shape_of(const std::vector<std::int32_t>& triangles) const {
    if (!given_.cad_faces.empty()) {
      AnalyticSurface known = given_.cad_faces[at(names_[at(triangles.front())])].surface;
      if (known.kind != FaceKind::kSurface) {
        const Point3 to = options_.frame.to_local(known.origin + known.direction);
        known.origin = options_.frame.to_local(known.origin);
        known.apex = options_.frame.to_local(known.apex);
        known.direction = to - known.origin;
        return complete_shape(known, surface_, triangles, options_.noise);
      }
    }
    return fit_shape(surface_, triangles, options_.noise);
  }

  // Copies of a face of too few chords, as the tips of a gear have, lie on one cylinder about the axis with
  // certainty; else the shape is `alone`.
  [[nodiscard]] ShapeFit shape_of_copies(const std::vector<std::int32_t>& triangles,
                                         const ShapeFit& alone) const {
    if (options_.fold == 1 || !given_.cad_faces.empty()) return alone;
    const ShapeFit all = fit_shape(surface_, triangles, options_.noise);
    return is_on_symmetry_axis(all) ? all : alone;
  }

  // `classes`: per triangle, of copies.
  void fit_pieces(const std::vector<std::int32_t>& classes) {
    std::vector<std::vector<std::int32_t>> triangles(at(pieces_.count));
    for (std::size_t t = 0; t < surface_.triangles.size(); ++t) {
      triangles[at(pieces_.of_triangle[t])].push_back(static_cast<std::int32_t>(t));
    }
    result_.piece_of_triangle = pieces_.of_triangle;
    for (std::size_t piece = 0; piece < triangles.size(); ++piece) {
      const std::vector<std::int32_t>& own = triangles[piece];
      // Of the largest pieces of groups it is known.
      const auto known = shapes_.find(static_cast<std::int32_t>(piece));
      ShapeFit fit;
      if (known != shapes_.end()) {
        fit = known->second;
      } else if (!own.empty()) {
        fit = shape_of(own);
      }
      for (const std::int32_t t : own) {
        for (const std::int32_t v : surface_.triangles[at(t)]) {
          const Point3& p = surface_.points[at(v)];
          if (!(distance(p, project_onto(fit, p)) <= options_.farthest))
            fit.kind = FaceKind::kSurface;
        }
      }
      result_.piece_fits.push_back(fit);
      result_.class_of_piece.push_back(own.empty() ? -1 : classes[at(own.front())]);
    }
  }

  void describe(const ShapeFit& fit, FaceGroup& group) const {
    const auto direction = [&](Point3 d) {
      return options_.frame.to_model(d) - options_.frame.to_model({0, 0, 0});
    };
    if (fit.kind == FaceKind::kSurface) return;
    if (fit.kind == FaceKind::kPlane) {
      group.normal = direction(fit.direction);
      return;
    }
    group.concave = fit.concave;
    group.axis_origin =
        options_.frame.to_model(fit.kind == FaceKind::kCone ? fit.apex : fit.origin);
    group.radius = fit.radius;
    if (fit.kind != FaceKind::kSphere) group.axis_direction = direction(fit.direction);
    if (fit.kind == FaceKind::kTorus) group.tube_radius = fit.tube_radius;
    if (fit.kind == FaceKind::kCone) group.half_angle_deg = fit.half_angle / kRadiansADegree;
  }

  [[nodiscard]] bool is_on_symmetry_axis(const ShapeFit& fit) const {
    if (options_.fold == 1 || fit.kind != FaceKind::kCylinder) return false;
    if (std::hypot(fit.direction.x, fit.direction.y) > kSameAxis) return false;
    const double t = -fit.origin.z / fit.direction.z;
    const Point3 foot = fit.origin + t * fit.direction;
    return std::hypot(foot.x, foot.y) <= 2 * options_.reach + kSameAxis * std::abs(fit.origin.z);
  }

  // What a group's name begins with; the second is true if it is counted even where it is alone.
  [[nodiscard]] std::pair<std::string, bool> stem(std::size_t i, double widest) const {
    const ShapeFit& fit = result_.fits[i];
    switch (fit.kind) {
      case FaceKind::kPlane: return {"plane", true};
      case FaceKind::kCylinder:
        if (is_on_symmetry_axis(fit)) {
          if (fit.concave) return {"bore", false};
          if (fit.radius >= widest) return {"rim", false};
        } else if (fit.concave && fit.closes) {
          return {"hole_r" + short_number(fit.radius), true};
        }
        return {"cylinder_r" + short_number(fit.radius), true};
      case FaceKind::kCone:
        return {"cone_" + short_number(fit.half_angle / kRadiansADegree) + "deg", true};
      case FaceKind::kSphere: return {"sphere_r" + short_number(fit.radius), true};
      case FaceKind::kTorus: return {"torus_r" + short_number(fit.radius), true};
      case FaceKind::kSurface: break;
    }
    return {"surface", true};
  }

  // Of convex cylinders about the axis the widest is the rim.
  [[nodiscard]] double widest_about_axis() const {
    double widest = 0;
    for (const ShapeFit& fit : result_.fits) {
      if (!fit.concave && is_on_symmetry_axis(fit)) widest = std::max(widest, fit.radius);
    }
    constexpr double kAsWide = 1e-6;
    return widest * (1 - kAsWide);
  }

  void name_groups() {
    const double widest = widest_about_axis();
    std::map<std::string, int> counts, uses;
    for (const std::string& name : file_name_) ++uses[name];
    std::set<std::string> taken;
    for (std::size_t i = 0; i < result_.groups.size(); ++i) {
      auto [name, counted] = stem(i, widest);
      if (has_rest_ && i + 1 == kMostGroups) {
        name = kRestOfFaces;
        counted = false;
      }
      if (!file_name_.empty() && !file_name_[i].empty()) {
        const std::string& own = file_name_[i];
        const bool alone = uses[own] == 1;
        name = alone ? own : std::string(own).append("_").append(name);
        counted = !alone && counted;
      }
      std::string full;
      do {
        const int count = ++counts[name];
        full = counted || count > 1 ? name + "_" + std::to_string(count) : name;
      } while (!taken.insert(full).second);
      result_.groups[i].name = full;
    }
  }

  const IndexedSurface& surface_;
  const TriangleTree& tree_;
  const TriangleSurface& given_;
  const GroupingOptions& options_;
  ExecutionContext& context_;
  FaceGroups result_;
  FaceRegions pieces_;
  std::map<std::int32_t, ShapeFit> shapes_;  // of those pieces that stand for a group
  std::vector<std::int32_t> names_;     // per triangle of the surface; empty: the file names none
  std::vector<std::string> file_name_;  // per group; empty: the file names none
  bool by_name_ = false;                // groups are in the order of the file's names
  bool has_rest_ = false;
};

}  // namespace

Result<FaceGroups> find_face_groups(const IndexedSurface& surface,
                                    const TriangleTree& tree,
                                    const TriangleSurface& given,
                                    const GroupingOptions& options,
                                    ExecutionContext& context) {
  return Grouper(surface, tree, given, options, context).run();
}

}  // namespace symcell::solid
