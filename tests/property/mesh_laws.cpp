#include "tests/property/mesh_laws.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <sstream>

#include "core/cell/full_mesh.hpp"
#include "core/geometry/predicates.hpp"
#include "core/plane/input/subdomains.hpp"
#include "tests/property/planar_link_laws.hpp"
#include "tests/property/restored_mesh.hpp"

namespace symcell {
namespace {

constexpr double kPlaceTolerance = 1e-9;     // of the model's diameter
constexpr double kCoincidence = 1e-10;       // likewise
constexpr double kDelaunayTolerance = 1e-9;  // sine of the excess over 180 degrees
constexpr double kAngleTolerance = 1e-9;     // degrees
constexpr double kNarrowTolerance = 1e-6;    // degrees, of input angles
constexpr double kShellRatio = 1e-3;         // distances on one shell agree this well
constexpr double kGoalMargin = 1e-7;         // degrees: refinement aims this much above the bound
constexpr double kDegree = 180 / std::numbers::pi;
constexpr std::size_t kNone = static_cast<std::size_t>(-1);

std::size_t idx(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

double angle_deg(Point2 apex, Point2 a, Point2 b) {
  const Point2 u = a - apex, v = b - apex;
  return std::atan2(cross(u, v), dot(u, v)) * kDegree;
}

class LawChecker {
 public:
  LawChecker(const Pslg& model,
             double area,
             const MeshOptions& options,
             const MeshOutcome& outcome,
             const std::vector<Point2>& pinches)
      : model_(model),
        area_(area),
        options_(options),
        outcome_(outcome),
        cell_(outcome.mesh),
        mesh_(restore(outcome.mesh)) {
    Point2 low = model.vertices.front(), high = low;
    for (const Point2 p : model.vertices) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    diameter_ = distance(low, high);
    topology_.diameter = diameter_;
    topology_.pinches = pinches;
  }

  std::vector<std::string> run() {
    check_orientation();
    check_pairs();
    if (!link()) return broken_;
    check_coincidence();
    if (!map_model()) return broken_;
    check_boundary();
    check_area();
    check_delaunay();
    check_regions();
    check_angles();
    check_sizes();
    check_statistics();
    for (const std::string& law : broken_planar_link_laws(cell_, topology_)) complain(law);
    return broken_;
  }

 private:
  template <class... Parts>
  void complain(const Parts&... parts) {
    std::ostringstream out;
    out.precision(17);
    (out << ... << parts);
    broken_.push_back(out.str());
  }

  void check_orientation() {
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const auto& [a, b, c] = mesh_.triangles[t];
      if (orientation(mesh_.at(a), mesh_.at(b), mesh_.at(c)) != Sign::kPositive) {
        complain("orientation: element ", t % mesh_.cell_triangles, " of sector ",
                 t / mesh_.cell_triangles, " is not positive");
        return;
      }
    }
  }

  void check_pairs() {
    const FullMeshView view(cell_);
    const RotationTable& rotations = view.rotations();
    std::set<std::pair<std::int32_t, std::int32_t>> seen;
    for (const OrbitVertex& v : cell_.nodes) {
      if (!seen.insert({v.orbit, v.exponent}).second) complain("cell: a node is listed twice");
    }
    if (cell_.fold == 1) return;
    std::size_t pairs = 0;
    for (std::size_t i = 0; i < cell_.nodes.size(); ++i) {
      const OrbitVertex low = cell_.nodes[i];
      const bool axis = cell_.on_axis[idx(low.orbit)] != 0;
      const std::int32_t image = cell_.lower_to_higher[i];
      const std::int32_t turned = axis ? 0 : rotations.add(low.exponent, 1);
      if (image < 0) {
        if (cell_.fold > 2 && seen.count({low.orbit, turned}) != 0) {
          complain("pairs: node ", i, " has its image in the cell but does not say so");
          return;
        }
        continue;
      }
      ++pairs;
      const OrbitVertex high = cell_.nodes[idx(image)];
      if (high.orbit != low.orbit || high.exponent != turned) {
        complain("pairs: node ", i, " is not taken to node ", image);
        return;
      }
    }
    const bool meets_bounds = !cell_.lower_facets.empty();
    if (meets_bounds && pairs < 2) complain("pairs: bounds without pairs of nodes");
    if (cell_.lower_facets.size() != cell_.higher_facets.size()) complain("pairs: bounds differ");
    for (std::size_t i = 0; i < cell_.lower_facets.size(); ++i) {
      if (cell_.lower_to_higher[idx(cell_.lower_facets[i])] != cell_.higher_facets[i]) {
        complain("pairs: lower facet node ", i, " does not go to the higher one");
        return;
      }
    }
  }

  // Neighbours by edges; false if the mesh is not conforming.
  bool link() {
    struct Side {
      std::int32_t low, high;
      std::size_t half_edge;
    };
    std::vector<Side> sides;
    for (std::size_t h = 0; h < 3 * mesh_.triangles.size(); ++h) {
      const auto [low, high] = std::minmax({mesh_.from(h), mesh_.to(h)});
      sides.push_back({low, high, h});
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
      return std::tie(a.low, a.high, a.half_edge) < std::tie(b.low, b.high, b.half_edge);
    });
    neighbour_.assign(sides.size(), kNone);
    for (std::size_t i = 0; i < sides.size();) {
      std::size_t j = i;
      while (j < sides.size() && sides[j].low == sides[i].low && sides[j].high == sides[i].high)
        ++j;
      if (j - i > 2) {
        complain("conforming: ", j - i, " triangles at edge ", sides[i].low, " ", sides[i].high);
        return false;
      }
      if (j - i == 2) {
        const std::size_t g = sides[i].half_edge, h = sides[i + 1].half_edge;
        if (mesh_.from(g) != mesh_.to(h)) {
          complain("conforming: two triangles on one side of an edge");
          return false;
        }
        neighbour_[g] = h;
        neighbour_[h] = g;
      }
      half_edge_of_[{sides[i].low, sides[i].high}] = sides[i].half_edge;
      i = j;
    }
    return true;
  }

