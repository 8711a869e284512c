#include "core/solid/symmetry/axis_cuts.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/base/index.hpp"
#include "core/geometry/resolution.hpp"

namespace symcell::solid {
namespace {

class AxisCutter {
 public:
  AxisCutter(const ComplexImage& image, SymmetricPlc& plc, ExecutionContext& context)
      : image_(image),
        plc_(plc),
        complex_(plc.complex),
        context_(context),
        resolution_(resolution_of(complex_.diameter, complex_.magnitude)) {}

  Result<void> run() {
    for (std::size_t i = 0; i < plc_.vertex.size(); ++i) {
      if (axial(static_cast<std::int32_t>(i))) axis_points_.push_back(static_cast<std::int32_t>(i));
    }
    sort_axis_points();
    split_edges();
    for (std::size_t f = 0; f < complex_.facets.size(); ++f) {
      if (f % 64 == 0) {
        SYMCELL_TRY(context_.check());
      }
      SYMCELL_TRY(cut_facet(static_cast<std::int32_t>(f)));
    }
    if (changed_) rebuild_edges();
    return {};
  }

 private:
  [[nodiscard]] bool axial(std::int32_t point) const {
    return plc_.on_axis[at(plc_.vertex[at(point)].orbit)] != 0;
  }

  void sort_axis_points() {
    std::sort(axis_points_.begin(), axis_points_.end(), [&](std::int32_t i, std::int32_t j) {
      return std::pair(complex_.points[at(i)].z, i) < std::pair(complex_.points[at(j)].z, j);
    });
  }

  // The point of the axis at that height, a new one where there is none.
  std::int32_t axis_point(double z) {
    for (const std::int32_t i : axis_points_) {
      if (std::abs(complex_.points[at(i)].z - z) <= resolution_) return i;
    }
    const auto point = static_cast<std::int32_t>(complex_.points.size());
    complex_.points.push_back({0, 0, z});
    plc_.vertex.push_back({static_cast<std::int32_t>(plc_.orbit_points.size()), 0});
    plc_.orbit_points.push_back({0, 0, z});
    plc_.on_axis.push_back(1);
    axis_points_.push_back(point);
    sort_axis_points();
    return point;
  }

  void split_edges() {
    splits_.assign(complex_.edges.size(), -1);
    for (std::size_t e = 0; e < complex_.edges.size(); ++e) {
      const ComplexEdge& edge = complex_.edges[e];
      const bool turned = image_.edge[e] == static_cast<std::int32_t>(e);
      if (!turned || axial(edge.a) || axial(edge.b)) continue;
      // Half a turn swaps the ends, so that the middle is on the axis.
      const Point3 a = complex_.points[at(edge.a)];
      const Point3 b = complex_.points[at(edge.b)];
      splits_[e] = axis_point(0.5 * (a.z + b.z));
      changed_ = true;
    }
  }

  Result<void> cut_facet(std::int32_t index) {
    ComplexFacet& facet = complex_.facets[at(index)];
    bool touched = false;
    std::vector<IndexPair> segments;
    for (std::size_t s = 0; s < facet.graph.segments.size(); ++s) {
      const IndexPair ends = facet.graph.segments[s];
      const std::int32_t middle = splits_[at(facet.edges[s])];
      if (middle < 0) {
        segments.push_back(ends);
        continue;
      }
      touched = true;
      segments.push_back({std::min(ends[0], middle), std::max(ends[0], middle)});
      segments.push_back({std::min(ends[1], middle), std::max(ends[1], middle)});
    }
    if (touched) facet.graph.segments = std::move(segments);
    if (image_.facet[at(index)] == index) {
      constexpr double kUpright = 0.5;  // the normal is along the axis or normal to it
      const bool level = std::abs(facet.graph.normal.z) >= kUpright;
      if (level ? add_piercing_point(facet) : add_axis_segments(facet)) touched = true;
    }
    if (!touched) return {};
    changed_ = true;
    std::sort(facet.graph.segments.begin(), facet.graph.segments.end());
    auto triangles = triangulate_facet(complex_.points, facet.graph);
    if (!triangles) {
      return fail(ErrorCode::kSelfIntersection,
                  "facet " + std::to_string(facet.source) +
                      " crosses itself once it is cut at the symmetry axis; lower the symmetry "
                      "tolerance or mend the facet",
                  {facet.source}, "/facets/" + std::to_string(facet.source));
    }
    facet.triangles = std::move(*triangles);
    return {};
  }

