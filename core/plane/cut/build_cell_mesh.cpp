#include "core/plane/cut/build_cell_mesh.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <unordered_map>

#include "core/cell/pair_images.hpp"

namespace symcell::plane {
namespace {

class CellMeshBuilder {
 public:
  CellMeshBuilder(const InitialTriangulation& triangulation,
                  const CellCut& cut,
                  const SymmetricPslg& pslg)
      : source_(triangulation), mesh_(triangulation.mesh), cut_(cut), pslg_(pslg) {}

  SymmetryCellMesh build() {
    out_.fold = mesh_.fold();
    out_.axis_origin = {pslg_.centre.x, pslg_.centre.y, 0};
    orbit_.assign(mesh_.vertex_slots(), -1);
    first_node_.assign(mesh_.vertex_slots(), -1);
    add_elements();
    out_.node_markers.assign(out_.nodes.size(), 0);
    add_boundary();
    add_bounds();
    return std::move(out_);
  }

 private:
  static constexpr std::int32_t kNoNode = -1;  // of an orbit and exponent that the cell has not

  [[nodiscard]] std::int32_t exponent_in_cell(TriangleId t, std::uint32_t i) const {
    const Triangle& tri = mesh_.triangle(t);
    return mesh_.shift(tri.v[i], tri.k[i], cut_.exponent[t]);
  }

  // Most orbits have one node in the cell; further ones (on the bounds) are chained by a map.
  std::int32_t node(VertexId v, std::int32_t exponent) {
    const auto i = static_cast<std::size_t>(v);
    if (orbit_[i] < 0) {
      orbit_[i] = static_cast<std::int32_t>(out_.orbit_points.size());
      const Point2 p = mesh_.point(v);
      out_.orbit_points.push_back({p.x, p.y, 0});
      out_.on_axis.push_back(v == mesh_.centre() ? 1 : 0);
      first_node_[i] = add_node({orbit_[i], exponent});
      return first_node_[i];
    }
    if (out_.nodes[static_cast<std::size_t>(first_node_[i])].exponent == exponent) {
      return first_node_[i];
    }
    const auto [it, fresh] = further_.try_emplace(key(orbit_[i], exponent), kNoNode);
    if (fresh) it->second = add_node({orbit_[i], exponent});
    return it->second;
  }
  std::int32_t add_node(OrbitVertex n) {
    out_.nodes.push_back(n);
    return static_cast<std::int32_t>(out_.nodes.size() - 1);
  }
  [[nodiscard]] static std::int64_t key(std::int32_t orbit, std::int32_t exponent) {
    return (static_cast<std::int64_t>(orbit) << 32) | exponent;
  }
  // The node of an orbit at an exponent, kNoNode if the cell has none.
  [[nodiscard]] std::int32_t find_node(VertexId v, std::int32_t exponent) const {
    const auto i = static_cast<std::size_t>(v);
    if (orbit_[i] < 0) return kNoNode;
    if (out_.nodes[static_cast<std::size_t>(first_node_[i])].exponent == exponent) {
      return first_node_[i];
    }
    const auto it = further_.find(key(orbit_[i], exponent));
    return it == further_.end() ? kNoNode : it->second;
  }
  [[nodiscard]] std::int32_t corner_node(TriangleId t, std::uint32_t i) const {
    return find_node(mesh_.triangle(t).v[i], exponent_in_cell(t, i));
  }

  void add_elements() {
    out_.elements.reserve(3 * mesh_.triangle_count());
    out_.regions.reserve(mesh_.triangle_count());
    for (TriangleId t = 0; t < mesh_.triangle_slots(); ++t) {
      if (!mesh_.alive(t)) continue;
      const Triangle& tri = mesh_.triangle(t);
      for (std::uint32_t i = 0; i < 3; ++i) {
        out_.elements.push_back(node(tri.v[i], exponent_in_cell(t, i)));
      }
      if (source_.locator == nullptr) {
        out_.regions.push_back(source_.subdomains[static_cast<std::size_t>(tri.face)].attribute);
      } else {
        add_sector_regions(t);
      }
    }
  }