  void check_coincidence() {
    by_x_.resize(mesh_.points.size());
    std::iota(by_x_.begin(), by_x_.end(), 0);
    std::sort(by_x_.begin(), by_x_.end(),
              [&](std::int32_t a, std::int32_t b) { return mesh_.at(a).x < mesh_.at(b).x; });
    const double tolerance = kCoincidence * diameter_;
    for (std::size_t i = 0; i < by_x_.size(); ++i) {
      for (std::size_t j = i + 1; j < by_x_.size(); ++j) {
        if (mesh_.at(by_x_[j]).x - mesh_.at(by_x_[i]).x > tolerance) break;
        if (distance(mesh_.at(by_x_[j]), mesh_.at(by_x_[i])) <= tolerance) {
          complain("coincidence: nodes ", by_x_[i], " and ", by_x_[j], " are at one place");
          return;
        }
      }
    }
  }

  // Nodes with x in [low, high].
  template <class Visit>
  void visit_nodes(double low, double high, const Visit& visit) const {
    auto it = std::lower_bound(by_x_.begin(), by_x_.end(), low,
                               [&](std::int32_t n, double x) { return mesh_.at(n).x < x; });
    for (; it != by_x_.end() && mesh_.at(*it).x <= high; ++it) visit(*it);
  }

  [[nodiscard]] std::int32_t node_at(Point2 p) const {
    const double tolerance = kPlaceTolerance * diameter_;
    std::int32_t found = -1;
    visit_nodes(p.x - tolerance, p.x + tolerance, [&](std::int32_t n) {
      if (distance(mesh_.at(n), p) <= tolerance) found = n;
    });
    return found;
  }

