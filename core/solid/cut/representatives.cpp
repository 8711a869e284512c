#include "core/solid/cut/representatives.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>

namespace symcell::solid {
namespace {

Point2 planar(Point3 p) {
  return {p.x, p.y};
}

Point2 centroid(const QuotientTetrahedralization& mesh, TetId t) {
  Point2 sum{};
  for (std::uint32_t i = 0; i < 4; ++i) sum = sum + planar(mesh.corner_point(t, i));
  return 0.25 * sum;
}

double turn(Point2 from, Point2 to) {
  return std::atan2(cross(from, to), dot(from, to));
}

}  // namespace

Representatives::Representatives(const QuotientTetrahedralization& mesh, double share)
    : mesh_(&mesh), exponent_(mesh.tet_slots(), 0), jump_(4 * mesh.tet_slots(), 0) {
  if (mesh.fold() == 1) return;
  const double sector = 2 * std::numbers::pi / static_cast<double>(mesh.fold());
  std::vector<double> place(mesh.tet_slots(),
                            0);  // angle in the cell, in sectors, [share, 1 + share)
  for (TetId t = 0; t < mesh.tet_slots(); ++t) {
    if (!mesh.alive(t)) continue;
    const Point2 c = centroid(mesh, t);
    const double angle = std::atan2(c.y, c.x) / sector;
    const double steps = std::floor(angle - share);
    exponent_[t] = -static_cast<std::int32_t>(steps);
    place[t] = angle - steps;
  }
  for (TetId t = 0; t < mesh.tet_slots(); ++t) {
    if (!mesh.alive(t)) continue;
    const Tet& tet = mesh.tet(t);
    for (std::uint32_t i = 0; i < 4; ++i) {
      const HalfFace h = 4 * t + i, g = tet.nb[i];
      if (g == kNoHalfFace || g < h) continue;
      Point2 face{};
      for (const std::uint32_t c : kFaceCorners[i]) face = face + planar(mesh.corner_point(t, c));
      const Point2 there = mesh.rotations().rotate(centroid(mesh, tet_of(g)), tet.off[i]);
      const double way = (turn(centroid(mesh, t), face) + turn(face, there)) / sector;
      // The neighbour's copy lies at place[t] + way, the one in the cell at place[g].
      jump_[h] = static_cast<std::int32_t>(std::lround(place[t] + way - place[tet_of(g)]));
      jump_[g] = -jump_[h];
    }
  }
}

double Representatives::best_share(const QuotientTetrahedralization& mesh) {
  // Moving the half-plane from 0 to `share` lifts the tetrahedra passed by one, so the cost of a
  // face as a function of the share is constant but between the places of its two tetrahedra.
  const Representatives start(mesh, 0);
  const double sector = 2 * std::numbers::pi / static_cast<double>(mesh.fold());
  const auto bin = [&](TetId t) {
    const Point2 c = centroid(mesh, t);
    const double angle = std::atan2(c.y, c.x) / sector;
    return static_cast<std::int32_t>((angle - std::floor(angle)) * kShares);
  };
  std::vector<std::int32_t> place(mesh.tet_slots(), 0);
  for (TetId t = 0; t < mesh.tet_slots(); ++t) {
    if (mesh.alive(t)) place[t] = bin(t);
  }
  std::array<std::int64_t, kShares + 2> change{};
  for (HalfFace h = 0; h < start.jump_.size(); ++h) {
    const TetId t = tet_of(h);
    if (!mesh.alive(t)) continue;
    const HalfFace g = mesh.tet(t).nb[face_of(h)];
    if (g == kNoHalfFace || g < h) continue;
    const std::int32_t p = place[t], q = place[tet_of(g)];
    const std::int32_t between = start.jump_[h] + (p < q ? 1 : -1);
    const std::int64_t more = std::abs(between) - std::abs(start.jump_[h]);
    change[static_cast<std::size_t>(std::min(p, q)) + 1] += more;
    change[static_cast<std::size_t>(std::max(p, q)) + 1] -= more;
  }
  std::int64_t cost = 0, least = 0;
  std::int32_t best = 0;
  for (std::int32_t b = 0; b < kShares; ++b) {
    cost += change[static_cast<std::size_t>(b)];
    if (cost >= least) continue;
    least = cost;
    best = b;
  }
  return static_cast<double>(best) / kShares;
}

void Representatives::move(TetId t, std::int32_t by) {
  exponent_[t] += by;
  const Tet& tet = mesh_->tet(t);
  for (std::uint32_t i = 0; i < 4; ++i) {
    const HalfFace g = tet.nb[i];
    if (g == kNoHalfFace || tet_of(g) == t) continue;
    jump_[4 * t + i] += by;
    jump_[g] -= by;
  }
}

std::uint64_t Representatives::symmetry_faces() const {
  std::uint64_t count = 0;
  for (HalfFace h = 0; h < jump_.size(); ++h) {
    if (jump_[h] < 0 && !is_inside(h)) ++count;
  }
  return count;
}

}  // namespace symcell::solid