  void add_sector_regions(TriangleId t) {
    const Triangle& tri = mesh_.triangle(t);
    const Point2 middle = (1.0 / 3.0) * (mesh_.corner_point(tri, 0) + mesh_.corner_point(tri, 1) +
                                         mesh_.corner_point(tri, 2));
    for (std::int32_t s = 0; s < mesh_.fold(); ++s) {
      const Point2 x = mesh_.rotations().rotate(middle, mesh_.add(cut_.exponent[t], s));
      out_.sector_regions.push_back(source_.locator->attribute_at(x));
    }
    out_.regions.push_back(
        out_.sector_regions[out_.sector_regions.size() - static_cast<std::size_t>(mesh_.fold())]);
  }

  // The copy of the parent segment on which a point of subsegment s lies. The frame of a subsegment
  // relative to its parent is not kept while refining: the nearest copy decides.
  [[nodiscard]] std::int32_t copy_of_parent(std::int32_t parent, Point2 x) const {
    const SymmetricSegment& seg = pslg_.segments[static_cast<std::size_t>(parent)];
    std::int32_t best = 0;
    double best_distance = std::numeric_limits<double>::infinity();
    for (std::int32_t k = 0; k < mesh_.fold(); ++k) {
      const auto end = [&](OrbitVertex v) {
        return mesh_.rotations().rotate(
            pslg_.orbit_points[static_cast<std::size_t>(v.orbit)],
            v.orbit == pslg_.centre_orbit ? 0 : mesh_.add(v.exponent, k));
      };
      const Point2 a = end(seg.a), b = end(seg.b), d = b - a;
      const double t = std::clamp(dot(x - a, d) / squared_length(d), 0.0, 1.0);
      const double dist = squared_distance(x, a + t * d);
      if (dist < best_distance) {
        best_distance = dist;
        best = k;
      }
    }
    return best;
  }

  void add_boundary() {
    std::vector<std::uint8_t> lower(3 * mesh_.triangle_slots(), 0);
    for (const HalfEdge h : cut_.lower) lower[h] = 1;
    for (TriangleId t = 0; t < mesh_.triangle_slots(); ++t) {
      if (!mesh_.alive(t)) continue;
      for (std::uint32_t j = 0; j < 3; ++j) {
        const Triangle& tri = mesh_.triangle(t);
        if (tri.seg[j] == kNoSubsegment) continue;
        const HalfEdge h = 3 * t + j, g = tri.nb[j];
        const bool on_lower = lower[h] != 0;
        const bool on_higher = g != kNoHalfEdge && lower[g] != 0;
        // Inside the cell an internal subsegment is seen from two sides: list it once.
        if (g != kNoHalfEdge && !on_lower && !on_higher && g < h) continue;
        add_facet(t, j, on_higher && !on_lower);
      }
    }
  }

  void add_facet(TriangleId t, std::uint32_t j, bool higher) {
    const Triangle& tri = mesh_.triangle(t);
    const auto parent = static_cast<std::size_t>(mesh_.subsegment(tri.seg[j]).parent);
    const std::int32_t a = corner_node(t, next3(j)), b = corner_node(t, prev3(j));
    out_.boundary.push_back(a);
    out_.boundary.push_back(b);
    out_.boundary_is_higher_image.push_back(higher ? 1 : 0);
    std::int32_t marker = pslg_.segment_marker(parent, 0);
    if (!pslg_.uniform_markers) {
      const Point2 middle =
          0.5 * (mesh_.corner_point(tri, next3(j)) + mesh_.corner_point(tri, prev3(j)));
      const std::int32_t copy = copy_of_parent(static_cast<std::int32_t>(parent),
                                               mesh_.rotations().rotate(middle, cut_.exponent[t]));
      marker = pslg_.segment_marker(parent, copy);
      for (std::int32_t s = 0; s < mesh_.fold(); ++s) {
        out_.sector_boundary_markers.push_back(pslg_.segment_marker(parent, mesh_.add(copy, s)));
      }
    }
    out_.boundary_markers.push_back(marker);
    if (!pslg_.bulges.empty()) out_.boundary_bulges.push_back(bulge(tri, j, parent));
    for (const std::int32_t n : {a, b}) {
      // Of several markers at a node the smallest but 0 is its own.
      std::int32_t& at = out_.node_markers[static_cast<std::size_t>(n)];
      if (marker != 0 && (at == 0 || marker < at)) at = marker;
    }
  }