  // Finds the nodes of the model's vertices and the chains of edges of its segments.
  bool map_model() {
    ExecutionContext context;
    const auto subdomains = plane::make_subdomains(model_, context);
    if (!subdomains) {
      complain("model: ", subdomains.error().message);
      return false;
    }
    const plane::PlanarMap& map = subdomains->map;
    std::vector<char> meshed(model_.vertices.size(), 0);
    std::vector<std::array<std::int64_t, 2>> rim;
    for (std::size_t p = 0; p < map.pieces.size(); ++p) {
      const auto h = static_cast<std::int32_t>(2 * p);
      if (subdomains->left_of(h).meshed != subdomains->left_of(h + 1).meshed) {
        rim.push_back({map.pieces[p].a, map.pieces[p].b});
      }
      if (subdomains->left_of(h).meshed || subdomains->left_of(h + 1).meshed) {
        meshed[idx(map.pieces[p].a)] = meshed[idx(map.pieces[p].b)] = 1;
      }
    }
    for (std::size_t v = 0; v < meshed.size(); ++v) {
      const std::int32_t face = map.vertex_face[v];
      if (face >= 0 && subdomains->faces[idx(face)].meshed) meshed[v] = 1;
    }
    topology_.boundary = test::boundary_topology(rim);
    is_input_.assign(mesh_.points.size(), 0);
    std::vector<std::int32_t> node(meshed.size(), -1);
    for (std::size_t v = 0; v < meshed.size(); ++v) {
      node[v] = node_at(model_.vertices[v]);
      if (node[v] >= 0) is_input_[idx(node[v])] = 1;
      if (meshed[v] != 0 && node[v] < 0) {
        complain("model: vertex ", v, " is no node");
        return false;
      }
    }
    constrained_.assign(neighbour_.size(), 0);
    pieces_at_.assign(mesh_.points.size(), {});
    for (std::size_t p = 0; p < map.pieces.size(); ++p) {
      const auto h = static_cast<std::int32_t>(2 * p);
      const int sides = subdomains->left_of(h).meshed + subdomains->left_of(h + 1).meshed;
      if (sides > 0 && !mark_chain(node[idx(map.pieces[p].a)], node[idx(map.pieces[p].b)], sides,
                                   map.pieces[p].segment)) {
        return false;
      }
    }
    return true;
  }

  bool mark_chain(std::int32_t a, std::int32_t b, int sides, std::int32_t segment) {
    const Point2 p = mesh_.at(a), d = mesh_.at(b) - p;
    const double tolerance = kPlaceTolerance * diameter_, length2 = squared_length(d);
    std::vector<std::pair<double, std::int32_t>> chain;
    visit_nodes(std::min(p.x, p.x + d.x) - tolerance, std::max(p.x, p.x + d.x) + tolerance,
                [&](std::int32_t n) {
                  const Point2 q = mesh_.at(n) - p;
                  const double t = dot(q, d) / length2;
                  if (n != a && n != b && (t <= 0 || t >= 1)) return;
                  if (std::abs(cross(d, q)) > tolerance * std::sqrt(length2)) return;
                  chain.emplace_back(t, n);
                });
    std::sort(chain.begin(), chain.end());
    const auto piece = static_cast<std::int32_t>(ends_.size());
    ends_.push_back({a, b});
    for (const auto& entry : chain) pieces_at_[idx(entry.second)].push_back(piece);
    for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
      const auto edge = std::minmax({chain[i].second, chain[i + 1].second});
      const auto found = half_edge_of_.find({edge.first, edge.second});
      if (found == half_edge_of_.end()) {
        complain("segments: segment ", segment, " is no chain of edges at nodes ", edge.first, " ",
                 edge.second);
        return false;
      }
      const std::size_t h = found->second, g = neighbour_[h];
      if ((g == kNone) != (sides == 1)) {
        complain("segments: segment ", segment, " has ", sides, " meshed sides, the mesh not");
        return false;
      }
      constrained_[h] = 1;
      if (g != kNone) constrained_[g] = 1;
    }
    return true;
  }

  void check_boundary() {
    for (std::size_t h = 0; h < neighbour_.size(); ++h) {
      if (neighbour_[h] == kNone && constrained_[h] == 0) {
        complain("boundary: edge ", mesh_.from(h), " ", mesh_.to(h), " lies on no segment");
        return;
      }
    }
  }

  void check_area() {
    double sum = 0;
    for (std::size_t t = 0; t < mesh_.cell_triangles; ++t) sum += area_of(t);
    if (std::abs(sum * cell_.fold - area_) > 1e-9 * area_) {
      complain("area: cell times fold is ", sum * cell_.fold, ", the model's ", area_);
    }
  }

