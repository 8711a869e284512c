#include "core/solid/symmetry/plc_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/base/index.hpp"
#include "core/geometry/rotation.hpp"
#include "core/model/describe.hpp"

namespace symcell::solid {
namespace {

// A facet up to the order of its parts: its segments with the number of their inner sides, and its
// lone points (second entry -1).
using Signature = std::vector<std::pair<std::int32_t, std::int32_t>>;

template <class EdgeMap, class PointMap>
Signature signature_of(const ComplexFacet& facet, EdgeMap edge, PointMap point) {
  Signature result;
  for (std::size_t s = 0; s < facet.edges.size(); ++s) {
    result.emplace_back(edge(facet.edges[s]), facet.triangles.segment_sides[s]);
  }
  for (const std::int32_t p : facet.graph.points) result.emplace_back(point(p), -1);
  std::sort(result.begin(), result.end());
  return result;
}

std::string describe_edge(const PlcComplex& complex, const ComplexEdge& e) {
  return "the segment from vertex " + std::to_string(e.a) + " at " +
         describe_point(complex.points[at(e.a)]) + " to vertex " + std::to_string(e.b) + " at " +
         describe_point(complex.points[at(e.b)]);
}

bool map_edges(const PlcComplex& complex,
               const std::vector<std::int32_t>& point_image,
               bool ignore_markers,
               ComplexImage& result) {
  const auto before = [](const ComplexEdge& e, const ComplexEdge& f) {
    return std::pair(e.a, e.b) < std::pair(f.a, f.b);
  };
  for (const ComplexEdge& e : complex.edges) {
    ComplexEdge turned{point_image[at(e.a)], point_image[at(e.b)], e.marker};
    if (turned.a > turned.b) std::swap(turned.a, turned.b);
    const auto it = std::lower_bound(complex.edges.begin(), complex.edges.end(), turned, before);
    if (it == complex.edges.end() || before(turned, *it)) {
      result.mismatch = describe_edge(complex, e) + " has no copy from vertex " +
                        std::to_string(turned.a) + " to vertex " + std::to_string(turned.b);
      result.elements = {e.a, e.b, turned.a, turned.b};
      return false;
    }
    if (!ignore_markers && it->marker != e.marker) {
      result.mismatch = describe_edge(complex, e) + " has marker " + std::to_string(e.marker) +
                        ", its copy from vertex " + std::to_string(turned.a) + " to vertex " +
                        std::to_string(turned.b) + " has marker " + std::to_string(it->marker);
      result.elements = {e.a, e.b, turned.a, turned.b};
      return false;
    }
    result.edge.push_back(static_cast<std::int32_t>(it - complex.edges.begin()));
  }
  return true;
}

void map_facets(const PlcComplex& complex,
                const std::vector<std::int32_t>& point_image,
                bool ignore_markers,
                ComplexImage& result) {
  const auto same = [](std::int32_t i) { return i; };
  std::vector<std::pair<Signature, std::int32_t>> known;
  for (std::size_t f = 0; f < complex.facets.size(); ++f) {
    known.emplace_back(signature_of(complex.facets[f], same, same), static_cast<std::int32_t>(f));
  }
  std::sort(known.begin(), known.end());
  for (const ComplexFacet& facet : complex.facets) {
    const Signature turned = signature_of(
        facet, [&](std::int32_t e) { return result.edge[at(e)]; },
        [&](std::int32_t p) { return point_image[at(p)]; });
    const auto it = std::lower_bound(known.begin(), known.end(), std::pair(turned, 0));
    if (it == known.end() || it->first != turned) {
      result.mismatch = "facet " + std::to_string(facet.source) + " has no copy";
      result.elements = {facet.source};
      return;
    }
    const ComplexFacet& copy = complex.facets[at(it->second)];
    if (!ignore_markers && copy.marker != facet.marker) {
      result.mismatch = "facet " + std::to_string(facet.source) + " has marker " +
                        std::to_string(facet.marker) + ", its copy, facet " +
                        std::to_string(copy.source) + ", has marker " + std::to_string(copy.marker);
      result.elements = {facet.source, copy.source};
      return;
    }
    result.facet.push_back(it->second);
  }
}

// Gaussian elimination with pivoting; false if (nearly) singular.
bool solve4(std::array<std::array<double, 5>, 4>& m, std::array<double, 4>& x) {
  double scale = 0;
  for (const auto& row : m) {
    for (std::size_t c = 0; c < 4; ++c) scale = std::max(scale, std::abs(row[c]));
  }
  for (std::size_t c = 0; c < 4; ++c) {
    std::size_t pivot = c;
    for (std::size_t r = c + 1; r < 4; ++r) {
      if (std::abs(m[r][c]) > std::abs(m[pivot][c])) pivot = r;
    }
    constexpr double kSingular = 1e-12;  // relative pivot below which the axis is not determined
    if (!(std::abs(m[pivot][c]) > kSingular * scale)) return false;
    std::swap(m[c], m[pivot]);
    for (std::size_t r = 0; r < 4; ++r) {
      if (r == c) continue;
      const double factor = m[r][c] / m[c][c];
      for (std::size_t k = c; k < 5; ++k) m[r][k] -= factor * m[c][k];
    }
  }
  for (std::size_t r = 0; r < 4; ++r) x[r] = m[r][4] / m[r][r];
  return true;
}

}  // namespace

ComplexImage map_complex(const PlcComplex& complex,
                         const std::vector<std::int32_t>& point_image,
                         bool ignore_markers) {
  ComplexImage result;
  if (map_edges(complex, point_image, ignore_markers, result)) {
    map_facets(complex, point_image, ignore_markers, result);
  }
  return result;
}

struct PlcMatcher::Images {
  std::vector<std::int32_t> image;  // per point the nearest to its rotated self
  double error = 0;
  std::int32_t worst = -1;
  bool matched = false;  // within the reach, one to one
};

PlcMatcher::PlcMatcher(const PlcComplex& complex,
                       const PlcCells& cells,
                       double tolerance,
                       bool ignore_markers)
    : complex_(complex),
      cells_(cells),
      tolerance_(tolerance),
      ignore_markers_(ignore_markers),
      tree_(complex.points) {
}

PlcMatcher::Images PlcMatcher::images_of(std::int32_t fold, const AxisFrame& frame) const {
  const RotationTable rotations(fold);
  Images result;
  result.matched = true;
  std::vector<std::uint8_t> taken(complex_.points.size(), 0);
  for (std::size_t i = 0; i < complex_.points.size(); ++i) {
    const Point3 local = frame.to_local(complex_.points[i]);
    PointTree::Hit hit{static_cast<std::int32_t>(i), 0};
    if (length(Point2{local.x, local.y}) > tolerance_) {
      hit = tree_.nearest(frame.to_model(rotations.rotate(local, 1 % fold)));
    }
    if (hit.distance > result.error || result.worst < 0) {
      result.error = std::max(result.error, hit.distance);
      result.worst = static_cast<std::int32_t>(i);
    }
    if (taken[at(hit.point)]++ != 0) result.matched = false;
    result.image.push_back(hit.point);
  }
  return result;
}

// One Gauss-Newton step for the axis: a shift c and a small turn w, both normal to it, change the
// image R p by (I - R) c + w x R p - R (w x p).  Exponents 1 and n/2 are used: the first alone
// hardly depends on the axis for large n.
AxisFrame PlcMatcher::adjusted(std::int32_t fold,
                               const AxisFrame& frame,
                               const std::vector<std::int32_t>& image) const {
  const RotationTable rotations(fold);
  std::array<std::array<double, 5>, 4> m{};
  const double size = std::max(complex_.diameter, 1e-300);  // scales the turn to a length
  std::vector<std::int32_t> target = image;
  for (const std::int32_t k : {1, fold / 2}) {
    if (k > 1) {
      for (std::size_t i = 0; i < target.size(); ++i) {
        auto v = static_cast<std::int32_t>(i);
        for (std::int32_t step = 0; step < k; ++step) v = image[at(v)];
        target[i] = v;
      }
    }
    for (std::size_t i = 0; i < complex_.points.size(); ++i) {
      const Point3 p = (1 / size) * frame.to_local(complex_.points[i]);
      const Point3 q = (1 / size) * frame.to_local(complex_.points[at(target[i])]);
      const Point3 turned = rotations.rotate(p, k);
      std::array<Point3, 4> columns;
      const auto rotated_part = [&](Point3 v) { return rotations.rotate(v, k); };
      columns[0] = Point3{1, 0, 0} - rotated_part({1, 0, 0});
      columns[1] = Point3{0, 1, 0} - rotated_part({0, 1, 0});
      columns[2] = cross(Point3{1, 0, 0}, turned) - rotated_part(cross(Point3{1, 0, 0}, p));
      columns[3] = cross(Point3{0, 1, 0}, turned) - rotated_part(cross(Point3{0, 1, 0}, p));
      const Point3 residual = q - turned;
      for (std::size_t r = 0; r < 4; ++r) {
        for (std::size_t c = 0; c < 4; ++c) m[r][c] += dot(columns[r], columns[c]);
        m[r][4] += dot(columns[r], residual);
      }
    }
  }
  std::array<double, 4> x{};
  if (!solve4(m, x)) return frame;
  // w x z = (w_y, -w_x, 0).
  const Point3 direction{x[3], -x[2], 1};
  const Point3 shift{size * x[0], size * x[1], 0};
  AxisFrame bare = frame;
  bare.origin = {0, 0, 0};
  return AxisFrame::of_axis(frame.to_model(shift), bare.to_model(direction));
}

bool PlcMatcher::make_orbits(PlcFit& fit, const std::vector<std::int32_t>& image) const {
  fit.vertex.assign(complex_.points.size(), {});
  for (std::size_t i = 0; i < complex_.points.size(); ++i) {
    if (fit.vertex[i].orbit >= 0) continue;
    const auto orbit = static_cast<std::int32_t>(fit.on_axis.size());
    const Point3 local = fit.frame.to_local(complex_.points[i]);
    const bool axial = fit.fold > 1 && length(Point2{local.x, local.y}) <= tolerance_;
    fit.on_axis.push_back(axial ? 1 : 0);
    const auto first = static_cast<std::int32_t>(i);
    std::int32_t v = first;
    std::int32_t k = 0;
    do {
      if (fit.vertex[at(v)].orbit >= 0 || k == fit.fold) break;
      fit.vertex[at(v)] = {orbit, k++};
      v = image[at(v)];
    } while (v != first);
    if (axial ? k == 1 : (k == fit.fold && v == first)) continue;
    fit.mismatch = "vertex " + std::to_string(i) + " at " + describe_point(complex_.points[i]) +
                   " and its copies do not come " + std::to_string(fit.fold) +
                   " at a time; the symmetry tolerance may exceed its distance from other vertices";
    fit.elements = {static_cast<std::int64_t>(i)};
    return false;
  }
  return true;
}

// The largest distance of a vertex turned by any number of sectors from the one it maps to.
void PlcMatcher::measure(PlcFit& fit) const {
  const RotationTable rotations(fit.fold);
  struct Cloud {
    std::vector<Point3> points;  // turned back to exponent 0
    std::vector<std::int32_t> vertices;
  };
  std::vector<Cloud> clouds(fit.on_axis.size());
  for (std::size_t i = 0; i < complex_.points.size(); ++i) {
    const OrbitVertex v = fit.vertex[i];
    Point3 local = fit.frame.to_local(complex_.points[i]);
    Cloud& cloud = clouds[at(v.orbit)];
    if (fit.on_axis[at(v.orbit)] != 0) {
      cloud.points.push_back({0, 0, local.z});
      cloud.vertices.push_back(static_cast<std::int32_t>(i));
    }
    cloud.points.push_back(rotations.rotate(local, rotations.reduce(-std::int64_t{v.exponent})));
    cloud.vertices.push_back(static_cast<std::int32_t>(i));
  }
  constexpr std::size_t kPairwise = 512;  // beyond, twice the distance from the mean bounds it
  for (const Cloud& cloud : clouds) {
    Point3 mean;
    for (const Point3 p : cloud.points) mean = mean + p;
    mean = (1 / static_cast<double>(cloud.points.size())) * mean;
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
      double error = 2 * distance(cloud.points[i], mean);
      if (error <= fit.error) continue;
      if (cloud.points.size() <= kPairwise) {
        error = 0;
        for (const Point3 q : cloud.points) error = std::max(error, distance(cloud.points[i], q));
      }
      if (error <= fit.error) continue;
      fit.error = error;
      fit.worst_vertex = cloud.vertices[i];
    }
  }
}