  // Of edge j of a triangle if it is the whole of a chord.
  [[nodiscard]] double bulge(const Triangle& tri, std::uint32_t j, std::size_t parent) const {
    const SymmetricSegment& chord = pslg_.segments[parent];
    const auto runs_from = [&](std::uint32_t from, std::uint32_t to) {
      if (tri.v[from] != chord.a.orbit || tri.v[to] != chord.b.orbit) return false;
      const auto centre = mesh_.centre();
      if (chord.a.orbit == centre || chord.b.orbit == centre) return true;
      const RotationTable& r = mesh_.rotations();
      return r.subtract(tri.k[to], tri.k[from]) == r.subtract(chord.b.exponent, chord.a.exponent);
    };
    if (runs_from(next3(j), prev3(j))) return pslg_.bulges[parent];
    if (runs_from(prev3(j), next3(j))) return -pslg_.bulges[parent];
    return 0;
  }

  void add_bounds() {
    out_.lower_to_higher.assign(out_.nodes.size(), -1);
    if (mesh_.fold() == 1) return;
    for (const HalfEdge h : cut_.lower) {
      const TriangleId t = triangle_of(h);
      for (const std::uint32_t i : {next3(local_of(h)), prev3(local_of(h))}) {
        const VertexId v = mesh_.triangle(t).v[i];
        const std::int32_t e = exponent_in_cell(t, i);
        const std::int32_t image = find_node(v, mesh_.shift(v, e, 1));
        const std::int32_t own = find_node(v, e);
        out_.lower_to_higher[static_cast<std::size_t>(own)] = image;
        out_.lower_facets.push_back(own);
        out_.higher_facets.push_back(image);
      }
    }
    if (mesh_.centre() >= 0) {
      const std::int32_t c = find_node(mesh_.centre(), 0);
      out_.lower_to_higher[static_cast<std::size_t>(c)] = c;
    }
    pair_beyond_bounds(out_);
    share_markers();
  }

  // Nodes of one orbit carry one marker.
  void share_markers() {
    std::vector<std::int32_t> marker(out_.orbit_points.size(), 0);
    for (std::size_t n = 0; n < out_.nodes.size(); ++n) {
      std::int32_t& m = marker[static_cast<std::size_t>(out_.nodes[n].orbit)];
      const std::int32_t own = out_.node_markers[n];
      if (own != 0 && (m == 0 || own < m)) m = own;
    }
    for (std::size_t n = 0; n < out_.nodes.size(); ++n) {
      out_.node_markers[n] = marker[static_cast<std::size_t>(out_.nodes[n].orbit)];
    }
  }

  const InitialTriangulation& source_;
  const QuotientTriangulation& mesh_;
  const CellCut& cut_;
  const SymmetricPslg& pslg_;
  SymmetryCellMesh out_;
  std::vector<std::int32_t> orbit_;                         // per vertex slot
  std::vector<std::int32_t> first_node_;                    // per vertex slot
  std::unordered_map<std::int64_t, std::int32_t> further_;  // looked up only, never iterated
};

}  // namespace

SymmetryCellMesh build_cell_mesh(const InitialTriangulation& triangulation,
                                 const CellCut& cut,
                                 const SymmetricPslg& pslg) {
  SymmetryCellMesh mesh = CellMeshBuilder(triangulation, cut, pslg).build();
  mesh.shape_tolerance_rel = static_cast<float>(pslg.shape_tolerance_rel);
  return mesh;
}

}  // namespace symcell::plane
