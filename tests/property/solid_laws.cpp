#include "tests/property/solid_laws.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

#include "core/cell/full_mesh.hpp"
#include "core/geometry/point_tree.hpp"
#include "core/geometry/predicates_3.hpp"
#include "core/geometry/tet_measures.hpp"
#include "core/solid/plc/validate_plc.hpp"
#include "tests/property/link_fans.hpp"
#include "tests/property/link_laws.hpp"

namespace symcell {
namespace {

constexpr double kPlaceTolerance = 1e-9;    // of the model's diameter
constexpr double kCoincidence = 1e-10;      // likewise
constexpr double kMeasureTolerance = 1e-9;  // relative
constexpr double kQualityTolerance = 1e-6;  // relative
constexpr double kSphereTolerance = 1e-6;   // of the radius squared

using FaceKey = std::array<std::int64_t, 3>;

std::size_t idx(std::int64_t i) {
  return static_cast<std::size_t>(i);
}

class SolidLaws {
 public:
  SolidLaws(const test::RandomPlc& model, const MeshOptions& options, const MeshOutcome& outcome)
      : model_(model), options_(options), outcome_(outcome), cell_(outcome.mesh), view_(cell_) {
    for (std::int64_t i = 0; i < view_.node_count(); ++i) {
      points_.push_back(view_.position(view_.node(i)));
    }
    for (std::int32_t s = 0; s < cell_.fold; ++s) {
      for (std::size_t e = 0; e < cell_.element_count(); ++e) {
        std::array<std::int64_t, 4> tet{};
        for (std::size_t i = 0; i < 4; ++i) {
          tet[i] = view_.node_id(idx(cell_.elements[4 * e + i]), s);
        }
        tets_.push_back(tet);
        regions_.push_back(cell_.region(e, s));
      }
    }
  }

  std::vector<std::string> run() {
    check_cell();
    check_faces();
    check_coincidence();
    check_model();
    check_quality();
    check_delaunay();
    check_figures();
    for (const std::string& law : broken_link_laws(cell_, topology_)) broken(law);
    return std::move(broken_);
  }

 private:
  template <class... Parts>
  void broken(const Parts&... parts) {
    if (broken_.size() < 20) broken_.push_back(law_text(parts...));
  }
  [[nodiscard]] double tolerance() const { return kPlaceTolerance * model_.diameter; }
  [[nodiscard]] Point3 at(std::int64_t node) const { return points_[idx(node)]; }

  void check_cell() {
    for (std::size_t t = 0; t < tets_.size(); ++t) {
      const auto& v = tets_[t];
      if (orientation_3(at(v[0]), at(v[1]), at(v[2]), at(v[3])) == Sign::kPositive) continue;
      broken("orientation: element ", t, " is not positive");
      return;
    }
    for (std::size_t i = 0; i < cell_.nodes.size(); ++i) {
      const std::int32_t image = cell_.lower_to_higher[i];
      if (image < 0) continue;
      const std::int64_t turned = view_.node_id(i, cell_.fold > 1 ? 1 : 0);
      if (turned == view_.node_id(idx(image), 0)) continue;
      broken("pairs: node ", i, " is not turned onto node ", image);
      return;
    }
  }

