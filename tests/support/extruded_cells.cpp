#include "tests/support/extruded_cells.hpp"

#include <algorithm>
#include <limits>

#include "core/cell/full_mesh.hpp"
#include "tests/support/sample_cells.hpp"

namespace symcell::test {
namespace {

class Extruder {
 public:
  Extruder(const SymmetryCellMesh& planar, const Extrusion& how)
      : planar_(planar), how_(how), rotations_(planar.fold) {}

  SymmetryCellMesh run() {
    out_.dimension = 3;
    out_.fold = planar_.fold;
    out_.axis_origin = how_.frame.origin;
    out_.axis_direction = how_.frame.direction();
    out_.frame = how_.frame.matrix;
    out_.nodes_per_element = 4;
    out_.nodes_per_facet = 3;
    for (std::int32_t layer = 0; layer <= how_.layers; ++layer) add_nodes(layer);
    for (std::int32_t layer = 0; layer < how_.layers; ++layer) add_layer(layer);
    for (std::size_t e = 0; e < planar_.element_count(); ++e) {
      add_plane_facet(e, 0, kBottomMarker);
      add_plane_facet(e, how_.layers, kTopMarker);
      if (how_.plate) add_plane_facet(e, 1, kPlateMarker);
    }
    out_.boundary_is_higher_image.assign(out_.boundary_markers.size(), 0);
    mark_nodes();
    return std::move(out_);
  }

 private:
  [[nodiscard]] std::int32_t node(std::int32_t planar, std::int32_t layer) const {
    return layer * static_cast<std::int32_t>(planar_.nodes.size()) + planar;
  }

  // An order of a triangle's corners that every rotation keeps: neighbours choose one diagonal.
  [[nodiscard]] bool before(std::int32_t a, std::int32_t b) const {
    const OrbitVertex u = planar_.nodes[static_cast<std::size_t>(a)];
    const OrbitVertex v = planar_.nodes[static_cast<std::size_t>(b)];
    if (u.orbit != v.orbit) return u.orbit < v.orbit;
    return rotations_.subtract(v.exponent, u.exponent) <
           rotations_.subtract(u.exponent, v.exponent);
  }

  void add_nodes(std::int32_t layer) {
    const auto orbits = static_cast<std::int32_t>(planar_.orbit_points.size());
    const double z = how_.height * layer / how_.layers;
    for (const Point3& p : planar_.orbit_points) out_.orbit_points.push_back({p.x, p.y, z});
    out_.on_axis.insert(out_.on_axis.end(), planar_.on_axis.begin(), planar_.on_axis.end());
    for (std::size_t i = 0; i < planar_.nodes.size(); ++i) {
      const OrbitVertex v = planar_.nodes[i];
      out_.nodes.push_back({layer * orbits + v.orbit, v.exponent});
      const std::int32_t image = planar_.lower_to_higher[i];
      out_.lower_to_higher.push_back(image < 0 ? -1 : node(image, layer));
    }
  }

  void add_layer(std::int32_t layer) {
    for (std::size_t e = 0; e < planar_.element_count(); ++e) {
      std::array<std::int32_t, 3> v{planar_.elements[3 * e], planar_.elements[3 * e + 1],
                                    planar_.elements[3 * e + 2]};
      std::ranges::sort(v, [&](std::int32_t a, std::int32_t b) { return before(a, b); });
      std::array<std::int32_t, 3> low{}, high{};
      for (std::size_t i = 0; i < 3; ++i) {
        low[i] = node(v[i], layer);
        high[i] = node(v[i], layer + 1);
      }
      const std::int32_t region = planar_.regions[e] + (how_.plate && layer > 0 ? 10 : 0);
      add_tetrahedron({low[0], low[1], low[2], high[2]}, region);
      add_tetrahedron({low[0], low[1], high[1], high[2]}, region);
      add_tetrahedron({low[0], high[0], high[1], high[2]}, region);
    }
    const auto sides = [&](const std::vector<std::int32_t>& edges,
                           std::vector<std::int32_t>& facets) {
      for (std::size_t i = 0; i < edges.size(); i += 2) {
        std::int32_t a = edges[i], b = edges[i + 1];
        if (before(b, a)) std::swap(a, b);
        facets.insert(facets.end(), {node(a, layer), node(b, layer), node(b, layer + 1)});
        facets.insert(facets.end(), {node(a, layer), node(b, layer + 1), node(a, layer + 1)});
      }
    };
    sides(planar_.boundary, out_.boundary);
    sides(planar_.lower_facets, out_.lower_facets);
    sides(planar_.higher_facets, out_.higher_facets);
    for (const std::int32_t marker : planar_.boundary_markers) {
      out_.boundary_markers.insert(out_.boundary_markers.end(), 2, marker);
    }
  }

  void add_tetrahedron(std::array<std::int32_t, 4> t, std::int32_t region) {
    const auto local = [&](std::int32_t i) {
      const OrbitVertex v = out_.nodes[static_cast<std::size_t>(i)];
      return rotations_.rotate(out_.orbit_points[static_cast<std::size_t>(v.orbit)], v.exponent);
    };
    const Point3 a = local(t[0]);
    if (dot(cross(local(t[1]) - a, local(t[2]) - a), local(t[3]) - a) < 0) std::swap(t[0], t[1]);
    out_.elements.insert(out_.elements.end(), t.begin(), t.end());
    out_.regions.push_back(region);
  }

  void add_plane_facet(std::size_t element, std::int32_t layer, std::int32_t marker) {
    for (std::size_t i = 0; i < 3; ++i) {
      out_.boundary.push_back(node(planar_.elements[3 * element + i], layer));
    }
    out_.boundary_markers.push_back(marker);
  }

