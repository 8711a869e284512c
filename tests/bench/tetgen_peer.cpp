#include "tests/bench/tetgen_peer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>

#include "core/base/index.hpp"
#include "core/geometry/rotation.hpp"
#include "core/solid/initial/cut_section.hpp"
#include "tests/bench/tetgen_run.hpp"

namespace symcell::bench {
namespace {

constexpr int kLowerMarker = 1'000'001;
constexpr int kHigherMarker = 1'000'002;
constexpr std::int32_t kMostRounds = 8;

// The wedge as triangles: faces of the sector, divided at the vertices that lie inside their edges
// on the cut, the section on both cuts.
class Wedge {
 public:
  explicit Wedge(const solid::Sector& sector) : sector_(sector), rotations_(sector.fold) {
    for (const Point3 p : sector.orbit_points) {
      size_ = std::max({size_, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    }
    for (const auto& e : sector.lower_cut) chains_.push_back({e[0], e[1]});
  }

  Result<PeerInput> input() {
    auto section = initial::make_cut_section(sector_);
    if (!section) return error_of(section);
    PeerInput input;
    for (const OrbitVertex v : sector_.vertices) {
      input.points.push_back(rotations_.rotate(sector_.orbit_points[at(v.orbit)], v.exponent));
    }
    std::map<std::array<std::int32_t, 2>, std::vector<std::int32_t>> inside;
    for (const auto& chain : chains_) {
      add_inside(chain, inside);
      std::vector<std::int32_t> image;
      for (const std::int32_t v : chain) image.push_back(section->image[at(v)]);
      add_inside(image, inside);
    }
    for (const solid::SectorFace& f : sector_.faces) {
      for (const auto& t : cut_triangle(f.v, inside)) {
        input.facets.push_back({{{t[0], t[1], t[2]}}, {}, f.facet + 1});
      }
    }
    for (const auto& [a, b, c] : section->faces) {
      input.facets.push_back({{{a, b, c}}, {}, kLowerMarker});
      input.facets.push_back(
          {{{section->image[at(a)], section->image[at(b)], section->image[at(c)]}},
           {},
           kHigherMarker});
    }
    const double theta = 2 * std::numbers::pi / sector_.fold;
    for (const Point3 h : sector_.holes) {
      const double turns = (std::atan2(h.y, h.x) - sector_.start_angle) / theta;
      input.holes.push_back(
          rotations_.rotate(h, rotations_.reduce(-static_cast<std::int64_t>(std::floor(turns)))));
    }
    return input;
  }

  // Splits the edges of the curves that the result has split on either cut, at the same place on
  // both; their number. At the ends of the curves as given the pieces' lengths are powers of two,
  // so that splits on two curves that meet at a small angle do not call for each other for ever.
  std::uint64_t split_curves(const PeerOutput& output) {
    std::vector<Point2> found;
    for (std::size_t f = 0; f < output.faces.size(); ++f) {
      if (output.markers[f] != kLowerMarker && output.markers[f] != kHigherMarker) continue;
      for (const std::int32_t v : output.faces[f]) found.push_back(flat(output.points[at(v)]));
    }
    std::uint64_t splits = 0;
    for (auto& chain : chains_) {
      std::vector<std::int32_t> split{chain.front()};
      for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
        const Point2 a = flat(chain[i]), b = flat(chain[i + 1]);
        const bool any =
            std::any_of(found.begin(), found.end(), [&](Point2 q) { return inside_edge(q, a, b); });
        if (any) {
          const bool begins = i == 0, ends = i + 2 == chain.size();
          const double half = std::exp2(std::round(std::log2(0.5 * distance(a, b))));
          double share = 0.5;
          if (begins != ends) share = half / distance(a, b);
          if (ends && !begins) share = 1 - share;
          split.push_back(add_cut_vertex(a + share * (b - a)));
          ++splits;
        }
        split.push_back(chain[i + 1]);
      }
      chain = std::move(split);
    }
    sector_.lower_cut.clear();
    for (const auto& chain : chains_) {
      for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
        sector_.lower_cut.push_back({chain[i], chain[i + 1]});
      }
    }
    return splits;
  }