  void check_faces() {
    std::map<FaceKey, std::vector<std::pair<std::size_t, int>>> faces;
    constexpr int kFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    for (std::size_t t = 0; t < tets_.size(); ++t) {
      for (const auto& corners : kFaces) {
        FaceKey key{tets_[t][idx(corners[0])], tets_[t][idx(corners[1])],
                    tets_[t][idx(corners[2])]};
        int sign = 1;
        if (key[0] > key[1]) std::swap(key[0], key[1]), sign = -sign;
        if (key[1] > key[2]) std::swap(key[1], key[2]), sign = -sign;
        if (key[0] > key[1]) std::swap(key[0], key[1]), sign = -sign;
        faces[key].emplace_back(t, sign);
      }
    }
    std::set<FaceKey> told;
    for (std::int32_t s = 0; s < cell_.fold; ++s) {
      for (std::size_t b = 0; b < cell_.facet_count(); ++b) {
        if (cell_.boundary_is_higher_image[b] != 0) continue;
        FaceKey key{};
        for (std::size_t i = 0; i < 3; ++i)
          key[i] = view_.node_id(idx(cell_.boundary[3 * b + i]), s);
        boundary_.push_back(key);
        markers_.push_back(cell_.boundary_marker(b, s));
        std::sort(key.begin(), key.end());
        if (!told.insert(key).second) {
          broken("boundary: facet ", b, " of the cell occurs twice in the full mesh");
          return;
        }
        if (!faces.contains(key)) {
          broken("boundary: facet ", b, " of the cell is no face of the mesh");
          return;
        }
      }
    }
    for (const auto& [key, uses] : faces) {
      if (uses.size() > 2 || (uses.size() == 2 && uses[0].second == uses[1].second)) {
        broken("conforming: a face of element ", uses[0].first, " has ", uses.size(), " elements");
        return;
      }
      if (uses.size() == 1 && !told.contains(key)) {
        broken("boundary: the outer face of element ", uses[0].first, " is not reported");
        return;
      }
      if (uses.size() == 2 && regions_[uses[0].first] != regions_[uses[1].first] &&
          !told.contains(key)) {
        broken("regions: they change between elements ", uses[0].first, " and ", uses[1].first,
               " where there is no facet");
        return;
      }
    }
  }

  void check_coincidence() {
    const PointTree tree(points_);
    const double reach = kCoincidence * model_.diameter;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Point3 p = points_[i];
      bool found = false;
      tree.within_box(p - Point3{reach, reach, reach}, p + Point3{reach, reach, reach},
                      [&](std::int32_t j) { found = found || idx(j) != i; });
      if (!found) continue;
      broken("coincidence: node ", i, " has another at its place");
      return;
    }
  }

  void check_model() {
    ExecutionContext context;
    const auto valid = solid::validate_plc(model_.plc, context);
    if (!valid) {
      broken("model: ", valid.error().message);
      return;
    }
    std::map<std::int32_t, double> expected, found;
    double volume = 0;
    for (std::size_t c = 1; c < valid->cells.cells.size(); ++c) {
      const solid::PlcCell& cell = valid->cells.cells[c];
      if (!cell.meshed) continue;
      const std::int32_t attribute =
          cell.region < 0 ? 0 : valid->complex.regions[idx(cell.region)].attribute;
      expected[attribute] += cell.volume;
    }
    for (std::size_t t = 0; t < tets_.size(); ++t) {
      const double v = volume_of(tets_[t]);
      found[regions_[t]] += v;
      volume += v;
    }
    const double slack = kMeasureTolerance * model_.volume;
    if (std::abs(volume - model_.volume) > slack) {
      broken("volume: ", volume, " instead of ", model_.volume);
    }
    for (const auto& [attribute, v] : expected) {
      if (std::abs(found[attribute] - v) > slack) {
        broken("regions: ", attribute, " has the volume ", found[attribute], " instead of ", v);
      }
    }
    if (found.size() != expected.size()) broken("regions: their number is ", found.size());
    topology_ = {model_.diameter, model_.pinches, test::boundary_topology(*valid)};
    if (model_.boundary && *model_.boundary != *topology_.boundary) {
      broken("model: its boundary is not as the generator states it");
    }
    find_meshed_facets(*valid);
    check_vertices(valid->complex);
    check_facets(valid->complex);
  }

