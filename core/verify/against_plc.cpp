// A full mesh of tetrahedra against its PLC: every facet, segment and vertex that the meshed domain
// has is there, and the mesh ends where the domain does.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/index.hpp"
#include "core/geometry/point_tree.hpp"
#include "core/geometry/triangle_tree.hpp"
#include "core/verify/against_model.hpp"

namespace symcell::internal {
namespace {

// Where samples of a segment lie that no facet bears.
constexpr std::array<double, 5> kSegmentSamples{0.137, 0.381, 0.5, 0.618, 0.893};
// The area that mesh faces cover of a facet may differ by this share, or by this many tolerances
// per diameter, as far as nodes at its rim may be moved.
constexpr double kAreaRel = 1e-8;
constexpr double kAreaTolerances = 16;

class PlcChecker {
 public:
  PlcChecker(const FacetedMesh& full,
             const PlcModel& model,
             double tolerance,
             double diameter,
             Checks& checks)
      : full_(full),
        mesh_(full.mesh),
        plc_(model),
        model_(model.valid.complex),
        tolerance_(tolerance + model.off_plane),
        area_share_(std::max(kAreaRel, kAreaTolerances * tolerance / diameter)),
        checks_(checks),
        part_of_(full.group_count(), -1) {}

  std::vector<char> run() {
    collect_parts();
    match_faces();
    check_areas();
    match_vertices();
    cover_segments();
    check_loose();
    check_boundary();
    std::vector<char> constrained(part_of_.size());
    std::ranges::transform(part_of_, constrained.begin(),
                           [](std::int32_t part) { return static_cast<char>(part >= 0); });
    std::vector<RegionSeed> regions;
    for (const PlcRegion& r : model_.regions) {
      regions.push_back({r.point, r.attribute, r.max_volume});
    }
    check_regions(full_, constrained, model_.holes, regions, checks_);
    return constrained;
  }

 private:
  // A part of a facet that segments bound.
  struct Part {
    std::int32_t facet = 0;  // of the input
    Point3 origin, normal;   // of the facet's plane
    double area = 0;
    double covered = 0;   // by faces of the mesh
    bool needed = false;  // meshed on a side
    bool bounds = false;  // on one side only
  };

  [[nodiscard]] std::array<Point3, 3> corners(const Triangle& t) const {
    return {model_.points[at(t[0])], model_.points[at(t[1])], model_.points[at(t[2])]};
  }

  static double area_of(const std::array<Point3, 3>& p) {
    return 0.5 * length(area_normal(p[0], p[1], p[2]));
  }

  void collect_parts() {
    needed_edge_.assign(model_.edges.size(), 0);
    for (std::size_t f = 0; f < model_.facets.size(); ++f) {
      const solid::ComplexFacet& facet = model_.facets[f];
      const std::size_t first = parts_.size();
      parts_.resize(first + at(facet.triangles.piece_count));
      for (std::size_t t = 0; t < facet.triangles.triangles.size(); ++t) {
        const auto [front, back] = plc_.valid.cells.sides[f][t];
        const bool before = plc_.meshed(front), behind = plc_.meshed(back);
        const std::size_t index = first + at(facet.triangles.piece[t]);
        Part& part = parts_[index];
        part.facet = facet.source;
        part.origin = model_.points[at(facet.graph.segments.front()[0])];
        part.normal = (1 / length(facet.graph.normal)) * facet.graph.normal;
        part.area += area_of(corners(facet.triangles.triangles[t]));
        part.needed = before || behind;
        part.bounds = before != behind;
        triangles_.push_back(facet.triangles.triangles[t]);
        part_of_triangle_.push_back(static_cast<std::int32_t>(index));
      }
      mark_needed_edges(f, first);
    }
  }

  void mark_needed_edges(std::size_t f, std::size_t first_part) {
    const solid::ComplexFacet& facet = model_.facets[f];
    for (std::size_t s = 0; s < facet.edges.size(); ++s) {
      for (const std::int32_t t : plc_.valid.cells.borders[f][s]) {
        if (t < 0) continue;
        const Part& part = parts_[first_part + at(facet.triangles.piece[at(t)])];
        if (part.needed) needed_edge_[at(facet.edges[s])] = 1;
      }
    }
  }

  // A face of the mesh lies on a part of a facet if its corners do and its middle does.
  void match_faces() {
    const TriangleTree tree(model_.points, triangles_);
    std::vector<char> near(mesh_.points.size(), 0);
    std::int32_t last = -1;
    for (std::size_t i = 0; i < near.size(); ++i) {
      near[i] = tree.within(mesh_.points[i], tolerance_, last) ? 1 : 0;
    }
    for (std::size_t g = 0; g < full_.group_count(); ++g) {
      const bool all = std::ranges::all_of(full_.first(g).nodes,
                                           [&](std::int32_t i) { return near[at(i)] != 0; });
      if (!all) continue;
      const std::array<Point3, 3> p = full_.triangle(g);
      const auto hit = tree.nearest((1.0 / 3) * (p[0] + p[1] + p[2]), tolerance_, last);
      if (hit.triangle < 0) continue;
      const std::int32_t part = part_of_triangle_[at(hit.triangle)];
      if (!in_plane(p, parts_[at(part)])) continue;
      part_of_[g] = part;
      parts_[at(part)].covered += area_of(p);
    }
  }