  bool add_axis_segments(ComplexFacet& facet) {
    std::vector<std::int32_t> points;
    for (const IndexPair& s : facet.graph.segments) {
      for (const std::int32_t i : s) {
        if (axial(i)) points.push_back(i);
      }
    }
    for (const std::int32_t i : facet.graph.points) {
      if (axial(i)) points.push_back(i);
    }
    std::sort(points.begin(), points.end(), [&](std::int32_t i, std::int32_t j) {
      return std::pair(complex_.points[at(i)].z, i) < std::pair(complex_.points[at(j)].z, j);
    });
    points.erase(std::unique(points.begin(), points.end()), points.end());
    bool added = false;
    for (std::size_t i = 1; i < points.size(); ++i) {
      const IndexPair piece{std::min(points[i - 1], points[i]), std::max(points[i - 1], points[i])};
      const auto& known = facet.graph.segments;
      if (std::find(known.begin(), known.end(), piece) != known.end()) continue;
      const double z = 0.5 * (complex_.points[at(piece[0])].z + complex_.points[at(piece[1])].z);
      if (!covers(complex_.points, facet, {0, 0, z})) continue;
      facet.graph.segments.push_back(piece);
      added = true;
    }
    if (added) {
      std::erase_if(facet.graph.points, [&](std::int32_t i) {
        return std::any_of(facet.graph.segments.begin(), facet.graph.segments.end(),
                           [i](const IndexPair& s) { return s[0] == i || s[1] == i; });
      });
    }
    return added;
  }

  bool add_piercing_point(ComplexFacet& facet) {
    for (const IndexPair& s : facet.graph.segments) {
      if (axial(s[0]) || axial(s[1])) return false;
    }
    for (const std::int32_t i : facet.graph.points) {
      if (axial(i)) return false;
    }
    const Point3 n = facet.graph.normal;
    const Point3 p = complex_.points[at(facet.graph.segments.front()[0])];
    const double z = p.z + (n.x * p.x + n.y * p.y) / n.z;
    if (!covers(complex_.points, facet, {0, 0, z})) return false;
    facet.graph.points.push_back(axis_point(z));
    return true;
  }

  void rebuild_edges() {
    std::vector<ComplexEdge> edges;
    for (std::size_t e = 0; e < complex_.edges.size(); ++e) {
      const ComplexEdge& edge = complex_.edges[e];
      if (splits_[e] < 0) {
        edges.push_back(edge);
        continue;
      }
      for (const std::int32_t end : {edge.a, edge.b}) {
        edges.push_back({std::min(end, splits_[e]), std::max(end, splits_[e]), edge.marker});
      }
    }
    complex_.edges = std::move(edges);
    collect_facet_edges(complex_);
  }

  const ComplexImage& image_;
  SymmetricPlc& plc_;
  PlcComplex& complex_;
  ExecutionContext& context_;
  double resolution_;                      // points of the axis nearer than this are one
  std::vector<std::int32_t> axis_points_;  // by height
  std::vector<std::int32_t> splits_;       // per edge: the axis point that cuts it, -1: none
  bool changed_ = false;
};

}  // namespace

Result<void> cut_at_axis(const ComplexImage& image, SymmetricPlc& plc, ExecutionContext& context) {
  return AxisCutter(image, plc, context).run();
}

}  // namespace symcell::solid