  // What bounds holes and the outside alone is no part of the mesh.
  void find_meshed_facets(const solid::ValidPlc& valid) {
    const solid::PlcComplex& complex = valid.complex;
    std::vector<std::uint8_t> in_facet(complex.edges.size(), 0);
    meshed_edge_.assign(complex.edges.size(), 0);
    meshed_point_.assign(complex.points.size(), 0);
    for (std::size_t f = 0; f < complex.facets.size(); ++f) {
      const solid::ComplexFacet& facet = complex.facets[f];
      auto& meshed = meshed_triangle_.emplace_back();
      for (const auto& sides : valid.cells.sides[f]) {
        meshed.push_back(
            valid.cells.cells[idx(sides[0])].meshed || valid.cells.cells[idx(sides[1])].meshed ? 1
                                                                                               : 0);
      }
      for (std::size_t s = 0; s < facet.edges.size(); ++s) {
        in_facet[idx(facet.edges[s])] = 1;
        for (const std::int32_t t : valid.cells.borders[f][s]) {
          if (t >= 0 && meshed[idx(t)] != 0) meshed_edge_[idx(facet.edges[s])] = 1;
        }
      }
    }
    for (std::size_t e = 0; e < complex.edges.size(); ++e) {
      if (in_facet[e] == 0) meshed_edge_[e] = 1;  // needles: always in the domain here
      if (meshed_edge_[e] == 0) continue;
      meshed_point_[idx(complex.edges[e].a)] = meshed_point_[idx(complex.edges[e].b)] = 1;
    }
  }