  // The facet's own plane, as thin triangles of it tell theirs badly.
  [[nodiscard]] bool in_plane(const std::array<Point3, 3>& p, const Part& part) const {
    return std::ranges::all_of(p, [&](const Point3& corner) {
      return std::abs(dot(part.normal, corner - part.origin)) <= 2 * tolerance_;
    });
  }

  void check_areas() {
    Flaws flaws;
    for (const Part& part : parts_) {
      if (!part.needed || std::abs(part.covered - part.area) <= area_share_ * part.area) continue;
      flaws.note([&] {
        return "facet " + std::to_string(part.facet) + ": faces of the mesh cover " +
               shown(part.covered) + " of a part of " + shown(part.area);
      });
    }
    flaws.report(checks_, "model.facets");
  }

  void match_vertices() {
    const PointTree tree(mesh_.points);
    std::vector<char> needed(model_.points.size(), 0);
    for (std::size_t e = 0; e < model_.edges.size(); ++e) {
      if (needed_edge_[e] == 0) continue;
      needed[at(model_.edges[e].a)] = needed[at(model_.edges[e].b)] = 1;
    }
    node_of_.assign(model_.points.size(), -1);
    for (std::size_t v = 0; v < needed.size(); ++v) {
      const auto hit = tree.nearest(model_.points[v]);
      if (hit.distance <= tolerance_) {
        node_of_[v] = hit.point;
      } else if (needed[v] != 0) {
        vertices_.note([&] {
          return "vertex " + std::to_string(v) +
                 " of the model is no node; the nearest is off by " + shown(hit.distance);
        });
      } else {
        loose_.push_back({model_.points[v], static_cast<std::int32_t>(v), -1});
      }
    }
  }

  void cover_segments() {
    const NodeGraph graph(mesh_);
    for (std::size_t s = 0; s < model_.edges.size(); ++s) {
      const solid::ComplexEdge& e = model_.edges[s];
      const std::int32_t from = node_of_[at(e.a)], to = node_of_[at(e.b)];
      if (from >= 0 && to >= 0 && !straight_chain(mesh_, graph, from, to, tolerance_).empty()) {
        continue;
      }
      if (needed_edge_[s] != 0) {
        segments_.note([&] { return segment_name(s) + " is no chain of edges"; });
        continue;
      }
      const Point3& a = model_.points[at(e.a)];
      const Point3& b = model_.points[at(e.b)];
      for (const double t : kSegmentSamples) {
        loose_.push_back({a + t * (b - a), -1, static_cast<std::int32_t>(s)});
      }
    }
  }

  [[nodiscard]] std::string segment_name(std::size_t s) const {
    return "the segment from vertex " + std::to_string(model_.edges[s].a) + " to " +
           std::to_string(model_.edges[s].b);
  }

  // Vertices and samples of segments that no meshed facet bears: they must lie in no element.
  struct Loose {
    Point3 point;
    std::int32_t vertex = -1;
    std::int32_t segment = -1;
  };

  void check_loose() {
    std::vector<Point3> points;
    for (const Loose& l : loose_) points.push_back(l.point);
    each_holding_element(mesh_, points, [&](std::size_t i, std::size_t e) {
      const Loose& l = loose_[i];
      const std::string element = " but lies in element " + std::to_string(e);
      if (l.segment >= 0) {
        segments_.note([&] { return segment_name(at(l.segment)) + " is no edge" + element; });
      } else {
        vertices_.note(
            [&] { return "vertex " + std::to_string(l.vertex) + " is no node" + element; });
      }
    });
    vertices_.report(checks_, "model.vertices");
    segments_.report(checks_, "model.segments");
  }

  void check_boundary() {
    Flaws outside, inside;
    for (std::size_t g = 0; g < full_.group_count(); ++g) {
      const bool bounds = part_of_[g] >= 0 && parts_[at(part_of_[g])].bounds;
      const auto name = [&] { return facet_name(full_.first(g).nodes); };
      if (full_.sides(g) == 1 && !bounds) {
        outside.note([&] {
          return "boundary " + name() + " of the mesh lies on no facet that bounds the domain";
        });
      }
      if (full_.sides(g) != 1 && bounds) {
        inside.note(
            [&] { return name() + " has elements on both sides, but the domain ends there"; });
      }
    }
    outside.report(checks_, "model.boundary");
    inside.report(checks_, "model.boundary_complete");
  }

  const FacetedMesh& full_;
  const MeshData& mesh_;
  const PlcModel& plc_;
  const solid::PlcComplex& model_;
  double tolerance_;
  double area_share_;
  Checks& checks_;
  std::vector<std::int32_t> part_of_;  // per face of the mesh, -1: on none
  std::vector<Part> parts_;
  std::vector<Triangle> triangles_;  // of all facets
  std::vector<std::int32_t> part_of_triangle_;
  std::vector<char> needed_edge_;
  std::vector<std::int32_t> node_of_;  // per vertex of the model, -1: none
  std::vector<Loose> loose_;
  Flaws vertices_, segments_;
};

}  // namespace

std::vector<char> check_model(const FacetedMesh& full,
                              const PlcModel& model,
                              double tolerance,
                              double diameter,
                              Checks& checks) {
  return PlcChecker(full, model, tolerance, diameter, checks).run();
}

}  // namespace symcell::internal