  [[nodiscard]] double area_of(std::size_t t) const {
    const auto& [a, b, c] = mesh_.triangles[t];
    return 0.5 * cross(mesh_.at(b) - mesh_.at(a), mesh_.at(c) - mesh_.at(a));
  }

  void check_delaunay() {
    for (std::size_t h = 0; h < neighbour_.size(); ++h) {
      const std::size_t g = neighbour_[h];
      if (g == kNone || g < h || constrained_[h] != 0) continue;
      const auto opposite = [&](std::size_t side) {
        return angle_deg(mesh_.at(mesh_.apex(side)), mesh_.at(mesh_.from(side)),
                         mesh_.at(mesh_.to(side))) /
               kDegree;
      };
      const double depth = -std::sin(opposite(h) + opposite(g));
      if (depth > kDelaunayTolerance) {
        complain("delaunay: edge ", mesh_.from(h), " ", mesh_.to(h), " by ", depth);
        return;
      }
    }
  }

  // Exactly: a point on an edge is in the triangles beside it.
  [[nodiscard]] std::size_t triangle_at(Point2 x) const {
    const auto on_left = [&](Point2 a, Point2 b) {
      return orientation(a, b, x) != Sign::kNegative;
    };
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const auto& [i, j, k] = mesh_.triangles[t];
      const Point2 a = mesh_.at(i), b = mesh_.at(j), c = mesh_.at(k);
      if (on_left(a, b) && on_left(b, c) && on_left(c, a)) return t;
    }
    return kNone;
  }

  // Faces of the model by flooding up to segments.
  void check_regions() {
    std::vector<std::int32_t> face(mesh_.triangles.size(), -1);
    std::vector<std::size_t> stack;
    std::int32_t faces = 0;
    for (std::size_t seed = 0; seed < face.size(); ++seed) {
      if (face[seed] >= 0) continue;
      face[seed] = faces;
      stack.push_back(seed);
      while (!stack.empty()) {
        const std::size_t t = stack.back();
        stack.pop_back();
        for (std::size_t h = 3 * t; h < 3 * t + 3; ++h) {
          if (neighbour_[h] == kNone || constrained_[h] != 0) continue;
          const std::size_t u = neighbour_[h] / 3;
          if (face[u] >= 0) continue;
          face[u] = faces;
          stack.push_back(u);
        }
      }
      ++faces;
    }
    std::vector<std::int32_t> attribute(idx(faces), 0);
    std::vector<double> max_area(idx(faces), kInfinity);
    for (const PslgRegion& region : model_.regions) {
      const std::size_t t = triangle_at(region.point);
      if (t == kNone) {
        complain("regions: a seed lies in no triangle");
        return;
      }
      attribute[idx(face[t])] = region.attribute;
      max_area[idx(face[t])] = std::min(max_area[idx(face[t])], region.max_area);
    }
    for (const Point2 hole : model_.holes) {
      if (triangle_at(hole) != kNone) complain("holes: a seed lies in a triangle");
    }
    for (std::size_t t = 0; t < face.size(); ++t) {
      if (mesh_.regions[t] != attribute[idx(face[t])]) {
        complain("regions: element ", t, " has attribute ", mesh_.regions[t], ", its seed ",
                 attribute[idx(face[t])]);
        return;
      }
      if (area_of(t) > max_area[idx(face[t])] * (1 + 1e-9)) {
        complain("regions: element ", t, " has area ", area_of(t), ", its region allows ",
                 max_area[idx(face[t])]);
        return;
      }
    }
  }

  void check_angles() {
    std::uint64_t surely_below = 0, perhaps_below = 0;
    for (std::size_t t = 0; t < mesh_.cell_triangles; ++t) {
      double least = 180;
      for (std::size_t i = 0; i < 3; ++i) least = std::min(least, corner_angle(t, i));
      const double goal = options_.min_angle_deg + kGoalMargin;
      if (options_.min_angle_deg > 0) {
        surely_below += least < options_.min_angle_deg - kAngleTolerance ? 1 : 0;
        perhaps_below += least < goal + kAngleTolerance ? 1 : 0;
      }
      if (least >= options_.min_angle_deg - kAngleTolerance || is_exempt(t)) continue;
      const auto& [a, b, c] = mesh_.triangles[t];
      complain("angles: element ", t, " has ", least, " degrees and is not exempt: (",
               mesh_.at(a).x, ", ", mesh_.at(a).y, ") (", mesh_.at(b).x, ", ", mesh_.at(b).y, ") (",
               mesh_.at(c).x, ", ", mesh_.at(c).y, "), input vertices ", int{is_input_[idx(a)]},
               int{is_input_[idx(b)]}, int{is_input_[idx(c)]}, ", meshed angles ",
               meshed_angle(t, 0), " ", meshed_angle(t, 1), " ", meshed_angle(t, 2));
      break;
    }
    std::uint64_t counted = 0;
    for (const ExemptCount& e : outcome_.statistics.exempt) counted += e.elements;
    if (counted < surely_below || counted > perhaps_below) {
      complain("angles: ", counted, " exempt elements reported, ", surely_below, " found");
    }
  }

  [[nodiscard]] double corner_angle(std::size_t t, std::size_t i) const {
    const auto& corner = mesh_.triangles[t];
    return angle_deg(mesh_.at(corner[i]), mesh_.at(corner[(i + 1) % 3]),
                     mesh_.at(corner[(i + 2) % 3]));
  }

  // The angle at corner i of triangle t from segment to segment, 360 if no segment ends there.
  [[nodiscard]] double meshed_angle(std::size_t t, std::size_t i) const {
    double sum = corner_angle(t, i);
    for (const std::size_t step : {std::size_t{1}, std::size_t{2}}) {
      std::size_t at = t, c = i;
      for (;;) {
        const std::size_t h = 3 * at + (c + step) % 3;
        if (constrained_[h] != 0 || neighbour_[h] == kNone) break;
        at = neighbour_[h] / 3;
        c = corner_index(at, mesh_.triangles[t][i]);
        if (at == t) return 360;
        sum += corner_angle(at, c);
      }
    }
    return sum;
  }

  [[nodiscard]] std::size_t corner_index(std::size_t t, std::int32_t node) const {
    const auto& corners = mesh_.triangles[t];
    return static_cast<std::size_t>(std::find(corners.begin(), corners.end(), node) -
                                    corners.begin());
  }

  [[nodiscard]] bool is_exempt(std::size_t t) const {
    const double bound = options_.min_angle_deg + kNarrowTolerance;
    const double sector = 360.0 / cell_.fold;
    const Point2 centre{cell_.axis_origin.x, cell_.axis_origin.y};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t node = mesh_.triangles[t][i];
      const bool at_centre = distance(mesh_.at(node), centre) <= kPlaceTolerance * diameter_;
      // Between copies of one segment the input asks for no angle but the fold's.
      const double narrow = at_centre ? std::min(bound, sector - kNarrowTolerance) : bound;
      if (is_input_[idx(node)] != 0 && meshed_angle(t, i) < narrow) return true;
      if (at_centre && sector < bound && fills_sector(t, i, sector)) return true;
    }
    return spans_narrow_corner(t, bound);
  }

  // Nothing at the centre forces an angle below 360/n there, nor one elsewhere below that of the
  // triangle (centre, a, Ra).
  [[nodiscard]] bool fills_sector(std::size_t t, std::size_t at_centre, double sector) const {
    const double others = std::min(options_.min_angle_deg, (180 - sector) / 2);
    return corner_angle(t, at_centre) >= sector - kNarrowTolerance &&
           corner_angle(t, (at_centre + 1) % 3) >= others - kNarrowTolerance &&
           corner_angle(t, (at_centre + 2) % 3) >= others - kNarrowTolerance;
  }

  // Whether the shortest edge runs between two segments that meet in a narrow corner, its ends
  // equally far from it.
  [[nodiscard]] bool spans_narrow_corner(std::size_t t, double bound) const {
    std::size_t shortest = 3 * t;
    for (std::size_t h = 3 * t; h < 3 * t + 3; ++h) {
      if (edge_length(h) < edge_length(shortest)) shortest = h;
    }
    const std::int32_t u = mesh_.from(shortest), v = mesh_.to(shortest);
    for (const std::int32_t r : pieces_at_[idx(u)]) {
      for (const std::int32_t s : pieces_at_[idx(v)]) {
        if (r == s) continue;
        for (const std::int32_t w : ends_[idx(r)]) {
          if (w != ends_[idx(s)][0] && w != ends_[idx(s)][1]) continue;
          const double a = distance(mesh_.at(u), mesh_.at(w));
          const double b = distance(mesh_.at(v), mesh_.at(w));
          if (std::abs(a - b) <= kShellRatio * a &&
              std::abs(angle_deg(mesh_.at(w), mesh_.at(u), mesh_.at(v))) < bound) {
            return true;
          }
        }
      }
    }
    return false;
  }

  [[nodiscard]] double edge_length(std::size_t h) const {
    return distance(mesh_.at(mesh_.from(h)), mesh_.at(mesh_.to(h)));
  }

  void check_sizes() {
    for (std::size_t t = 0; t < mesh_.cell_triangles; ++t) {
      if (area_of(t) > options_.max_area * (1 + 1e-9)) {
        complain("max_area: element ", t, " has ", area_of(t));
        return;
      }
    }
    for (std::size_t h = 0; h < 3 * mesh_.cell_triangles; ++h) {
      if (edge_length(h) > options_.max_edge * (1 + 1e-9)) {
        complain("max_edge: an edge has length ", edge_length(h));
        return;
      }
    }
  }

  void check_statistics() {
    const Statistics& s = outcome_.statistics;
    double least = 180, sum = 0;
    for (std::size_t t = 0; t < mesh_.cell_triangles; ++t) {
      for (std::size_t i = 0; i < 3; ++i) least = std::min(least, corner_angle(t, i));
      sum += area_of(t);
    }
    const auto pairs = static_cast<std::uint64_t>(
        std::count_if(cell_.lower_to_higher.begin(), cell_.lower_to_higher.end(),
                      [](std::int32_t image) { return image >= 0; }));
    if (s.cell.elements != mesh_.cell_triangles || s.cell.nodes != cell_.nodes.size() ||
        s.full.elements != mesh_.triangles.size() || s.full.nodes != mesh_.points.size() ||
        s.cell.symmetry_nodes != pairs || s.cell.symmetry_facets != cell_.lower_facets.size() / 2 ||
        s.symmetry.fold != cell_.fold) {
      complain("statistics: counts differ");
    }
    if (std::abs(s.cell.min_angle_deg - least) > 1e-9 ||
        std::abs(s.cell.measure - sum) > 1e-12 * area_) {
      complain("statistics: smallest angle ", least, " reported as ", s.cell.min_angle_deg,
               ", area ", sum, " reported as ", s.cell.measure);
    }
  }

  const Pslg& model_;
  double area_;
  const MeshOptions& options_;
  const MeshOutcome& outcome_;
  const SymmetryCellMesh& cell_;
  RestoredMesh mesh_;
  double diameter_ = 0;
  PlanarTopology topology_;
  std::vector<std::size_t> neighbour_;  // per half-edge
  std::map<std::pair<std::int32_t, std::int32_t>, std::size_t> half_edge_of_;
  std::vector<std::int32_t> by_x_;                    // nodes
  std::vector<char> constrained_;                     // per half-edge
  std::vector<char> is_input_;                        // per node
  std::vector<std::array<std::int32_t, 2>> ends_;     // per piece of a segment: nodes
  std::vector<std::vector<std::int32_t>> pieces_at_;  // per node
  std::vector<std::string> broken_;
};

}  // namespace

std::vector<std::string> broken_laws(const Pslg& model,
                                     double area,
                                     const MeshOptions& options,
                                     const MeshOutcome& outcome,
                                     const std::vector<Point2>& pinches) {
  return LawChecker(model, area, options, outcome, pinches).run();
}

}  // namespace symcell
