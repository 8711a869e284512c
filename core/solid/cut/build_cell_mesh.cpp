#include <algorithm>
#include <optional>
#include <unordered_map>
#include <utility>

#include "core/cell/pair_images.hpp"
#include "core/solid/cut/cut_cell.hpp"
#include "core/solid/cut/sector_regions.hpp"

namespace symcell::solid {
namespace {

class CellBuilder {
 public:
  CellBuilder(const InitialTetrahedralization& solid, const CellCut& cut, const Symmetry& symmetry)
      : solid_(solid), mesh_(solid.mesh), cut_(cut) {
    out_.dimension = 3;
    out_.fold = mesh_.fold();
    out_.axis_origin = symmetry.frame.origin;
    out_.axis_direction = symmetry.frame.direction();
    out_.frame = symmetry.frame.matrix;
    out_.nodes_per_element = 4;
    out_.nodes_per_facet = 3;
  }

  SymmetryCellMesh build() {
    orbit_.assign(mesh_.vertex_slots(), -1);
    first_node_.assign(mesh_.vertex_slots(), kNoNode);
    add_elements();
    out_.node_markers.assign(out_.nodes.size(), 0);
    add_boundary();
    add_segment_markers();
    add_bounds();
    share_markers();
    return std::move(out_);
  }

 private:
  static constexpr std::int32_t kNoNode = -1;  // of an orbit and exponent that the cell has not

  [[nodiscard]] static std::size_t idx(std::int32_t i) { return static_cast<std::size_t>(i); }

  // A corner as it stands in the cell.
  [[nodiscard]] OrbitVertex cell_corner(TetId t, std::uint32_t i) const {
    return mesh_.shift(mesh_.corner(t, i), cut_.exponent[t]);
  }

  // Most orbits have one node in the cell; further ones (on the bounds) are found by a map.
  std::int32_t node(OrbitVertex c) {
    const std::size_t v = idx(c.orbit);
    if (orbit_[v] < 0) {
      orbit_[v] = static_cast<std::int32_t>(out_.orbit_points.size());
      out_.orbit_points.push_back(mesh_.point(c.orbit));
      out_.on_axis.push_back(mesh_.on_axis(c.orbit) ? 1 : 0);
      first_node_[v] = add_node({orbit_[v], c.exponent});
      return first_node_[v];
    }
    if (out_.nodes[idx(first_node_[v])].exponent == c.exponent) return first_node_[v];
    const auto [it, fresh] = further_.try_emplace(key(orbit_[v], c.exponent), kNoNode);
    if (fresh) it->second = add_node({orbit_[v], c.exponent});
    return it->second;
  }
  std::int32_t add_node(OrbitVertex n) {
    out_.nodes.push_back(n);
    return static_cast<std::int32_t>(out_.nodes.size() - 1);
  }
  [[nodiscard]] static std::int64_t key(std::int32_t orbit, std::int32_t exponent) {
    return static_cast<std::int64_t>(orbit) << 32 | exponent;
  }
  // kNoNode if the cell has none.
  [[nodiscard]] std::int32_t find_node(OrbitVertex c) const {
    const std::size_t v = idx(c.orbit);
    if (orbit_[v] < 0) return kNoNode;
    if (out_.nodes[idx(first_node_[v])].exponent == c.exponent) return first_node_[v];
    const auto it = further_.find(key(orbit_[v], c.exponent));
    return it == further_.end() ? kNoNode : it->second;
  }

  void add_elements() {
    out_.elements.reserve(4 * mesh_.tet_count());
    out_.regions.reserve(mesh_.tet_count());
    std::optional<SectorRegions> regions;
    if (solid_.regions_differ) regions.emplace(mesh_, solid_.seeds);
    const bool differ = regions && regions->differ();
    for (TetId t = 0; t < mesh_.tet_slots(); ++t) {
      if (!mesh_.alive(t)) continue;
      for (std::uint32_t i = 0; i < 4; ++i) out_.elements.push_back(node(cell_corner(t, i)));
      if (!regions) {
        out_.regions.push_back(solid_.subdomains[idx(mesh_.tet(t).region)].attribute);
        continue;
      }
      out_.regions.push_back(regions->attribute(t, cut_.exponent[t]));
      for (std::int32_t s = 0; differ && s < mesh_.fold(); ++s) {
        out_.sector_regions.push_back(regions->attribute(t, mesh_.add(cut_.exponent[t], s)));
      }
    }
  }

