#include "core/solid/initial/initial_tetrahedralization.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/base/index.hpp"
#include "core/solid/initial/cut_section.hpp"
#include "core/solid/initial/sector_mesh.hpp"
#include "core/solid/initial/sector_parts.hpp"
#include "core/solid/quotient/constraints.hpp"
#include "core/solid/quotient/validate.hpp"

namespace symcell::solid {
namespace {

using initial::SectorMesh;
using initial::SectorParts;

// Volume of the mesh against that of the boundary: both are sums of rounded terms.
constexpr double kVolumeToleranceRel = 1e-6;

Failure failed(const std::string& why) {
  return fail(ErrorCode::kTetrahedralizationFailed, "gluing the sector to its images: " + why);
}

class Gluer {
 public:
  Gluer(const Sector& sector, const SectorMesh& sector_mesh, const SectorParts& parts)
      : sector_(sector), sector_mesh_(sector_mesh), parts_(parts) {
    result_.mesh = QuotientTetrahedralization(sector.fold);
    result_.subdomains = parts.subdomains;
    result_.facet_markers = sector.facet_markers;
    result_.segment_markers = sector.segment_markers;
    result_.tessellated = sector.nesting_decides;
    result_.segment_markers.push_back(0);  // the axis
    if (sector.ignore_markers) {
      result_.seeds = sector.regions;
      result_.regions_differ = true;
    }
  }

  Result<InitialTetrahedralization> glue() && {
    add_vertices();
    SYMCELL_TRY(add_tetrahedra());
    release_unused_vertices();
    add_segments();
    SYMCELL_TRY(check());
    SYMCELL_TRY(measure_cover());
    return std::move(result_);
  }

 private:
  [[nodiscard]] bool on_axis(std::int32_t sector_vertex) const {
    return sector_.on_axis[at(sector_.vertices[at(sector_vertex)].orbit)] != 0;
  }

  // Segment or facet that a vertex of the cut lies in.
  void find_parents() {
    const std::size_t orbits = sector_.orbit_points.size();
    segment_.assign(orbits, kNoSegment);
    along_axis_.assign(orbits, false);
    facet_.assign(orbits, kNoFacet);
    for (const SectorEdge& e : sector_.edges) {
      const bool axis = sector_.fold > 1 && on_axis(e.a) && on_axis(e.b);
      for (const std::int32_t v : {e.a, e.b}) {
        const auto orbit = at(sector_.vertices[at(v)].orbit);
        segment_[orbit] = e.segment;
        along_axis_[orbit] = axis;
      }
    }
    for (const SectorFace& f : sector_.faces) {
      for (const std::int32_t v : f.v) facet_[at(sector_.vertices[at(v)].orbit)] = f.facet;
    }
  }

  // Where the axis crosses a facet or a segment the vertex has no direction left to move in.
  void add_vertices() {
    find_parents();
    for (std::size_t o = 0; o < sector_.orbit_points.size(); ++o) {
      const bool axis = sector_.fold > 1 && sector_.on_axis[o] != 0;
      VertexKind kind = VertexKind::kInput;
      std::int32_t parent = -1;
      if (sector_.kinds[o] == SectorVertexKind::kOnSegment && segment_[o] != kNoSegment &&
          (!axis || along_axis_[o])) {
        kind = VertexKind::kSegment;
        parent = segment_[o];
      } else if (sector_.kinds[o] == SectorVertexKind::kOnFacet && facet_[o] != kNoFacet && !axis) {
        kind = VertexKind::kFacet;
        parent = facet_[o];
      }
      result_.mesh.add_vertex(sector_.orbit_points[o], kind, axis, parent);
    }
    for (std::size_t p = sector_.vertices.size(); p < sector_mesh_.points.size(); ++p) {
      result_.mesh.add_vertex(sector_mesh_.points[p], VertexKind::kFree, false);
    }
  }

  [[nodiscard]] OrbitVertex corner(std::int32_t v) const {
    const std::size_t given = sector_.vertices.size();
    if (at(v) < given) {
      const OrbitVertex o = sector_.vertices[at(v)];
      // Exponent 1 is 0 for n = 1; such sectors have none.
      return {o.orbit, o.exponent};
    }
    return {static_cast<VertexId>(sector_.orbit_points.size() + at(v) - given), 0};
  }

  Result<void> add_tetrahedra() {
    std::vector<NewTet> tets;
    for (std::size_t t = 0; t < sector_mesh_.tets.size(); ++t) {
      if (parts_.subdomain[t] < 0) continue;
      NewTet n;
      n.region = parts_.subdomain[t];
      for (std::size_t i = 0; i < 4; ++i) {
        n.c[i] = corner(sector_mesh_.tets[t][i]);
        const std::int32_t l = sector_mesh_.label[t][i];
        if (sector_mesh_.on_sector_face(l)) n.facet[i] = sector_.faces[at(l)].facet;
      }
      tets.push_back(n);
    }
    if (!result_.mesh.build(tets)) return failed("faces of the section do not fit together");
    return {};
  }

