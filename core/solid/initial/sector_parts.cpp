#include "core/solid/initial/sector_parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "core/base/index.hpp"
#include "core/geometry/predicates_3.hpp"
#include "core/geometry/rotation.hpp"

namespace symcell::solid::initial {
namespace {

// The half-faces by which the section's faces bound the wedge from inside; kNoHalfFace: none.
struct SectionSides {
  std::vector<HalfFace> lower;
  std::vector<HalfFace> higher;
};

// Whether the half-face, seen from outside its tetrahedron, lists a, b, c counter-clockwise.
bool shows(const SectorMesh& mesh, TetId t, std::uint32_t i, std::array<std::int32_t, 3> abc) {
  const auto& v = mesh.tets[t];
  for (std::size_t r = 0; r < 3; ++r) {
    if (v[kFaceCorners[i][0]] == abc[r]) return v[kFaceCorners[i][1]] == abc[(r + 1) % 3];
  }
  return false;
}

SectionSides sides_of_section(const CutSection& section, const SectorMesh& mesh) {
  SectionSides sides;
  sides.lower.assign(section.faces.size(), kNoHalfFace);
  sides.higher.assign(section.faces.size(), kNoHalfFace);
  for (TetId t = 0; t < mesh.tets.size(); ++t) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::int32_t l = mesh.label[t][i];
      const std::int32_t low = mesh.lower_section_face(l), high = mesh.higher_section_face(l);
      if (low >= 0 && shows(mesh, t, i, section.faces[at(low)])) sides.lower[at(low)] = 4 * t + i;
      if (high >= 0) {
        const auto& [a, b, c] = section.faces[at(high)];
        const std::array image{section.image[at(a)], section.image[at(c)], section.image[at(b)]};
        if (shows(mesh, t, i, image)) sides.higher[at(high)] = 4 * t + i;
      }
    }
  }
  return sides;
}

struct Part {
  bool outside = false;
  bool reached = false;  // by the search for depths
  bool material = false;
  std::int32_t subdomain = -1;
  std::int32_t hole = -1;    // the seed that decided, by index
  std::int32_t region = -1;  // the same
};

class PartFinder {
 public:
  PartFinder(const Sector& sector, const CutSection& section, const SectorMesh& mesh)
      : sector_(sector), mesh_(mesh), sides_(sides_of_section(section, mesh)) {}

  Result<SectorParts> find(ExecutionContext& context) {
    flood();
    SYMCELL_TRY(context.check());
    if (sector_.nesting_decides) {
      SYMCELL_TRY(material_by_nesting());
    } else {
      for (Part& p : parts_) p.material = !p.outside;
    }
    SYMCELL_TRY(apply_holes(context));
    SectorParts result;
    result.subdomains.emplace_back();
    SYMCELL_TRY(apply_regions(context, result.subdomains));
    bool any = false;
    for (TetId t = 0; t < mesh_.tets.size(); ++t) {
      const Part& p = parts_[at(part_[t])];
      result.subdomain.push_back(p.material ? std::max(p.subdomain, 0) : -1);
      any = any || p.material;
    }
    if (!any) {
      return fail(ErrorCode::kTetrahedralizationFailed,
                  "tetrahedralization of the sector: its boundary encloses no space");
    }
    return result;
  }

 private:
  // The half-face on the other side, across the section too; kNoHalfFace where there is none.
  [[nodiscard]] HalfFace across(TetId t, std::uint32_t i) const {
    const std::int32_t l = mesh_.label[t][i];
    if (const std::int32_t s = mesh_.lower_section_face(l); s >= 0) {
      return sides_.lower[at(s)] == 4 * t + i ? sides_.higher[at(s)] : kNoHalfFace;
    }
    if (const std::int32_t s = mesh_.higher_section_face(l); s >= 0) {
      return sides_.higher[at(s)] == 4 * t + i ? sides_.lower[at(s)] : kNoHalfFace;
    }
    return mesh_.nb[t][i];
  }

  void flood() {
    part_.assign(mesh_.tets.size(), -1);
    std::vector<TetId> stack;
    for (TetId seed = 0; seed < mesh_.tets.size(); ++seed) {
      if (part_[seed] >= 0) continue;
      const auto id = static_cast<std::int32_t>(parts_.size());
      parts_.emplace_back();
      part_[seed] = id;
      stack.push_back(seed);
      while (!stack.empty()) {
        const TetId t = stack.back();
        stack.pop_back();
        for (std::uint32_t i = 0; i < 4; ++i) {
          if (mesh_.on_sector_face(mesh_.label[t][i])) continue;
          const HalfFace other = across(t, i);
          if (other == kNoHalfFace) {
            parts_.back().outside = true;
          } else if (part_[tet_of(other)] < 0) {
            part_[tet_of(other)] = id;
            stack.push_back(tet_of(other));
          }
        }
      }
    }
  }