  void mark_nodes() {
    std::vector<std::int32_t> of_orbit(out_.orbit_points.size(), 0);
    for (std::size_t i = 0; i < out_.boundary.size(); ++i) {
      const OrbitVertex v = out_.nodes[static_cast<std::size_t>(out_.boundary[i])];
      std::int32_t& marker = of_orbit[static_cast<std::size_t>(v.orbit)];
      const std::int32_t own = out_.boundary_markers[i / 3];
      if (own != 0 && (marker == 0 || own < marker)) marker = own;
    }
    for (const OrbitVertex& v : out_.nodes) {
      out_.node_markers.push_back(of_orbit[static_cast<std::size_t>(v.orbit)]);
    }
  }

  const SymmetryCellMesh& planar_;
  const Extrusion& how_;
  RotationTable rotations_;
  SymmetryCellMesh out_;
};

// The closed polygons of a model whose segments follow one another.
std::vector<std::vector<std::int32_t>> polygons_of(const Pslg& planar) {
  std::vector<std::vector<std::int32_t>> polygons(1);
  for (const PslgSegment& s : planar.segments) {
    polygons.back().push_back(s.a);
    if (s.b == polygons.back().front()) polygons.emplace_back();
  }
  polygons.pop_back();
  return polygons;
}

SolidSample sample(const char* name,
                   const SymmetryCellMesh& planar,
                   const Pslg& model,
                   const Extrusion& how) {
  return {name, extruded_model(model, how), extruded_cell(planar, how),
          extruded_volume(model, how)};
}

}  // namespace

SymmetryCellMesh extruded_cell(const SymmetryCellMesh& planar, const Extrusion& how) {
  return Extruder(planar, how).run();
}

Plc extruded_model(const Pslg& planar, const Extrusion& how) {
  Plc model;
  const auto count = static_cast<std::int32_t>(planar.vertices.size());
  std::vector<double> heights{0};
  if (how.plate) heights.push_back(how.height / how.layers);
  heights.push_back(how.height);
  for (const double z : heights) {
    for (const Point2& p : planar.vertices) {
      model.vertices.push_back(how.frame.to_model({p.x, p.y, z}));
    }
  }
  const auto levels = static_cast<std::int32_t>(heights.size());
  const auto polygons = polygons_of(planar);
  for (std::int32_t level = 0; level < levels; ++level) {
    PlcFacet facet;
    for (std::vector<std::int32_t> polygon : polygons) {
      for (std::int32_t& v : polygon) v += level * count;
      facet.polygons.push_back(std::move(polygon));
    }
    for (const Point2& hole : planar.holes) {
      facet.holes.push_back(
          how.frame.to_model({hole.x, hole.y, heights[static_cast<std::size_t>(level)]}));
    }
    facet.marker = level == 0 ? kBottomMarker : level + 1 == levels ? kTopMarker : kPlateMarker;
    model.facets.push_back(std::move(facet));
  }
  for (const PslgSegment& s : planar.segments) {
    for (std::int32_t level = 0; level + 1 < levels; ++level) {
      const std::int32_t low = level * count, high = low + count;
      model.facets.push_back({{{s.a + low, s.b + low, s.b + high, s.a + high}}, {}, s.marker});
    }
  }
  for (std::int32_t level = 0; level + 1 < levels; ++level) {
    const auto at = static_cast<std::size_t>(level);
    const double z = 0.5 * (heights[at] + heights[at + 1]);
    for (const PslgRegion& r : planar.regions) {
      model.regions.push_back({how.frame.to_model({r.point.x, r.point.y, z}),
                               r.attribute + 10 * level, std::numeric_limits<double>::infinity()});
    }
  }
  return model;
}

double extruded_volume(const Pslg& planar, const Extrusion& how) {
  double area = 0;
  double sign = 1;
  const auto polygons = polygons_of(planar);
  for (auto polygon = polygons.rbegin(); polygon != polygons.rend(); ++polygon, sign = -1) {
    for (std::size_t i = 0; i < polygon->size(); ++i) {
      const auto vertex = [&](std::size_t j) {
        return planar.vertices[static_cast<std::size_t>((*polygon)[j % polygon->size()])];
      };
      area += sign * 0.5 * cross(vertex(i), vertex(i + 1));
    }
  }
  return area * how.height;
}

std::vector<SolidSample> solid_samples() {
  RingShape six;
  six.swirl = 0.3;
  RingShape five;
  five.fold = 5;
  five.steps = 1;
  five.layers = 1;
  RingShape two;
  two.fold = 2;
  two.steps = 6;
  RingShape one;
  one.fold = 1;
  one.steps = 12;
  Extrusion plain;
  Extrusion skew;
  skew.plate = true;
  skew.frame = AxisFrame::of_axis({3, -2, 5}, {1, 2, -2});
  Extrusion far;
  far.layers = 3;
  far.frame = AxisFrame::of_axis({1e3, 2e3, -5e2}, {-3, 0.5, 0.25});
  // Seeds of rings: without them their one region has no attribute to check.
  Pslg two_model = ring_model(two);
  two_model.regions.push_back({{1.5, 0.1}, 0, std::numeric_limits<double>::infinity()});
  return {sample("ring6", ring_cell(six), ring_model(six), plain),
          sample("ring5", ring_cell(five), ring_model(five), plain),
          sample("ring2", ring_cell(two), two_model, skew),
          sample("ring1", ring_cell(one), ring_model(one), plain),
          sample("prism5", disc_cell(5, 2, {0, 0}), disc_model(5, 2, {0, 0}), plain),
          sample("prism3", disc_cell(3, 4, {0, 0}), disc_model(3, 4, {0, 0}), far)};
}

}  // namespace symcell::test
