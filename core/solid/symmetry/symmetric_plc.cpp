#include "core/solid/symmetry/symmetric_plc.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "core/base/index.hpp"
#include "core/geometry/rotation.hpp"
#include "core/solid/symmetry/axis_cuts.hpp"

namespace symcell::solid {
namespace {

// The representative of each orbit is the mean of its copies turned back.
std::vector<Point3> average_orbits(const PlcComplex& complex,
                                   const PlcFit& fit,
                                   const RotationTable& rotations) {
  std::vector<Point3> sums(fit.on_axis.size());
  std::vector<std::int32_t> counts(fit.on_axis.size(), 0);
  for (std::size_t i = 0; i < complex.points.size(); ++i) {
    const OrbitVertex v = fit.vertex[i];
    const Point3 local = fit.frame.to_local(complex.points[i]);
    const auto o = at(v.orbit);
    sums[o] = sums[o] + rotations.rotate(local, rotations.reduce(-std::int64_t{v.exponent}));
    ++counts[o];
  }
  for (std::size_t o = 0; o < sums.size(); ++o) {
    sums[o] = (1 / static_cast<double>(counts[o])) * sums[o];
    if (fit.on_axis[o] != 0) sums[o] = {0, 0, sums[o].z};
  }
  return sums;
}

Point3 turned_to_local(const AxisFrame& frame, Point3 direction) {
  AxisFrame bare = frame;
  bare.origin = {0, 0, 0};
  return bare.to_local(direction);
}

void move_to_local(const AxisFrame& frame, PlcComplex& complex) {
  for (ComplexFacet& facet : complex.facets) {
    facet.graph.normal = turned_to_local(frame, facet.graph.normal);
    for (Point3& hole : facet.graph.holes) hole = frame.to_local(hole);
  }
  for (Point3& hole : complex.holes) hole = frame.to_local(hole);
  for (PlcRegion& region : complex.regions) region.point = frame.to_local(region.point);
}

void place_points(const RotationTable& rotations, SymmetricPlc& plc) {
  for (std::size_t i = 0; i < plc.vertex.size(); ++i) {
    const OrbitVertex v = plc.vertex[i];
    plc.complex.points[i] = rotations.rotate(plc.orbit_points[at(v.orbit)], v.exponent);
  }
}

std::vector<std::int32_t> point_images(const SymmetricPlc& plc, std::int32_t fold) {
  std::vector<std::vector<std::int32_t>> copies(plc.orbit_points.size());
  for (std::size_t o = 0; o < copies.size(); ++o) {
    copies[o].resize(plc.on_axis[o] != 0 ? 1 : static_cast<std::size_t>(fold));
  }
  for (std::size_t i = 0; i < plc.vertex.size(); ++i) {
    copies[at(plc.vertex[i].orbit)][at(plc.vertex[i].exponent)] = static_cast<std::int32_t>(i);
  }
  std::vector<std::int32_t> image;
  for (const OrbitVertex v : plc.vertex) {
    const auto& orbit = copies[at(v.orbit)];
    image.push_back(orbit[(at(v.exponent) + 1) % orbit.size()]);
  }
  return image;
}

void number_orbits(const ComplexImage& image, std::int32_t fold, SymmetricPlc& plc) {
  plc.edge_orbit.assign(image.edge.size(), -1);
  for (std::size_t e = 0; e < image.edge.size(); ++e) {
    if (plc.edge_orbit[e] >= 0) continue;
    const auto orbit = static_cast<std::int32_t>(plc.edge_of.size());
    plc.edge_of.push_back(static_cast<std::int32_t>(e));
    for (auto i = static_cast<std::int32_t>(e); plc.edge_orbit[at(i)] < 0; i = image.edge[at(i)]) {
      plc.edge_orbit[at(i)] = orbit;
    }
  }
  std::vector<std::uint8_t> seen(image.facet.size(), 0);
  for (std::size_t f = 0; f < image.facet.size(); ++f) {
    if (seen[f] != 0) continue;
    std::int32_t copies = 0;
    for (auto i = static_cast<std::int32_t>(f); seen[at(i)] == 0; i = image.facet[at(i)]) {
      seen[at(i)] = 1;
      ++copies;
    }
    plc.facet_orbits.push_back({static_cast<std::int32_t>(f), fold / copies});
  }
}

// A facet that turns onto itself about its normal is level; orbits of the same facet get the same
// height, which the averages have but for rounding and the input's error.
void level_turning_facets(SymmetricPlc& plc) {
  std::vector<std::int32_t> parent(plc.orbit_points.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](std::int32_t o) {
    while (parent[at(o)] != o) o = parent[at(o)] = parent[at(parent[at(o)])];
    return o;
  };
  for (const FacetOrbit& orbit : plc.facet_orbits) {
    const FacetGraph& graph = plc.complex.facets[at(orbit.facet)].graph;
    constexpr double kUpright = 0.5;  // the normal is along the axis or normal to it
    if (orbit.self_copies < 2 || std::abs(graph.normal.z) < kUpright) continue;
    const std::int32_t first = plc.vertex[at(graph.segments.front()[0])].orbit;
    const auto join = [&](std::int32_t point) {
      parent[at(root(plc.vertex[at(point)].orbit))] = root(first);
    };
    for (const IndexPair& s : graph.segments) {
      join(s[0]);
      join(s[1]);
    }
    for (const std::int32_t p : graph.points) join(p);
  }
  std::vector<double> sum(parent.size(), 0);
  std::vector<std::int32_t> count(parent.size(), 0);
  for (std::size_t o = 0; o < parent.size(); ++o) {
    const std::size_t r = at(root(static_cast<std::int32_t>(o)));
    sum[r] += plc.orbit_points[o].z;
    ++count[r];
  }
  for (std::size_t o = 0; o < parent.size(); ++o) {
    const std::size_t r = at(root(static_cast<std::int32_t>(o)));
    if (count[r] > 1) plc.orbit_points[o].z = sum[r] / count[r];
  }
}

}  // namespace

Result<SymmetricPlc> make_symmetric_plc(const PlcComplex& complex,
                                        const PlcFit& fit,
                                        bool ignore_markers,
                                        ExecutionContext& context) {
  SymmetricPlc plc;
  plc.symmetry.fold = fit.fold;
  plc.symmetry.frame = fit.frame;
  plc.symmetry.diameter = complex.diameter;
  plc.symmetry.error_rel = complex.diameter > 0 ? fit.error / complex.diameter : 0;
  plc.ignore_markers = ignore_markers;
  plc.complex = complex;
  plc.vertex = fit.vertex;
  plc.on_axis = fit.on_axis;
  const RotationTable rotations(fit.fold);
  plc.orbit_points = average_orbits(complex, fit, rotations);
  move_to_local(fit.frame, plc.complex);
  place_points(rotations, plc);
  const auto map = [&] {
    return map_complex(plc.complex, point_images(plc, fit.fold), ignore_markers);
  };
  ComplexImage image = map();
  if (fit.fold > 1 && !image.mismatch) {
    SYMCELL_TRY(cut_at_axis(image, plc, context));
    image = map();
  }
  if (image.mismatch) {
    return fail(ErrorCode::kNotSymmetric,
                "cut at its axis the model is not symmetric: " + *image.mismatch, image.elements);
  }
  number_orbits(image, fit.fold, plc);
  if (fit.fold > 1) {
    level_turning_facets(plc);
    place_points(rotations, plc);
  }
  return plc;
}

}  // namespace symcell::solid