  void mark_node(std::int32_t n, std::int32_t marker) {
    // Of several markers at a node the smallest but 0 is its own.
    std::int32_t& at = out_.node_markers[idx(n)];
    if (marker != 0 && (at == 0 || marker < at)) at = marker;
  }

  void add_boundary() {
    std::vector<std::uint8_t> lower(4 * mesh_.tet_slots(), 0);
    for (const HalfFace h : cut_.lower) lower[h] = 1;
    for (TetId t = 0; t < mesh_.tet_slots(); ++t) {
      if (!mesh_.alive(t)) continue;
      const Tet& tet = mesh_.tet(t);
      for (std::uint32_t i = 0; i < 4; ++i) {
        if (tet.facet[i] == kNoFacet) continue;
        const HalfFace h = 4 * t + i, g = tet.nb[i];
        const bool on_lower = lower[h] != 0;
        const bool on_higher = g != kNoHalfFace && lower[g] != 0;
        // Inside the cell an internal subfacet is seen from two sides: list it once.
        if (g != kNoHalfFace && !on_lower && !on_higher && g < h) continue;
        const std::int32_t marker = solid_.facet_markers[idx(tet.facet[i])];
        for (const std::uint32_t c : kFaceCorners[i]) {
          const std::int32_t n = find_node(cell_corner(t, c));
          out_.boundary.push_back(n);
          mark_node(n, marker);
        }
        out_.boundary_markers.push_back(marker);
        out_.boundary_is_higher_image.push_back(on_higher ? 1 : 0);
      }
    }
  }

  void add_segment_markers() {
    for (TetId t = 0; t < mesh_.tet_slots(); ++t) {
      if (!mesh_.alive(t)) continue;
      for (const auto& e : kEdgeCorners) {
        const std::int32_t segment = mesh_.segment_of(mesh_.corner(t, e[0]), mesh_.corner(t, e[1]));
        if (segment == kNoSegment) continue;
        const std::int32_t marker = solid_.segment_markers[idx(segment)];
        for (const std::uint32_t i : e) mark_node(find_node(cell_corner(t, i)), marker);
      }
    }
  }

  void add_bounds() {
    out_.lower_to_higher.assign(out_.nodes.size(), kNoNode);
    if (mesh_.fold() == 1) return;
    for (const HalfFace h : cut_.lower) {
      for (const std::uint32_t i : kFaceCorners[face_of(h)]) {
        const OrbitVertex c = cell_corner(tet_of(h), i);
        const std::int32_t own = find_node(c), image = find_node(mesh_.shift(c, 1));
        out_.lower_to_higher[idx(own)] = image;
        out_.lower_facets.push_back(own);
        out_.higher_facets.push_back(image);
      }
    }
    for (std::size_t v = 0; v < orbit_.size(); ++v) {
      if (orbit_[v] < 0) continue;
      const auto id = static_cast<VertexId>(v);
      if (mesh_.on_axis(id)) out_.lower_to_higher[idx(first_node_[v])] = first_node_[v];
    }
    pair_beyond_bounds(out_);
  }

  // Nodes of one orbit carry one marker.
  void share_markers() {
    std::vector<std::int32_t> marker(out_.orbit_points.size(), 0);
    for (std::size_t n = 0; n < out_.nodes.size(); ++n) {
      std::int32_t& m = marker[idx(out_.nodes[n].orbit)];
      const std::int32_t own = out_.node_markers[n];
      if (own != 0 && (m == 0 || own < m)) m = own;
    }
    for (std::size_t n = 0; n < out_.nodes.size(); ++n) {
      out_.node_markers[n] = marker[idx(out_.nodes[n].orbit)];
    }
  }

  const InitialTetrahedralization& solid_;
  const QuotientTetrahedralization& mesh_;
  const CellCut& cut_;
  SymmetryCellMesh out_;
  std::vector<std::int32_t> orbit_;                         // per vertex slot
  std::vector<std::int32_t> first_node_;                    // per vertex slot
  std::unordered_map<std::int64_t, std::int32_t> further_;  // looked up only, never iterated
};

}  // namespace

SymmetryCellMesh build_cell_mesh(const InitialTetrahedralization& solid,
                                 const CellCut& cut,
                                 const Symmetry& symmetry) {
  return CellBuilder(solid, cut, symmetry).build();
}

}  // namespace symcell::solid
