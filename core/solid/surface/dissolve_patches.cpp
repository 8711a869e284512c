#include "core/solid/surface/dissolve_patches.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "core/geometry/indexed_surface.hpp"
#include "core/solid/surface/editable_surface.hpp"

namespace symcell::solid {
namespace {

// Of the boundary, across which the surface is smooth: with more a patch is of a curved part.
constexpr double kSmoothShare = 0.5;
// Of the boundary: a side to a neighbour that counts.
constexpr double kSignificantShare = 0.2;

// A strip narrower than so many deviations is in the way of better triangles.
constexpr double kLeastWidth = 8;
// A corner of a patch below this has no place in a curved part.
constexpr double kSharpCorner = 28 * std::numbers::pi / 180;

// Where a patch goes on smoothly into a neighbour.
struct SmoothSide {
  std::int32_t patch = 0;
  std::int32_t other = -1;  // -1: in no patch
  double length = 0;
  double angle = 0;
};

struct PatchFigures {
  double area = 0;
  double boundary = 0;
  double smooth = 0;  // part of the boundary
  std::int32_t triangles = 0;
  bool given_up = false;

  [[nodiscard]] double width() const { return 2 * area / boundary; }
  [[nodiscard]] bool is_curved_part() const { return smooth > kSmoothShare * boundary; }
};

// `patch` here: an edge-connected part of a planar patch.
struct Survey {
  std::vector<std::int32_t> patch;  // per triangle, -1: none
  std::vector<PatchFigures> patches;
  std::vector<SmoothSide> sides;
};

std::int32_t find_parts(const QuotientSurface& surface,
                        const std::vector<std::array<QuotientNeighbour, 3>>& neighbours,
                        std::vector<std::int32_t>& part) {
  part.assign(surface.triangles.size(), -1);
  std::int32_t count = 0;
  for (std::size_t seed = 0; seed < part.size(); ++seed) {
    if (surface.patch[seed] < 0 || part[seed] >= 0) continue;
    std::vector<std::int32_t> members{static_cast<std::int32_t>(seed)};
    part[seed] = count;
    for (std::size_t k = 0; k < members.size(); ++k) {
      for (const QuotientNeighbour& n : neighbours[members[k]]) {
        if (part[n.triangle] >= 0 || surface.patch[n.triangle] != surface.patch[seed]) continue;
        part[n.triangle] = count;
        members.push_back(n.triangle);
      }
    }
    ++count;
  }
  return count;
}

std::array<Point3, 3> corners_of(const QuotientSurface& s,
                                 const RotationTable& rotations,
                                 std::size_t t) {
  std::array<Point3, 3> p;
  for (std::size_t i = 0; i < 3; ++i) p[i] = corner_point(s, rotations, s.triangles[t][i]);
  return p;
}

Result<Survey> survey(const QuotientSurface& surface) {
  const auto neighbours = find_neighbours(surface);
  if (!neighbours) return error_of(neighbours);
  const RotationTable rotations(surface.fold);
  Survey result;
  const std::int32_t count = find_parts(surface, *neighbours, result.patch);
  result.patches.resize(static_cast<std::size_t>(count));
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const std::int32_t patch = result.patch[t];
    if (patch < 0) continue;
    PatchFigures& f = result.patches[patch];
    ++f.triangles;
    const auto p = corners_of(surface, rotations, t);
    f.area += length(area_normal(p[0], p[1], p[2])) / 2;
    for (std::size_t i = 0; i < 3; ++i) {
      const QuotientNeighbour& n = (*neighbours)[t][i];
      const std::int32_t other = result.patch[n.triangle];
      if (other == patch) continue;
      const double side = distance(p[i], p[(i + 1) % 3]);
      const Point3 normal =
          rotations.rotate(surface.normals[n.triangle], rotations.reduce(n.exponent));
      const double cosine = dot(surface.normals[t], normal);
      f.boundary += side;
      if (cosine < kCreaseCosine) continue;
      f.smooth += side;
      result.sides.push_back({patch, other, side, std::acos(std::min(cosine, 1.0))});
    }
  }
  return result;
}

void give_up(QuotientSurface& surface, const Survey& found) {
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (found.patch[t] < 0) continue;
    const PatchFigures& f = found.patches[found.patch[t]];
    if (f.triangles == 1 || (f.given_up && f.is_curved_part())) surface.patch[t] = -1;
  }
}

}  // namespace

Result<void> dissolve_narrow_patches(QuotientSurface& surface, double most) {
  auto found = survey(surface);
  if (!found) return error_of(found);
  for (const SmoothSide& side : found->sides) {
    PatchFigures& f = found->patches[side.patch];
    if (side.length < kSignificantShare * f.boundary) continue;
    // Two chords that turn by the angle, one instead: so far is the point between them from it.
    const double own = f.width();
    const double next = side.other >= 0 ? found->patches[side.other].width() : own;
    if (side.angle * own * next / (own + next) < most) f.given_up = true;
  }
  give_up(surface, *found);
  return {};
}

Result<void> dissolve_sharp_patches(QuotientSurface& surface, double most) {
  auto found = survey(surface);
  if (!found) return error_of(found);
  const RotationTable rotations(surface.fold);
  std::map<std::pair<std::int32_t, std::int32_t>, double> angles;  // at (patch, vertex)
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (found->patch[t] < 0) continue;
    const auto p = corners_of(surface, rotations, t);
    for (std::size_t i = 0; i < 3; ++i) {
      const Point3 u = p[(i + 1) % 3] - p[i], v = p[(i + 2) % 3] - p[i];
      angles[{found->patch[t], surface.triangles[t][i].orbit}] +=
          std::atan2(length(cross(u, v)), dot(u, v));
    }
  }
  for (const auto& [corner, angle] : angles) {
    if (angle < kSharpCorner) found->patches[corner.first].given_up = true;
  }
  for (PatchFigures& f : found->patches) {
    if (f.width() < kLeastWidth * most) f.given_up = true;
  }
  give_up(surface, *found);
  return {};
}

}  // namespace symcell::solid