PlcFit PlcMatcher::fit(std::int32_t fold, const AxisFrame& frame, bool adjust) const {
  PlcFit result;
  result.fold = fold;
  result.frame = frame;
  Images images = images_of(fold, frame);
  constexpr double kReach = 16;  // times the tolerance: how far off a guessed axis may be
  constexpr int kSteps = 3;      // at most: one that does not help is the last
  // Below the rounding of positions an axis is not improved but blurred.
  constexpr double kPlaceRounding = 32 * 0x1p-53;
  const double finest = kPlaceRounding * std::max(complex_.diameter, complex_.magnitude);
  for (int step = 0; adjust && step < kSteps; ++step) {
    if (!images.matched || images.error > kReach * tolerance_ || images.error <= finest) break;
    const AxisFrame better = adjusted(fold, result.frame, images.image);
    Images improved = images_of(fold, better);
    if (!improved.matched || !(improved.error < images.error)) break;
    result.frame = better;
    images = std::move(improved);
  }
  result.error = images.error;
  result.worst_vertex = images.worst;
  if (images.error > tolerance_) return result;
  if (!images.matched) {
    result.mismatch = "vertices closer to each other than the symmetry tolerance map onto one";
    return result;
  }
  if (!make_orbits(result, images.image)) return result;
  result.error = 0;
  measure(result);
  if (result.error > tolerance_) return result;
  ComplexImage mapped = map_complex(complex_, images.image, ignore_markers_);
  if (mapped.mismatch) {
    result.mismatch = *mapped.mismatch;
    result.elements = mapped.elements;
    return result;
  }
  compare_cells(images.image, mapped, result);
  result.accepted = result.mismatch.empty();
  return result;
}