  // The boundary of a result with the mesh of the lower cut on the higher one too; empty if the
  // curves' vertices do not match.
  [[nodiscard]] PeerInput matched_boundary(const PeerOutput& output) const {
    PeerInput input;
    input.points = output.points;
    std::map<std::pair<long long, long long>, std::int32_t> rim;  // of the higher cut's vertices
    std::vector<bool> elsewhere(output.points.size(), false);
    for (std::size_t f = 0; f < output.faces.size(); ++f) {
      if (output.markers[f] == kLowerMarker || output.markers[f] == kHigherMarker) continue;
      for (const std::int32_t v : output.faces[f]) elsewhere[at(v)] = true;
    }
    for (std::size_t f = 0; f < output.faces.size(); ++f) {
      if (output.markers[f] != kHigherMarker) continue;
      for (const std::int32_t v : output.faces[f]) {
        if (elsewhere[at(v)]) rim.emplace(cell(flat(output.points[at(v)])), v);
      }
    }
    std::map<std::int32_t, std::int32_t> image;
    for (std::size_t f = 0; f < output.faces.size(); ++f) {
      const auto& [a, b, c] = output.faces[f];
      if (output.markers[f] == kHigherMarker) continue;
      input.facets.push_back({{{a, b, c}}, {}, output.markers[f]});
      if (output.markers[f] != kLowerMarker) continue;
      std::vector<std::int32_t> higher;
      for (const std::int32_t v : output.faces[f]) {
        const Point3 p = output.points[at(v)];
        auto [it, added] = image.emplace(v, v);
        if (added && std::hypot(p.x, p.y) > near()) {
          it->second = static_cast<std::int32_t>(input.points.size());
          if (!elsewhere[at(v)]) {
            input.points.push_back(rotations_.rotate(p, 1));
          } else if (const std::int32_t twin = find_near(rim, flat(p)); twin >= 0) {
            it->second = twin;
          } else {
            return {};
          }
        }
        higher.push_back(it->second);
      }
      input.facets.push_back({{higher}, {}, kHigherMarker});
    }
    drop_unused(input);
    return input;
  }

 private:
  static void add_inside(const std::vector<std::int32_t>& chain,
                         std::map<std::array<std::int32_t, 2>, std::vector<std::int32_t>>& inside) {
    if (chain.size() < 3) return;
    std::vector<std::int32_t> middle(chain.begin() + 1, chain.end() - 1);
    inside[{chain.front(), chain.back()}] = middle;
    std::reverse(middle.begin(), middle.end());
    inside[{chain.back(), chain.front()}] = middle;
  }

  // Edge by edge, as fans from the corner opposite: TetGen cannot bear polygons with long rows of
  // vertices that are collinear but for rounding.
  static std::vector<std::array<std::int32_t, 3>> cut_triangle(
      std::array<std::int32_t, 3> triangle,
      const std::map<std::array<std::int32_t, 2>, std::vector<std::int32_t>>& inside) {
    std::vector<std::array<std::int32_t, 3>> done, left{triangle};
    while (!left.empty()) {
      const auto t = left.back();
      left.pop_back();
      bool whole = true;
      for (std::size_t i = 0; i < 3 && whole; ++i) {
        const std::int32_t a = t[i], b = t[(i + 1) % 3], c = t[(i + 2) % 3];
        const auto it = inside.find({a, b});
        if (it == inside.end()) continue;
        whole = false;
        std::int32_t last = a;
        for (const std::int32_t v : it->second) {
          left.push_back({last, v, c});
          last = v;
        }
        left.push_back({last, b, c});
      }
      if (whole) done.push_back(t);
    }
    return done;
  }

  // In the plane of the cut: distance from the axis, height.
  [[nodiscard]] static Point2 flat(Point3 p) { return {std::hypot(p.x, p.y), p.z}; }
  [[nodiscard]] Point2 flat(std::int32_t v) const {
    return flat(sector_.orbit_points[at(sector_.vertices[at(v)].orbit)]);
  }

  // Vertices of the two cuts nearer than this are images of each other.
  [[nodiscard]] double near() const { return 1e-7 * size_; }
  [[nodiscard]] std::pair<long long, long long> cell(Point2 q) const {
    return {std::llround(q.x / near()), std::llround(q.y / near())};
  }
  [[nodiscard]] std::int32_t find_near(
      const std::map<std::pair<long long, long long>, std::int32_t>& known, Point2 q) const {
    const auto [x, y] = cell(q);
    for (const long long dx : {0, -1, 1}) {
      for (const long long dy : {0, -1, 1}) {
        if (const auto it = known.find({x + dx, y + dy}); it != known.end()) return it->second;
      }
    }
    return -1;
  }