  void check_vertices(const solid::PlcComplex& complex) {
    const PointTree tree(points_);
    std::vector<std::int64_t> node;
    for (std::size_t i = 0; i < complex.points.size(); ++i) {
      const PointTree::Hit hit = tree.nearest(complex.points[i]);
      node.push_back(hit.point);
      if (hit.distance <= tolerance() || meshed_point_[i] == 0) continue;
      broken("vertices: vertex ", i, " is no node; the nearest is ", hit.distance, " away");
      return;
    }
    std::set<std::pair<std::int64_t, std::int64_t>> edges;
    for (const auto& v : tets_) {
      for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) edges.emplace(v[i], v[j]);
      }
    }
    const Point3 margin{tolerance(), tolerance(), tolerance()};
    for (std::size_t i = 0; i < complex.edges.size(); ++i) {
      if (meshed_edge_[i] == 0) continue;
      const solid::ComplexEdge& e = complex.edges[i];
      const Point3 a = complex.points[idx(e.a)];
      const Point3 u = complex.points[idx(e.b)] - a;
      const Point3 low{std::min(a.x, a.x + u.x), std::min(a.y, a.y + u.y),
                       std::min(a.z, a.z + u.z)};
      const Point3 high{std::max(a.x, a.x + u.x), std::max(a.y, a.y + u.y),
                        std::max(a.z, a.z + u.z)};
      std::vector<std::pair<double, std::int64_t>> chain;
      tree.within_box(low - margin, high + margin, [&](std::int32_t j) {
        const Point3 d = at(j) - a;
        const double along = dot(d, u) / squared_length(u);
        if (length(d - along * u) <= tolerance()) chain.emplace_back(along, j);
      });
      std::sort(chain.begin(), chain.end());
      for (std::size_t j = 1; j < chain.size(); ++j) {
        if (edges.contains({chain[j - 1].second, chain[j].second})) continue;
        broken("segments: from vertex ", e.a, " to ", e.b, " there is no chain of edges");
        return;
      }
      if (chain.size() >= 2 && chain.front().second == node[idx(e.a)] &&
          chain.back().second == node[idx(e.b)]) {
        continue;
      }
      broken("segments: the one from vertex ", e.a, " to ", e.b, " has no nodes");
      return;
    }
  }

  // Every boundary face lies on a facet of its marker, and every facet has its area of them.
  void check_facets(const solid::PlcComplex& complex) {
    std::vector<FacetArea> facets;
    double total = 0;
    for (std::size_t f = 0; f < complex.facets.size(); ++f) {
      FacetArea& area = facets.emplace_back();
      for (std::size_t i = 0; i < complex.facets[f].triangles.triangles.size(); ++i) {
        const auto& t = complex.facets[f].triangles.triangles[i];
        const Point3 a = complex.points[idx(t[0])], b = complex.points[idx(t[1])];
        const Point3 c = complex.points[idx(t[2])];
        for (const Point3 p : {a, b, c}) area.widen(p);
        if (meshed_triangle_[f][i] != 0) area.expected += 0.5 * length(cross(b - a, c - a));
      }
      total += area.expected;
    }
    for (std::size_t b = 0; b < boundary_.size(); ++b) {
      const std::array<Point3, 3> corners{at(boundary_[b][0]), at(boundary_[b][1]),
                                          at(boundary_[b][2])};
      const std::size_t f = facet_of(complex, facets, corners, markers_[b]);
      if (f == facets.size()) {
        broken("facets: boundary face ", b, " of marker ", markers_[b], " lies on no such facet");
        return;
      }
      facets[f].found += 0.5 * length(cross(corners[1] - corners[0], corners[2] - corners[0]));
    }
    for (std::size_t f = 0; f < facets.size(); ++f) {
      if (std::abs(facets[f].found - facets[f].expected) <= kMeasureTolerance * total) continue;
      broken("facets: ", complex.facets[f].source, " of marker ", complex.facets[f].marker,
             " has the area ", facets[f].found, " instead of ", facets[f].expected);
      return;
    }
  }

  struct FacetArea {
    double expected = 0;
    double found = 0;
    Point3 low{kInfinity, kInfinity, kInfinity};
    Point3 high{-kInfinity, -kInfinity, -kInfinity};
    void widen(Point3 p) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    [[nodiscard]] bool has(Point3 p, double slack) const {
      return p.x >= low.x - slack && p.y >= low.y - slack && p.z >= low.z - slack &&
             p.x <= high.x + slack && p.y <= high.y + slack && p.z <= high.z + slack;
    }
  };

  // The facet of this marker that has the face; their number if none has.
  [[nodiscard]] std::size_t facet_of(const solid::PlcComplex& complex,
                                     const std::vector<FacetArea>& facets,
                                     const std::array<Point3, 3>& corners,
                                     std::int32_t marker) const {
    const Point3 middle = (1.0 / 3) * (corners[0] + corners[1] + corners[2]);
    for (std::size_t f = 0; f < facets.size(); ++f) {
      const solid::ComplexFacet& facet = complex.facets[f];
      if (facet.marker != marker || !facets[f].has(middle, tolerance())) continue;
      const Point3 base = complex.points[idx(facet.graph.segments.front()[0])];
      const bool flat = std::all_of(corners.begin(), corners.end(), [&](Point3 x) {
        return std::abs(dot(facet.graph.normal, x - base)) <= tolerance();
      });
      if (flat && covers(complex.points, facet, middle)) return f;
    }
    return facets.size();
  }

  [[nodiscard]] double volume_of(const std::array<std::int64_t, 4>& v) const {
    const Point3 d = at(v[3]);
    return dot(cross(at(v[0]) - d, at(v[1]) - d), at(v[2]) - d) / -6;
  }

  [[nodiscard]] double longest_edge(const std::array<std::int64_t, 4>& v, double& shortest) const {
    double longest = 0;
    shortest = kInfinity;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const double size = distance(at(v[i]), at(v[j]));
        longest = std::max(longest, size);
        shortest = std::min(shortest, size);
      }
    }
    return longest;
  }

  [[nodiscard]] double radius_edge(const std::array<std::int64_t, 4>& v) const {
    const Point3 d = at(v[3]);
    const Point3 a = at(v[0]) - d, b = at(v[1]) - d, c = at(v[2]) - d;
    const Point3 bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
    const Point3 sum = squared_length(a) * bc + squared_length(b) * ca + squared_length(c) * ab;
    double shortest = 0;
    static_cast<void>(longest_edge(v, shortest));
    return length(sum) / (2 * std::abs(dot(a, bc))) / shortest;
  }

  void check_quality() {
    std::uint64_t exempt = 0, bad = 0;
    for (const ExemptCount& e : outcome_.statistics.exempt) exempt += e.elements;
    for (std::size_t t = 0; t < cell_.element_count(); ++t) {
      if (radius_edge(tets_[t]) > options_.radius_edge * (1 + kQualityTolerance)) ++bad;
      if (volume_of(tets_[t]) > options_.max_volume * (1 + kQualityTolerance)) {
        broken("quality: element ", t, " has the volume ", volume_of(tets_[t]));
      }
      double shortest = 0;
      if (longest_edge(tets_[t], shortest) > options_.max_edge * (1 + kQualityTolerance)) {
        broken("quality: element ", t, " has too long an edge");
      }
    }
    if (bad > exempt) {
      broken("quality: ", bad, " elements are above the radius-edge bound, ", exempt,
             " are reported as exempt");
    }
    // Where the axis is inside and sectors are narrow, whole cells are.
    const bool narrow = model_.axis_inside && cell_.fold > 6;
    if (!model_.acute && !narrow && bad > cell_.element_count() / 5 + 10) {
      std::string reasons;
      for (const ExemptCount& e : outcome_.statistics.exempt) {
        reasons += " " + e.reason + " " + std::to_string(e.elements);
      }
      broken("quality: ", bad, " of ", cell_.element_count(), " elements are exempt:", reasons);
    }
  }

  // If it is reported to be so, every face that is on no facet is locally Delaunay.
  void check_delaunay() {
    if (!outcome_.statistics.delaunay) return;
    const std::set<FaceKey> facets = [&] {
      std::set<FaceKey> sorted;
      for (FaceKey key : boundary_) {
        std::sort(key.begin(), key.end());
        sorted.insert(key);
      }
      return sorted;
    }();
    std::map<FaceKey, std::pair<std::size_t, std::int64_t>> other;  // element, its fourth corner
    for (std::size_t t = 0; t < tets_.size(); ++t) {
      for (std::size_t i = 0; i < 4; ++i) {
        FaceKey key{tets_[t][(i + 1) % 4], tets_[t][(i + 2) % 4], tets_[t][(i + 3) % 4]};
        std::sort(key.begin(), key.end());
        const auto [found, first] = other.try_emplace(key, t, tets_[t][i]);
        if (first || facets.contains(key)) continue;
        const auto& v = tets_[t];
        const TetMeasures m = measure_tet(at(v[0]), at(v[1]), at(v[2]), at(v[3]));
        const double inside = squared_distance(at(found->second.second), m.centre) / m.radius2;
        if (inside >= 1 - kSphereTolerance) continue;
        broken("delaunay: reported, and element ", found->second.first,
               " reaches into the sphere of ", t);
        return;
      }
    }
  }

  void check_figures() {
    const Statistics& s = outcome_.statistics;
    if (s.cell.elements != cell_.element_count() || s.cell.nodes != cell_.nodes.size() ||
        s.full.elements != tets_.size() || s.full.nodes != points_.size()) {
      broken("figures: the statistics count otherwise");
    }
    if (std::abs(s.cell.measure * cell_.fold - model_.volume) > kMeasureTolerance * model_.volume) {
      broken("figures: n times the cell's volume is ", s.cell.measure * cell_.fold);
    }
  }

  const test::RandomPlc& model_;
  const MeshOptions& options_;
  const MeshOutcome& outcome_;
  const SymmetryCellMesh& cell_;
  FullMeshView view_;
  std::vector<Point3> points_;
  std::vector<std::array<std::int64_t, 4>> tets_;  // the cell's first
  std::vector<std::int32_t> regions_;
  std::vector<FaceKey> boundary_;
  std::vector<std::int32_t> markers_;
  std::vector<std::vector<std::uint8_t>> meshed_triangle_;  // per facet of the model
  std::vector<std::uint8_t> meshed_edge_;
  std::vector<std::uint8_t> meshed_point_;
  ModelTopology topology_;
  std::vector<std::string> broken_;
};

}  // namespace

std::vector<std::string> broken_solid_laws(const test::RandomPlc& model,
                                           const MeshOptions& options,
                                           const MeshOutcome& outcome) {
  return SolidLaws(model, options, outcome).run();
}

}  // namespace symcell