bool PlcMatcher::alike(std::int32_t cell, std::int32_t image) const {
  const PlcCell& a = cells_.cells[at(cell)];
  const PlcCell& b = cells_.cells[at(image)];
  if (a.meshed != b.meshed) return false;
  if (!a.meshed || ignore_markers_) return true;
  if (a.region < 0 || b.region < 0) return a.region < 0 && b.region < 0;
  const PlcRegion& r = complex_.regions[at(a.region)];
  const PlcRegion& s = complex_.regions[at(b.region)];
  return r.attribute == s.attribute && r.max_volume == s.max_volume;
}

std::string PlcMatcher::describe_cell(std::int32_t cell) const {
  const PlcCell& c = cells_.cells[at(cell)];
  if (cell == kOutside) return "the outside";
  if (c.hole >= 0) return "the hole of seed " + std::to_string(c.hole);
  if (c.region < 0) return "a cell without region seed";
  const PlcRegion& r = complex_.regions[at(c.region)];
  return "the region of seed " + std::to_string(c.region) + " (attribute " +
         std::to_string(r.attribute) + ", largest volume " + describe_number(r.max_volume) + ")";
}

// The cells beside every segment of every facet with those beside its image.
void PlcMatcher::compare_cells(const std::vector<std::int32_t>& point_image,
                               const ComplexImage& mapped,
                               PlcFit& fit) const {
  const RotationTable rotations(fit.fold);
  AxisFrame bare = fit.frame;
  bare.origin = {0, 0, 0};
  for (std::size_t f = 0; f < complex_.facets.size(); ++f) {
    const ComplexFacet& facet = complex_.facets[f];
    const std::size_t g = at(mapped.facet[f]);
    const ComplexFacet& copy = complex_.facets[g];
    const Point3 normal =
        bare.to_model(rotations.rotate(bare.to_local(facet.graph.normal), 1 % fit.fold));
    const bool turned_over = dot(normal, copy.graph.normal) < 0;
    for (std::size_t s = 0; s < facet.edges.size(); ++s) {
      const IndexPair ends = facet.graph.segments[s];
      const bool reversed = point_image[at(ends[0])] > point_image[at(ends[1])];
      const auto it =
          std::lower_bound(copy.edges.begin(), copy.edges.end(), mapped.edge[at(facet.edges[s])]);
      const auto s_copy = static_cast<std::size_t>(it - copy.edges.begin());
      for (std::size_t hand = 0; hand < 2; ++hand) {
        const std::int32_t t = cells_.borders[f][s][hand];
        const std::int32_t u = cells_.borders[g][s_copy][turned_over != reversed ? 1 - hand : hand];
        if (t < 0 && u < 0) continue;
        if (t < 0 || u < 0) {
          fit.mismatch = "facet " + std::to_string(facet.source) + " and its copy, facet " +
                         std::to_string(copy.source) + ", are filled differently";
          fit.elements = {facet.source, copy.source};
          return;
        }
        for (std::size_t side = 0; side < 2; ++side) {
          const std::int32_t cell = cells_.sides[f][at(t)][side];
          const std::int32_t image = cells_.sides[g][at(u)][turned_over ? 1 - side : side];
          if (alike(cell, image)) continue;
          fit.mismatch = "facet " + std::to_string(facet.source) + " bounds " +
                         describe_cell(cell) + ", its copy, facet " + std::to_string(copy.source) +
                         ", bounds " + describe_cell(image) + "; give every copy the same seeds";
          fit.elements = {facet.source, copy.source};
          return;
        }
      }
    }
  }
}

}  // namespace symcell::solid
