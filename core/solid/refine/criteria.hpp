// What makes a tetrahedron bad, and which the input itself exempts.
//
// Bounds: radius-edge ratio, volume (global and of the region), longest edge (global, of the region, and
// by a size field, which is asked at the centroid). Exempt from the ratio
// are tetrahedra with a corner on a sharp feature of the input (dihedral angle at a segment, or
// face angle at a vertex, below kSharpDeg). Where 360/n is below 60 degrees those with a corner on
// the axis are exempt as far as the sector forces it: from the bound B up to B / (2 sin(180/n)).
// A point that is farther than B l from the corners of a tetrahedron with a shortest edge l, and
// that encroaches upon no subsegment of the axis, is at least B l / sqrt 2 from the axis, and its
// nearest copy 2 sin(180/n) times that from it: for B = sqrt 2 that is less than l as soon as n is
// above 6, and no refinement need end.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/geometry/tet_measures.hpp"
#include "core/model/mesh_options.hpp"
#include "core/solid/initial/initial_tetrahedralization.hpp"
#include "core/solid/quotient/quotient_tetrahedralization.hpp"
#include "core/solid/sizes/size_lookup.hpp"

namespace symcell::solid {

inline constexpr double kSharpDeg = 70;  // about the dihedral angle of a regular tetrahedron, 70.5
inline constexpr double kNarrowSectorDeg = 60;  // from it on that ratio is 1 at most

// What exempts from more comes later.
enum class Exemption : std::uint8_t { kNone, kAxis, kSmallInputAngle };

class Criteria {
 public:
  Criteria(const InitialTetrahedralization& solid, const MeshOptions& options);

  // 1 or less: keeps all bounds. Above: the largest factor by which a length or the ratio is over.
  [[nodiscard]] double excess(const TetMeasures& m,
                              std::int32_t region,
                              Exemption exemption) const {
    const double sized = size_excess2(m, region);
    const double ratio = m.ratio2() * inverse_ratios2_[static_cast<std::size_t>(exemption)];
    return ratio > sized ? ratio : sized;
  }
  // Of the ratio alone.
  [[nodiscard]] double ratio_excess(const TetMeasures& m) const {
    return m.ratio2() * inverse_ratios2_[static_cast<std::size_t>(Exemption::kNone)];
  }
  // Squared, of volume and edge alone (volumes to the power 2/3).
  [[nodiscard]] double size_excess2(const TetMeasures& m, std::int32_t region) const;
  [[nodiscard]] bool is_bad(const TetMeasures& m, std::int32_t region, Exemption exemption) const {
    return excess(m, region, exemption) > 1;
  }
  [[nodiscard]] double max_volume(std::int32_t region) const {
    return max_volumes_[static_cast<std::size_t>(region)];
  }
  [[nodiscard]] double max_edge2() const { return max_edge2_; }
  // No point may come nearer to a vertex than this; 0: as near as the other bounds ask.
  [[nodiscard]] double min_edge() const { return min_edge_; }

  [[nodiscard]] Exemption exemption(const QuotientTetrahedralization& mesh, const Tet& t) const {
    Exemption found = Exemption::kNone;
    for (const VertexId v : t.v) found = std::max(found, exemption(mesh, v));
    return found;
  }
  [[nodiscard]] Exemption exemption(const QuotientTetrahedralization& mesh, VertexId v) const {
    const VertexKind kind = mesh.kind(v);
    if (kind > VertexKind::kSegment) return Exemption::kNone;
    if (kind == VertexKind::kInput && sharp_vertices_[static_cast<std::size_t>(v)] != 0) {
      return Exemption::kSmallInputAngle;
    }
    if (kind == VertexKind::kSegment && sharp_segment(mesh.parent(v))) {
      return Exemption::kSmallInputAngle;
    }
    return narrow_ && mesh.on_axis(v) ? Exemption::kAxis : Exemption::kNone;
  }
  [[nodiscard]] bool sharp_segment(std::int32_t segment) const {
    return segment >= 0 && sharp_segments_[static_cast<std::size_t>(segment)] != 0;
  }
  [[nodiscard]] bool sharp_vertex(const QuotientTetrahedralization& mesh, VertexId v) const {
    return exemption(mesh, v) == Exemption::kSmallInputAngle;
  }
  // A vertex of the input where segments of one facet meet at a small angle, or on a sharp segment:
  // exempt or not, segments are divided in shells around it.
  [[nodiscard]] bool acute_vertex(const QuotientTetrahedralization& mesh, VertexId v) const {
    return mesh.kind(v) == VertexKind::kInput && acute_vertices_[static_cast<std::size_t>(v)] != 0;
  }

 private:
  void find_sizes(const InitialTetrahedralization& solid, const MeshOptions& options);
  void find_sharp_segments(const QuotientTetrahedralization& mesh);
  void find_sharp_vertices(const QuotientTetrahedralization& mesh, bool tessellated);

  std::array<double, 3> inverse_ratios2_;  // by exemption
  double max_edge2_;
  double min_edge_;
  bool narrow_;
  std::vector<double> max_volumes_;           // per region
  std::vector<double> region_edges2_;         // per region; empty: none has a bound of its own
  mutable std::vector<SizeLookup> sizes_;     // from place to place; remembers what was asked
  std::vector<std::uint8_t> sharp_segments_;  // per segment
  std::vector<std::uint8_t> sharp_vertices_;  // per vertex of the first mesh
  std::vector<std::uint8_t> acute_vertices_;  // likewise
};

}  // namespace symcell::solid