  void release_unused_vertices() {
    std::vector<bool> used(result_.mesh.vertex_slots(), false);
    for (TetId t = 0; t < result_.mesh.tet_slots(); ++t) {
      for (const VertexId v : result_.mesh.tet(t).v) used[at(v)] = true;
    }
    for (std::size_t v = 0; v < used.size(); ++v) {
      if (!used[v]) result_.mesh.release_vertex(static_cast<VertexId>(v));
    }
  }

  void add_segments() {
    QuotientTetrahedralization& mesh = result_.mesh;
    EdgeMap wanted;
    for (const SectorEdge& e : sector_.edges) {
      wanted.set(mesh.edge_key(corner(e.a), corner(e.b)), e.segment);
    }
    // Only edges of the material.
    for (TetId t = 0; t < mesh.tet_slots(); ++t) {
      for (const auto& [i, j] : kEdgeCorners) {
        const OrbitVertex a = mesh.corner(t, i), b = mesh.corner(t, j);
        const EdgeKey key = mesh.edge_key(a, b);
        std::int32_t segment = wanted.find(key);
        if (segment < 0 && mesh.on_axis(a.orbit) && mesh.on_axis(b.orbit))
          segment = result_.axis_segment();
        if (segment >= 0) mesh.set_segment(key, segment);
      }
    }
  }

  // Volumes that are certainly positive, and angles that close round every edge.
  Result<void> check() {
    const auto report = validate(result_.mesh, ValidationLevel::kEmbedding);
    if (!report) return failed(report.error().message);
    const double volume = report->volume * sector_.fold;
    const double expected = sector_.expected_volume;
    if (expected > 0 && std::abs(volume - expected) > kVolumeToleranceRel * expected) {
      return failed("the volume is " + std::to_string(volume) + " in place of " +
                    std::to_string(expected));
    }
    return {};
  }

  // The faces of a closed surface are all of the boundary; of seeded models some lie in voids.
  Result<void> measure_cover() {
    auto cover = measure_facet_cover(constraints_of(result_.mesh, result_.axis_segment()));
    if (!cover) return failed(cover.error().message);
    result_.cover = std::move(*cover);
    result_.mesh.set_pinched(result_.cover.boundary.touching);
    double reach = 0, low = 0, high = 0;
    for (const Point3& p : sector_.orbit_points) {
      reach = std::max(reach, std::hypot(p.x, p.y));
      low = std::min(low, p.z);
      high = std::max(high, p.z);
    }
    result_.diameter = std::hypot(2 * reach, high - low);
    if (!sector_.nesting_decides) return {};
    const auto wanted = measure_facet_cover(constraints_of_sector());
    if (!wanted) return failed(wanted.error().message);
    const auto same = compare_facet_covers(*wanted, result_.cover, result_.diameter);
    if (!same) return failed(same.error().message);
    return {};
  }

  [[nodiscard]] Constraints constraints_of_sector() const {
    Constraints out;
    out.fold = sector_.fold;
    out.points = sector_.orbit_points;
    for (const std::uint8_t axis : sector_.on_axis) {
      out.on_axis.push_back(sector_.fold > 1 ? axis : 0);
    }
    const auto copy = [&](std::int32_t v) { return sector_.vertices[at(v)]; };
    for (const SectorFace& f : sector_.faces) {
      out.subfacets.push_back({{copy(f.v[0]), copy(f.v[1]), copy(f.v[2])}, f.facet, false});
    }
    for (const SectorEdge& e : sector_.edges) {
      out.subsegments.push_back({copy(e.a), copy(e.b), e.segment});
    }
    return out;
  }

  const Sector& sector_;
  const SectorMesh& sector_mesh_;
  const SectorParts& parts_;
  InitialTetrahedralization result_;
  std::vector<std::int32_t> segment_;  // per orbit
  std::vector<bool> along_axis_;
  std::vector<std::int32_t> facet_;
};

}  // namespace

Result<InitialTetrahedralization> tetrahedralize_sector(const Sector& sector,
                                                        ExecutionContext& context) {
  auto section = initial::make_cut_section(sector);
  if (!section) return error_of(section);
  auto mesh = initial::make_sector_mesh(sector, *section, context);
  if (!mesh) return error_of(mesh);
  auto parts = initial::find_sector_parts(sector, *section, *mesh, context);
  if (!parts) return error_of(parts);
  return Gluer(sector, *mesh, *parts).glue();
}

}  // namespace symcell::solid
