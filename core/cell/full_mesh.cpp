#include "core/cell/full_mesh.hpp"

#include "core/base/assert.hpp"

namespace symcell {

FullMeshView::FullMeshView(const SymmetryCellMesh& cell) : cell_(&cell), rotations_(cell.fold) {
  const std::size_t orbits = cell.orbit_points.size();
  rank_.resize(orbits);
  orbit_of_rank_.reserve(orbits);
  for (int pass = 0; pass < 2; ++pass) {
    for (std::size_t o = 0; o < orbits; ++o) {
      const bool axis = cell.on_axis[o] != 0 && cell.fold > 1;
      if (axis != (pass == 1)) continue;
      rank_[o] = static_cast<std::int64_t>(orbit_of_rank_.size());
      orbit_of_rank_.push_back(static_cast<std::int32_t>(o));
    }
    if (pass == 0) off_axis_ = static_cast<std::int64_t>(orbit_of_rank_.size());
  }
  const auto on_axis = static_cast<std::int64_t>(orbits) - off_axis_;
  node_count_ = off_axis_ * cell.fold + on_axis;
  marker_.assign(orbits, 0);
  for (std::size_t i = 0; i < cell.nodes.size(); ++i) {
    marker_[static_cast<std::size_t>(cell.nodes[i].orbit)] = cell.node_markers[i];
  }
}

Point3 FullMeshView::position(OrbitVertex v) const {
  const Point3 local = cell_->orbit_points[static_cast<std::size_t>(v.orbit)];
  const Point2 planar = rotations_.rotate(Point2{local.x, local.y}, v.exponent);
  const Point3& o = cell_->axis_origin;
  if (cell_->dimension == 2) return {o.x + planar.x, o.y + planar.y, 0};
  const auto& f = cell_->frame;
  return {o.x + f[0] * planar.x + f[1] * planar.y + f[2] * local.z,
          o.y + f[3] * planar.x + f[4] * planar.y + f[5] * local.z,
          o.z + f[6] * planar.x + f[7] * planar.y + f[8] * local.z};
}

OrbitVertex FullMeshView::node(std::int64_t id) const {
  SYMCELL_ASSERT(id >= 0 && id < node_count_);
  const std::int64_t around = off_axis_ * cell_->fold;
  if (id >= around) {
    return {orbit_of_rank_[static_cast<std::size_t>(off_axis_ + id - around)], 0};
  }
  return {orbit_of_rank_[static_cast<std::size_t>(id % off_axis_)],
          static_cast<std::int32_t>(id / off_axis_)};
}

std::int32_t FullMeshView::node_marker(std::int64_t id) const {
  return marker_[static_cast<std::size_t>(node(id).orbit)];
}

}  // namespace symcell
