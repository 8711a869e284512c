#include "core/solid/refine/criteria.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "core/geometry/tolerances.hpp"

namespace symcell::solid {
namespace {

// A bound is kept to this relative precision, so that rounding in a checker does not break it.
constexpr double kBoundSafety = 1e-9;
// Angles are compared with their limit to this many radians.
constexpr double kAngleSlack = 1e-9;

double dihedral(Point3 a, Point3 b, Point3 c, Point3 d) {
  // Between the half-planes of c and d at the line a b.
  const Point3 axis = b - a;
  const Point3 p = cross(axis, c - a), q = cross(axis, d - a);
  return std::atan2(length(cross(p, q)), dot(p, q));
}

double angle_at(Point3 a, Point3 b, Point3 c) {
  return std::atan2(length(cross(b - a, c - a)), dot(b - a, c - a));
}

}  // namespace

Criteria::Criteria(const InitialTetrahedralization& solid, const MeshOptions& options) {
  const double ratio = options.radius_edge * (1 - kBoundSafety);
  const double narrowing = 2 * std::sin(std::numbers::pi / solid.mesh.fold());
  inverse_ratios2_[static_cast<std::size_t>(Exemption::kNone)] = 1 / (ratio * ratio);
  inverse_ratios2_[static_cast<std::size_t>(Exemption::kAxis)] =
      std::min(1.0, narrowing * narrowing) / (ratio * ratio);
  inverse_ratios2_[static_cast<std::size_t>(Exemption::kSmallInputAngle)] = 0;
  max_edge2_ = options.max_edge * options.max_edge * (1 - kBoundSafety);
  min_edge_ = options.min_edge * (1 + kBoundSafety);
  narrow_ = solid.mesh.fold() > 1 && 360.0 / solid.mesh.fold() < kNarrowSectorDeg;
  for (const Subdomain& s : solid.subdomains) {
    max_volumes_.push_back(std::min(options.max_volume, s.max_volume) * (1 - kBoundSafety));
  }
  find_sizes(solid, options);
  find_sharp_segments(solid.mesh);
  find_sharp_vertices(solid.mesh, solid.tessellated);
}

namespace {

// A cube that holds all copies of the mesh: its middle, on the axis, and half its side.
std::pair<Point3, double> cube_about(const QuotientTetrahedralization& mesh) {
  double radius = 0, low = kInfinity, high = -kInfinity;
  for (TetId t = 0; t < mesh.tet_slots(); ++t) {
    if (!mesh.alive(t)) continue;
    for (int i = 0; i < 4; ++i) {
      const Point3 p = mesh.corner_point(t, i);
      radius = std::max(radius, std::hypot(p.x, p.y));
      low = std::min(low, p.z);
      high = std::max(high, p.z);
    }
  }
  return {Point3{0, 0, (low + high) / 2}, std::max(radius, (high - low) / 2)};
}

}  // namespace

void Criteria::find_sizes(const InitialTetrahedralization& solid, const MeshOptions& options) {
  for (const SizeRequest& s : options.sizes) {
    if (s.kind != SizeRequest::Kind::kRegion) continue;
    region_edges2_.resize(solid.subdomains.size(), kInfinity);
    for (std::size_t i = 0; i < solid.subdomains.size(); ++i) {
      if (solid.subdomains[i].attribute != s.id) continue;
      region_edges2_[i] = std::min(region_edges2_[i], s.size * s.size * (1 - kBoundSafety));
    }
  }
  const bool graded = std::isfinite(options.gradation);
  if (!solid.sizes && !graded) return;
  const QuotientTetrahedralization& mesh = solid.mesh;
  const auto [centre, half] = cube_about(mesh);
  if (solid.sizes) sizes_.emplace_back(solid.sizes, centre, half);
  if (!graded) return;
  // Away from short segments, too.
  std::vector<SizeSource> sources;
  mesh.edges().for_each([&](const EdgeKey& key, std::int32_t segment) {
    if (segment == solid.axis_segment()) return;
    const Point3 a = mesh.lift(key.a, 0), b = mesh.lift(key.b, key.exponent);
    sources.push_back({{a, b, b}, distance(a, b)});
  });
  sizes_.emplace_back(std::make_shared<const SizeField>(sources, options.gradation, mesh.fold()),
                      centre, half);
}

double Criteria::size_excess2(const TetMeasures& m, std::int32_t region) const {
  const double limit = max_volumes_[static_cast<std::size_t>(region)];
  double bound2 = max_edge2_;
  if (!region_edges2_.empty()) {
    bound2 = std::min(bound2, region_edges2_[static_cast<std::size_t>(region)]);
  }
  for (SizeLookup& sizes : sizes_) {
    const double least = sizes.least() * (1 - kBoundSafety);
    // Most tetrahedra are smaller than any bound.
    if (m.longest2 <= least * least || least * least >= bound2) continue;
    // What is allowed leaves the other bounds to decide.
    const double longest = std::sqrt(m.longest2) / (1 - kBoundSafety);
    const double allowed = sizes.max_edge(m.middle, longest);
    if (allowed >= longest) continue;
    const double length = allowed * (1 - kBoundSafety);
    bound2 = std::min(bound2, length * length);
  }
  double worst = m.longest2 / bound2;
  if (m.volume > limit) {
    const double length = std::cbrt(m.volume / limit);
    worst = std::max(worst, length * length);
  }
  return worst;
}

// Going round a subsegment, the angles of the tetrahedra between two subfacets add up to the
// dihedral angle of the input there.
void Criteria::find_sharp_segments(const QuotientTetrahedralization& mesh) {
  std::int32_t count = 0;
  mesh.edges().for_each([&](const EdgeKey&, std::int32_t s) { count = std::max(count, s + 1); });
  sharp_segments_.assign(static_cast<std::size_t>(count), 0);
  std::vector<TetCopy> ring;
  for (TetId t = 0; t < mesh.tet_slots(); ++t) {
    if (!mesh.alive(t)) continue;
    for (const auto& e : kEdgeCorners) {
      const OrbitVertex a = mesh.corner(t, e[0]), b = mesh.corner(t, e[1]);
      const std::int32_t segment = mesh.segment_of(a, b);
      if (segment == kNoSegment || sharp_segment(segment)) continue;
      ring.clear();
      const bool closed = mesh.ring({t, 0}, a, b, ring);
      double sum = 0, smallest = 2 * std::numbers::pi;
      bool seen_facet = !closed;
      // Twice round where it closes, to begin at a facet.
      const std::size_t steps = closed ? 2 * ring.size() : ring.size();
      for (std::size_t i = 0; i < steps; ++i) {
        const TetCopy c = ring[i % ring.size()];
        std::array<std::uint32_t, 2> o{};
        std::size_t n = 0;
        for (std::uint32_t m = 0; m < 4; ++m) {
          const OrbitVertex x = mesh.corner(c, m);
          if (x == a || x == b) continue;
          if (n < 2) o[n++] = m;
        }
        if (n < 2) break;
        sum += dihedral(mesh.lift(a), mesh.lift(b), mesh.lift(mesh.corner(c, o[0])),
                        mesh.lift(mesh.corner(c, o[1])));
        // The face through which the ring goes on.
        const TetCopy next = ring[(i + 1) % ring.size()];
        bool facet_ahead = !closed && i + 1 == ring.size();
        for (const std::uint32_t m : o) {
          const Tet& tet = mesh.tet(c.t);
          if (tet.nb[m] == kNoHalfFace) continue;
          const TetCopy g = mesh.neighbour(c, m);
          const bool leads =
              g.t == next.t && (g.e == next.e || (mesh.on_axis(a.orbit) && mesh.on_axis(b.orbit)));
          if (leads && tet.facet[m] != kNoFacet) facet_ahead = true;
        }
        if (facet_ahead) {
          if (seen_facet) smallest = std::min(smallest, sum);
          seen_facet = true;
          sum = 0;
        }
      }
      if (smallest < kSharpDeg * kRadiansADegree - kAngleSlack) {
        sharp_segments_[static_cast<std::size_t>(segment)] = 1;
      }
    }
  }
}

// In every facet, the angle between two segments at a vertex is a sum over subfacets.
void Criteria::find_sharp_vertices(const QuotientTetrahedralization& mesh, bool tessellated) {
  sharp_vertices_.assign(mesh.vertex_slots(), 0);
  acute_vertices_.assign(mesh.vertex_slots(), 0);
  struct Spoke {
    OrbitVertex to;
    std::vector<std::pair<std::size_t, double>> next;  // spoke across a subfacet, angle
    bool segment = false;
  };
  std::vector<TetCopy> star;
  for (std::size_t i = 0; i < mesh.vertex_slots(); ++i) {
    const auto v = static_cast<VertexId>(i);
    if (mesh.kind(v) != VertexKind::kInput) continue;
    star.clear();
    mesh.star(v, star);
    const OrbitVertex apex{v, 0};
    const Point3 x = mesh.lift(apex);
    // Subfacets at the vertex by facet; at an axis vertex those of one period suffice.
    std::map<std::int32_t, std::vector<Spoke>> fans;
    for (const TetCopy& c : star) {
      const Tet& t = mesh.tet(c.t);
      for (std::uint32_t f = 0; f < 4; ++f) {
        if (t.facet[f] == kNoFacet) continue;
        std::array<OrbitVertex, 3> p;
        std::size_t at = 3;
        for (std::size_t j = 0; j < 3; ++j) {
          p[j] = mesh.corner(c, kFaceCorners[f][j]);
          if (p[j] == apex) at = j;
        }
        if (at == 3) continue;
        const OrbitVertex a = p[(at + 1) % 3], b = p[(at + 2) % 3];
        auto& fan = fans[t.facet[f]];
        const auto spoke = [&](OrbitVertex to) {
          for (std::size_t s = 0; s < fan.size(); ++s) {
            if (fan[s].to == to) return s;
          }
          fan.push_back({to, {}, mesh.segment_of(apex, to) != kNoSegment});
          return fan.size() - 1;
        };
        const std::size_t sa = spoke(a), sb = spoke(b);
        const double angle = angle_at(x, mesh.lift(a), mesh.lift(b));
        const auto known = [&](const Spoke& s, std::size_t other) {
          return std::any_of(s.next.begin(), s.next.end(),
                             [&](const auto& n) { return n.first == other; });
        };
        if (!known(fan[sa], sb)) {
          fan[sa].next.emplace_back(sb, angle);
          fan[sb].next.emplace_back(sa, angle);
        }
      }
    }
    for (const auto& [facet, fan] : fans) {
      for (std::size_t s = 0; s < fan.size(); ++s) {
        if (!fan[s].segment) continue;
        for (const auto& [first, angle] : fan[s].next) {
          double sum = angle;
          std::size_t from = s, at = first;
          for (std::size_t steps = 0; !fan[at].segment && steps < fan.size(); ++steps) {
            if (fan[at].next.size() != 2) break;
            const auto& go = fan[at].next[0].first == from ? fan[at].next[1] : fan[at].next[0];
            from = at;
            at = go.first;
            sum += go.second;
          }
          if (fan[at].segment && sum < kSharpDeg * kRadiansADegree - kAngleSlack) {
            acute_vertices_[i] = 1;
          }
        }
      }
    }
  }
  if (!tessellated) sharp_vertices_ = acute_vertices_;
  // The ends of a sharp segment are on it.
  mesh.edges().for_each([&](const EdgeKey& key, std::int32_t segment) {
    if (!sharp_segment(segment)) return;
    sharp_vertices_[static_cast<std::size_t>(key.a)] = 1;
    sharp_vertices_[static_cast<std::size_t>(key.b)] = 1;
    acute_vertices_[static_cast<std::size_t>(key.a)] = 1;
    acute_vertices_[static_cast<std::size_t>(key.b)] = 1;
  });
}

}  // namespace symcell::solid