  static void drop_unused(PeerInput& input) {
    std::vector<std::int32_t> place(input.points.size(), -1);
    std::vector<Point3> used;
    for (PeerFacet& f : input.facets) {
      for (std::int32_t& v : f.polygons[0]) {
        if (place[at(v)] < 0) {
          place[at(v)] = static_cast<std::int32_t>(used.size());
          used.push_back(input.points[at(v)]);
        }
        v = place[at(v)];
      }
    }
    input.points = std::move(used);
  }

  [[nodiscard]] bool inside_edge(Point2 q, Point2 a, Point2 b) const {
    return std::abs(cross(b - a, q - a)) <= near() * distance(a, b) && dot(q - a, b - a) > 0 &&
           dot(q - b, a - b) > 0 && distance(q, a) > near() && distance(q, b) > near();
  }

  std::int32_t add_cut_vertex(Point2 q) {
    const auto orbit = static_cast<std::int32_t>(sector_.orbit_points.size());
    const auto vertex = static_cast<std::int32_t>(sector_.vertices.size());
    const double angle = sector_.start_angle;
    sector_.orbit_points.push_back({q.x * std::cos(angle), q.x * std::sin(angle), q.y});
    sector_.on_axis.push_back(0);
    sector_.kinds.push_back(solid::SectorVertexKind::kOnFacet);
    sector_.vertices.push_back({orbit, 0});
    sector_.vertices.push_back({orbit, 1});
    return vertex;
  }

  solid::Sector sector_;
  RotationTable rotations_;
  double size_ = 0;
  std::vector<std::vector<std::int32_t>> chains_;  // per edge of the cut as given
};

Result<PeerCount> whole(const PeerInput& input, PeerBounds bounds) {
  auto output = run_peer(input, switches_of("p", bounds));
  if (!output) return error_of(output);
  return output->count;
}

}  // namespace

Result<PeerCount> mesh_whole(const Plc& plc, PeerBounds bounds) {
  PeerInput input;
  input.points = plc.vertices;
  input.holes = plc.holes;
  for (const PlcFacet& f : plc.facets) input.facets.push_back({f.polygons, f.holes, f.marker});
  for (const PlcSegment& s : plc.segments) input.facets.push_back({{{s.a, s.b}}, {}, s.marker});
  return whole(input, bounds);
}

Result<PeerCount> mesh_whole(const TriangleSurface& surface, PeerBounds bounds) {
  PeerInput input;
  std::map<std::tuple<double, double, double>, std::int32_t> known;
  std::vector<std::int32_t> welded;
  for (const Point3 p : surface.vertices) {
    const auto [it, added] =
        known.emplace(std::tuple(p.x, p.y, p.z), static_cast<std::int32_t>(input.points.size()));
    if (added) input.points.push_back(p);
    welded.push_back(it->second);
  }
  for (const auto& [a, b, c] : surface.triangles) {
    const std::vector<std::int32_t> t{welded[at(a)], welded[at(b)], welded[at(c)]};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) input.facets.push_back({{t}, {}, 1});
  }
  return whole(input, bounds);
}

Result<PeerCount> mesh_matched_sector(const solid::Sector& sector, PeerBounds bounds) {
  Wedge wedge(sector);
  PeerInput boundary;
  PeerCount unmatched;
  for (std::int32_t round = 0; round < kMostRounds; ++round) {
    auto input = wedge.input();
    if (!input) return error_of(input);
    auto output = run_peer(*input, switches_of("p", bounds));
    if (!output) return error_of(output);
    if (round == 0) unmatched = output->count;
    if (wedge.split_curves(*output) > 0) continue;
    boundary = wedge.matched_boundary(*output);
    boundary.holes = input->holes;
    break;
  }
  const auto copies = static_cast<std::uint64_t>(sector.fold);
  unmatched.matched = false;
  unmatched.tets *= copies;
  if (boundary.facets.empty()) return unmatched;
  auto output = run_peer(boundary, switches_of("pYYM", bounds));
  if (!output) return unmatched;
  output->count.tets *= copies;
  return output->count;
}

}  // namespace symcell::bench
