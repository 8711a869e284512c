// TetGen as a peer to measure against: refined meshes of whole models and of predefined planar
// sectors, the "M1" of [paper].
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/error.hpp"
#include "core/cell/statistics.hpp"
#include "core/model/plc.hpp"
#include "core/model/triangle_surface.hpp"
#include "core/solid/sector/sector.hpp"

namespace symcell::bench {

struct PeerBounds {
  double radius_edge = 1.414;
  double max_volume = 0;  // 0: none
};

struct PeerCount {
  std::uint64_t tets = 0;    // of the full mesh
  double seconds = 0;        // of the child process that meshes
  bool matched = true;       // see mesh_matched_sector
  Statistics::Cell figures;  // of the mesh as TetGen made it: of a sector, one sector's
};

// The whole model; of a surface the vertices are welded where they are equal.
[[nodiscard]] Result<PeerCount> mesh_whole(const Plc& plc, PeerBounds bounds);
[[nodiscard]] Result<PeerCount> mesh_whole(const TriangleSurface& surface, PeerBounds bounds);

// The wedge with matched cut faces that keep the bounds. TetGen refines the wedge until both cuts'
// curves have the same vertices, what it puts on one being put on the other; then the lower cut's
// mesh is laid on the higher one too, and the inside is meshed with the boundary fixed (-Y).
// Where that does not end within a few rounds (curves that meet edges of the model at small
// angles): the count of the wedge with each cut refined for itself, `matched` false, less than a
// mesh that matches would have. (With -Y alone on the wedge as cut TetGen adds next to nothing: the
// coarse boundary is in the way, and neither bound is kept.)
[[nodiscard]] Result<PeerCount> mesh_matched_sector(const solid::Sector& sector, PeerBounds bounds);

}  // namespace symcell::bench
