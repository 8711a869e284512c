#include "core/solid/cut/sector_regions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace symcell::solid {
namespace {

std::size_t idx(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

// Smallest barycentric coordinate of p: not negative inside.
double depth(const std::array<Point3, 4>& c, Point3 p) {
  const double volume = dot(cross(c[1] - c[0], c[2] - c[0]), c[3] - c[0]);
  double least = 1;
  for (const auto& f : kFaceCorners) {
    const Point3 a = c[f[0]];
    least = std::min(least, dot(cross(c[f[1]] - a, c[f[2]] - a), a - p) / volume);
  }
  return least;
}

}  // namespace

SectorRegions::SectorRegions(const QuotientTetrahedralization& mesh,
                             const std::vector<SectorRegion>& seeds)
    : mesh_(mesh), part_(mesh.tet_slots(), -1), offset_(mesh.tet_slots(), 0) {
  flood();
  for (Part& p : parts_) {
    p.attributes.assign(idx(p.copies), 0);
    p.seeded.assign(idx(p.copies), 0);
  }
  for (const SectorRegion& seed : seeds) {
    const TetCopy at = locate(seed.point);
    Part& p = parts_[idx(part_[at.t])];
    const std::size_t copy = copy_of(at.t, at.e);
    if (p.seeded[copy] != 0) continue;
    p.seeded[copy] = 1;
    p.attributes[copy] = seed.attribute;
  }
}

void SectorRegions::flood() {
  std::vector<TetId> stack;
  for (TetId seed = 0; seed < mesh_.tet_slots(); ++seed) {
    if (!mesh_.alive(seed) || part_[seed] >= 0) continue;
    const auto id = static_cast<std::int32_t>(parts_.size());
    parts_.emplace_back();
    std::int32_t copies = mesh_.fold();
    part_[seed] = id;
    stack.assign(1, seed);
    while (!stack.empty()) {
      const TetId t = stack.back();
      stack.pop_back();
      const Tet& tet = mesh_.tet(t);
      for (std::uint32_t i = 0; i < 4; ++i) {
        if (tet.nb[i] == kNoHalfFace || tet.facet[i] != kNoFacet) continue;
        const TetId g = tet_of(tet.nb[i]);
        const std::int32_t offset = mesh_.add(offset_[t], tet.off[i]);
        if (part_[g] < 0) {
          part_[g] = id;
          offset_[g] = offset;
          stack.push_back(g);
        } else {
          copies = std::gcd(copies, mesh_.subtract(offset, offset_[g]));
        }
      }
    }
    parts_.back().copies = copies;
  }
}

std::size_t SectorRegions::copy_of(TetId t, std::int32_t exponent) const {
  // The copy of t at its offset belongs to the part that the first tetrahedron at 0 belongs to.
  const std::int32_t copies = parts_[idx(part_[t])].copies;
  return idx(mesh_.subtract(exponent, offset_[t]) % copies);
}

bool SectorRegions::differ() const {
  return std::any_of(parts_.begin(), parts_.end(), [](const Part& p) {
    return std::any_of(p.attributes.begin(), p.attributes.end(),
                       [&](std::int32_t a) { return a != p.attributes[0]; });
  });
}

std::int32_t SectorRegions::attribute(TetId t, std::int32_t exponent) const {
  return parts_[idx(part_[t])].attributes[copy_of(t, exponent)];
}

TetCopy SectorRegions::locate(Point3 p) const {
  TetCopy best;
  double deepest = -std::numeric_limits<double>::infinity();
  for (TetId t = 0; t < mesh_.tet_slots() && deepest < 0; ++t) {
    if (!mesh_.alive(t)) continue;
    std::array<Point3, 4> c;
    double low = std::numeric_limits<double>::infinity(), high = -low, radius = 0;
    for (std::uint32_t i = 0; i < 4; ++i) {
      c[i] = mesh_.corner_point(t, i);
      low = std::min(low, c[i].z);
      high = std::max(high, c[i].z);
      radius = std::max(radius, std::hypot(c[i].x, c[i].y));
    }
    // Seeds lie inside parts: what is beside the tetrahedron's height or beyond it can be skipped.
    if (p.z < low || p.z > high || std::hypot(p.x, p.y) > radius) continue;
    for (std::int32_t e = 0; e < mesh_.fold(); ++e) {
      const double d = depth(c, mesh_.rotations().rotate(p, mesh_.subtract(0, e)));
      if (d <= deepest) continue;
      deepest = d;
      best = {t, e};
    }
  }
  return best;
}

}  // namespace symcell::solid