  // Parts beyond the facets of each part; -1 stands for what lies beyond the convex hull.
  Result<void> material_by_nesting() {
    std::vector<std::vector<std::int32_t>> beyond(parts_.size());
    std::vector<std::int32_t> layer;
    for (TetId t = 0; t < mesh_.tets.size(); ++t) {
      for (std::uint32_t i = 0; i < 4; ++i) {
        if (!mesh_.on_sector_face(mesh_.label[t][i])) continue;
        const HalfFace other = mesh_.nb[t][i];
        Part& part = parts_[at(part_[t])];
        if (other != kNoHalfFace) {
          beyond[at(part_[t])].push_back(part_[tet_of(other)]);
        } else if (!part.reached) {
          // A face of the hull: depth one.
          part.reached = part.material = true;
          layer.push_back(part_[t]);
        }
      }
    }
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      if (!parts_[p].outside) continue;
      parts_[p].reached = true;
      parts_[p].material = false;
      layer.push_back(static_cast<std::int32_t>(p));
    }
    for (std::size_t i = 0; i < layer.size(); ++i) {
      const Part& part = parts_[at(layer[i])];
      for (const std::int32_t b : beyond[at(layer[i])]) {
        if (!parts_[at(b)].reached) {
          parts_[at(b)].reached = true;
          parts_[at(b)].material = !part.material;
          layer.push_back(b);
        } else if (parts_[at(b)].material == part.material) {
          return fail(ErrorCode::kTetrahedralizationFailed,
                      "tetrahedralization of the sector: its shells are not closed");
        }
      }
    }
    return {};
  }

  // The tetrahedron at the seed's image in the wedge; none if it lies beyond the convex hull.
  [[nodiscard]] std::optional<TetId> locate(Point3 p) const {
    const double theta = 2 * std::numbers::pi / sector_.fold;
    const double turns = (std::atan2(p.y, p.x) - sector_.start_angle) / theta;
    const RotationTable rotations(sector_.fold);
    const auto copy = static_cast<std::int64_t>(std::floor(turns));
    // A seed near a cut may fall to either side.
    const std::array copies{copy, copy - 1, copy + 1};
    const std::size_t count = sector_.fold == 1 ? 1 : copies.size();
    for (std::size_t i = 0; i < count; ++i) {
      const Point3 image = rotations.rotate(p, rotations.reduce(-copies[i]));
      for (TetId t = 0; t < mesh_.tets.size(); ++t) {
        if (contains(t, image)) return t;
      }
    }
    std::optional<TetId> found;
    double best = -kRounding;
    for (std::size_t i = 0; i < count; ++i) {
      const Point3 image = rotations.rotate(p, rotations.reduce(-copies[i]));
      for (TetId t = 0; t < mesh_.tets.size(); ++t) {
        const double inside = least_barycentric(t, image, best);
        if (inside <= best) continue;
        best = inside;
        found = t;
      }
    }
    return found;
  }

  [[nodiscard]] std::array<Point3, 4> corners(TetId t) const {
    std::array<Point3, 4> c;
    for (std::size_t i = 0; i < 4; ++i) c[i] = mesh_.points[at(mesh_.tets[t][i])];
    return c;
  }

  // Flat tetrahedra lie before coplanar facets of the hull and before the section, beyond the
  // model: a seed in one is a seed beside it.
  [[nodiscard]] static bool is_flat(const std::array<Point3, 4>& c) {
    constexpr double kFlatRelative = 1e-9;  // 6 V / longest edge^3
    double longest2 = 0;
    for (const auto& [i, j] : kEdgeCorners) {
      longest2 = std::max(longest2, squared_distance(c[i], c[j]));
    }
    const double volume = dot(cross(c[1] - c[0], c[2] - c[0]), c[3] - c[0]);
    return !(volume > kFlatRelative * longest2 * std::sqrt(longest2));
  }

  [[nodiscard]] bool contains(TetId t, Point3 p) const {
    const std::array<Point3, 4> c = corners(t);
    for (std::size_t i = 0; i < 4; ++i) {
      const auto& f = kFaceCorners[i];
      if (orientation_3(c[f[0]], c[f[2]], c[f[1]], p) == Sign::kNegative) return false;
    }
    return !is_flat(c);
  }

  // An image is off by the rounding of one rotation, and beside the cut may be in no tetrahedron:
  // barycentric coordinates change by less than this.
  static constexpr double kRounding = 1e-9;

  [[nodiscard]] double least_barycentric(TetId t, Point3 p, double enough) const {
    const std::array<Point3, 4> c = corners(t);
    if (is_flat(c)) return -1;
    const double volume = dot(cross(c[1] - c[0], c[2] - c[0]), c[3] - c[0]);
    double least = 1;
    for (std::size_t i = 0; i < 4 && least > enough; ++i) {
      const Point3 a = c[kFaceCorners[i][0]], b = c[kFaceCorners[i][1]], d = c[kFaceCorners[i][2]];
      least = std::min(least, dot(cross(b - a, d - a), a - p) / volume);
    }
    return least;
  }

  Result<void> apply_holes(ExecutionContext& context) {
    for (std::size_t h = 0; h < sector_.holes.size(); ++h) {
      SYMCELL_TRY(context.check());
      const auto t = locate(sector_.holes[h]);
      if (!t || parts_[at(part_[*t])].outside) return unreachable("holes", h);
      Part& part = parts_[at(part_[*t])];
      part.material = false;
      if (part.hole < 0) part.hole = static_cast<std::int32_t>(h);
    }
    return {};
  }

  Result<void> apply_regions(ExecutionContext& context, std::vector<Subdomain>& subdomains) {
    for (std::size_t r = 0; r < sector_.regions.size(); ++r) {
      SYMCELL_TRY(context.check());
      const SectorRegion& region = sector_.regions[r];
      const auto t = locate(region.point);
      if (!t || (!parts_[at(part_[*t])].material && parts_[at(part_[*t])].hole < 0)) {
        return unreachable("regions", r);
      }
      Part& part = parts_[at(part_[*t])];
      if (part.hole >= 0) return conflicting("holes", part.hole, r);
      if (part.region < 0) {
        part.region = static_cast<std::int32_t>(r);
        part.subdomain = subdomain_of(region, subdomains);
        continue;
      }
      const SectorRegion& first = sector_.regions[at(part.region)];
      if (first.attribute == region.attribute && first.max_volume == region.max_volume) continue;
      if (!sector_.ignore_markers) return conflicting("regions", part.region, r);
      // Copies may differ: the mesh is one for all and takes the smallest bound.
      SectorRegion both = region;
      both.attribute = first.attribute;
      both.max_volume = std::min(region.max_volume, subdomains[at(part.subdomain)].max_volume);
      part.subdomain = subdomain_of(both, subdomains);
    }
    return {};
  }

  static std::int32_t subdomain_of(const SectorRegion& region, std::vector<Subdomain>& subdomains) {
    for (std::size_t s = 0; s < subdomains.size(); ++s) {
      if (subdomains[s].attribute == region.attribute &&
          subdomains[s].max_volume == region.max_volume) {
        return static_cast<std::int32_t>(s);
      }
    }
    subdomains.push_back({region.attribute, region.max_volume});
    return static_cast<std::int32_t>(subdomains.size() - 1);
  }

  [[nodiscard]] static Failure unreachable(const std::string& list, std::size_t i) {
    return fail(ErrorCode::kUnreachableSeed,
                "the seed " + list + "[" + std::to_string(i) +
                    "] lies outside the model or on its boundary; move it into the part it means",
                {static_cast<std::int64_t>(i)}, "/" + list + "/" + std::to_string(i));
  }
  [[nodiscard]] static Failure conflicting(const std::string& list,
                                           std::int32_t first,
                                           std::size_t region) {
    return fail(ErrorCode::kConflictingSeeds,
                list + "[" + std::to_string(first) + "] and regions[" + std::to_string(region) +
                    "] lie in the same part, with no facet between; keep one of them or close the "
                    "facets between them",
                {first, static_cast<std::int64_t>(region)}, "/regions/" + std::to_string(region));
  }

  const Sector& sector_;
  const SectorMesh& mesh_;
  SectionSides sides_;
  std::vector<Part> parts_;
  std::vector<std::int32_t> part_;  // per tetrahedron
};

}  // namespace

Result<SectorParts> find_sector_parts(const Sector& sector,
                                      const CutSection& section,
                                      const SectorMesh& mesh,
                                      ExecutionContext& context) {
  return PartFinder(sector, section, mesh).find(context);
}

}  // namespace symcell::solid::initial
