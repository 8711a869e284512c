// A model as the checks of verify_mesh take it: what can be computed from the model alone, by code
// that no mesh is made with. Included by the parts of verify_mesh only.
#pragma once

#include <functional>
#include <optional>
#include <variant>
#include <vector>

#include "core/base/error.hpp"
#include "core/geometry/axis_frame.hpp"
#include "core/geometry/indexed_surface.hpp"
#include "core/model/model.hpp"
#include "core/plane/input/subdomains.hpp"
#include "core/solid/plc/validate_plc.hpp"
#include "core/verify/support.hpp"

namespace symcell::internal {

struct PlanarModel {
  const Pslg* pslg = nullptr;
  plane::Subdomains subdomains;
  bool by_shape = false;  // its vertices need not be nodes: outlines are compared

  // Whether the domain is on a side of the map's piece.
  [[nodiscard]] bool meshed_beside(std::size_t piece) const {
    const auto half_edge = static_cast<std::int32_t>(2 * piece);
    return subdomains.left_of(half_edge).meshed || subdomains.left_of(half_edge + 1).meshed;
  }
};

struct PlcModel {
  const Plc* given = nullptr;
  solid::ValidPlc valid;
  double off_plane = 0;  // farthest a facet's vertices lie off its plane

  [[nodiscard]] bool meshed(std::int32_t cell) const {
    return valid.cells.cells[static_cast<std::size_t>(cell)].meshed;
  }
};

struct SurfaceModel {
  const TriangleSurface* given = nullptr;
  IndexedSurface welded;
  bool manifold = false;  // each edge has two triangles, which agree
  // It intersects itself: what it bounds is known only once it is mended. Parts of it may then lie
  // within the solid.
  bool crosses = false;
};

struct ModelFacts {
  double diameter = 0;                // of the bounding box
  std::optional<double> measure;      // area or volume of what is meshed, where it is enclosed
  double boundary_size = 0;           // length or area of its boundary
  std::optional<std::size_t> pieces;  // parts that hang together by facets
  ModelPinches pinches;               // without a tolerance yet
};

struct ExaminedModel {
  ModelFacts facts;
  std::variant<PlanarModel, PlcModel, SurfaceModel> geometry;
};

// Errors: those of a model that cannot be meshed.  `model` must outlive the result.
// Cost: O(N log N).
[[nodiscard]] Result<ExaminedModel> examine_model(const Model& model);

// The surface of all sectors of which the given one bounds one; see solid::make_whole.
// `tolerance_rel`: of the sector's diameter.
[[nodiscard]] Result<TriangleSurface> all_sectors(const TriangleSurface& sector,
                                                  std::int32_t sectors,
                                                  const AxisFrame& axis,
                                                  double tolerance_rel);

// Per vertex whether it belongs to the domain: at a segment with the domain on a side, or loose
// within it. Others, where a dangling segment may end, need not be nodes.
[[nodiscard]] std::vector<char> vertices_of_domain(const PlanarModel& model);

// By how much vertices of the model, of a PSLG those of its domain, miss their images under `rotate`,
// near misses only; of a surface 0, as its vertices need not be symmetric.
[[nodiscard]] double model_asymmetry(const ExaminedModel& model,
                                     const std::function<Point3(const Point3&)>& rotate);

// Triangles of a solid model, each with or without material on the side its normal looks to
// (first) and on the other.
struct SidedTriangles {
  std::span<const Point3> points;
  std::vector<Triangle> triangles;
  std::vector<std::array<bool, 2>> material;
};
// Edges and vertices at which the material falls apart.  Requires: triangles meet in common edges
// and vertices only.  Cost: O(N log N); squares of the triangles at a vertex that pinches.
[[nodiscard]] ModelPinches find_model_pinches(const SidedTriangles& solid);

// Shells that hang together by edges, and the Euler characteristic V - E + F, a vertex counted once for each
// fan of triangles that hang together by edges there: bodies that touch in a vertex are meshed apart.
struct SurfaceTopology {
  std::size_t shells = 0;
  std::int64_t euler = 0;
  friend bool operator==(const SurfaceTopology&, const SurfaceTopology&) = default;
};
[[nodiscard]] SurfaceTopology topology_of(std::span<const Triangle> triangles);

// model.*: the full mesh against the model. Return, per group of equal facets, whether it is
// constrained; the mesh's dimension is that of the model.
std::vector<char> check_model(const FacetedMesh& full,
                              const PlanarModel& model,
                              double tolerance,
                              double diameter,
                              Checks& checks);
std::vector<char> check_model(const FacetedMesh& full,
                              const PlcModel& model,
                              double tolerance,
                              double diameter,
                              Checks& checks);
std::vector<char> check_model(const FacetedMesh& full,
                              const SurfaceModel& model,
                              double tolerance,
                              double diameter,
                              Checks& checks);

struct AngleBound {
  double min_angle_deg = 0;
  double place = 0;  // distance at which a node is at the centre
};
// full.min_angle: angles below the bound are those that the model forces: in corners of it that are
// narrower, across them, and at the centre that of 360/n.  Requires: a planar mesh.
void check_angles(const FacetedMesh& full,
                  const std::vector<char>& constrained,
                  const AngleBound& bound,
                  Checks& checks);

struct RegionSeed {
  Point3 point;
  std::int32_t attribute = 0;
  double max_measure = 0;  // inf: none
};
// model.holes, .regions, .region_borders, .region_measure: what the seeds say of the elements, up
// to the constrained facets.
void check_regions(const FacetedMesh& full,
                   const std::vector<char>& constrained,
                   const std::vector<Point3>& holes,
                   const std::vector<RegionSeed>& regions,
                   Checks& checks);

// f(point, element) for each point and element that holds it, its boundary included.
void each_holding_element(const MeshData& mesh,
                          const std::vector<Point3>& points,
                          const std::function<void(std::size_t, std::size_t)>& f);

// The neighbours of each node along edges.
class NodeGraph {
 public:
  explicit NodeGraph(const MeshData& mesh);
  [[nodiscard]] std::span<const std::int32_t> around(std::int32_t node) const {
    const std::size_t first = first_[static_cast<std::size_t>(node)];
    const std::size_t end = first_[static_cast<std::size_t>(node) + 1];
    return {around_.data() + first, end - first};
  }

 private:
  std::vector<std::size_t> first_;
  std::vector<std::int32_t> around_;
};

// The chain of mesh edges within `tolerance` of the straight line from one node to another, each
// step ahead; empty if there is none.
[[nodiscard]] std::vector<std::int32_t> straight_chain(const MeshData& mesh,
                                                       const NodeGraph& graph,
                                                       std::int32_t from,
                                                       std::int32_t to,
                                                       double tolerance);

}  // namespace symcell::internal
