#include "tests/support/pslg_builders.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "core/base/index.hpp"

namespace symcell {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

Point2 polar(double radius, double angle) {
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

// Twice the area of one sector's part of a star-shaped loop, times the fold.
double loop_area(const SectorBuilder& builder, const std::vector<Point2>& points) {
  double doubled = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) doubled += cross(points[i], points[i + 1]);
  doubled += cross(points.back(), builder.turned(points.front(), 1));
  return 0.5 * doubled * builder.fold();
}

double distance_to_origin(Point2 a, Point2 b) {
  const Point2 u = b - a;
  const double t = std::clamp(-dot(a, u) / dot(u, u), 0.0, 1.0);
  return length(a + t * u);
}

}  // namespace

SectorBuilder::Vertex SectorBuilder::add_vertex(Point2 p) {
  const Vertex v{static_cast<std::int32_t>(pslg_.vertices.size()), 0, false};
  for (std::int32_t k = 0; k < fold_; ++k) pslg_.vertices.push_back(turned(p, k));
  return v;
}

SectorBuilder::Vertex SectorBuilder::add_centre() {
  if (centre_ < 0) {
    centre_ = static_cast<std::int32_t>(pslg_.vertices.size());
    pslg_.vertices.push_back({0, 0});
  }
  return {centre_, 0, true};
}

void SectorBuilder::add_segment(Vertex a, Vertex b, std::int32_t marker) {
  for (std::int32_t k = 0; k < fold_; ++k) {
    pslg_.segments.push_back({index(a, k), index(b, k), marker});
  }
}

void SectorBuilder::add_loop(const std::vector<Vertex>& vertices, std::int32_t marker) {
  for (std::size_t i = 0; i + 1 < vertices.size(); ++i) {
    add_segment(vertices[i], vertices[i + 1], marker);
  }
  Vertex next = vertices.front();
  ++next.exponent;
  add_segment(vertices.back(), next, marker);
}

void SectorBuilder::add_closed(const std::vector<Vertex>& vertices, std::int32_t marker) {
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    add_segment(vertices[i], vertices[(i + 1) % vertices.size()], marker);
  }
}

void SectorBuilder::add_hole(Point2 p) {
  for (std::int32_t k = 0; k < fold_; ++k) pslg_.holes.push_back(turned(p, k));
}

void SectorBuilder::add_region(Point2 p, std::int32_t attribute, double max_area) {
  for (std::int32_t k = 0; k < fold_; ++k) {
    pslg_.regions.push_back({turned(p, k), attribute, max_area});
  }
}

void SectorBuilder::add_diameter(Vertex v, std::int32_t marker) {
  pslg_.segments.push_back({index(v, 0), index(v, fold_ / 2), marker});
}

Point2 SectorBuilder::turned(Point2 p, std::int32_t exponent) const {
  if (exponent % fold_ == 0) return p;
  const double angle = kTurn * exponent / fold_;
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {c * p.x - s * p.y, s * p.x + c * p.y};
}

Point2 SectorBuilder::position(Vertex v) const {
  return pslg_.vertices[at(index(v, 0))];
}

std::int32_t SectorBuilder::index(Vertex v, std::int32_t exponent) const {
  if (v.centre) return v.first;
  const std::int32_t k = (v.exponent + exponent) % fold_;
  return v.first + (k < 0 ? k + fold_ : k);
}

Pslg regular_ring(std::int32_t fold, double outer, double inner) {
  SectorBuilder builder(fold);
  builder.add_loop({builder.add_vertex({outer, 0})}, 1);
  if (inner > 0) {
    builder.add_loop({builder.add_vertex({inner, 0})}, 2);
    builder.pslg().holes.push_back({0, 0});
  }
  return builder.pslg();
}

Pslg star(std::int32_t fold, double outer, double inner) {
  SectorBuilder builder(fold);
  const auto tip = builder.add_vertex({outer, 0});
  builder.add_loop({tip, builder.add_vertex(polar(inner, 0.5 * kTurn / fold))}, 1);
  return builder.pslg();
}

Pslg gear(std::int32_t teeth, double outer, double root, double bore) {
  SectorBuilder builder(teeth);
  const double sector = kTurn / teeth;
  builder.add_loop(
      {builder.add_vertex(polar(root, 0)), builder.add_vertex(polar(root, 0.3 * sector)),
       builder.add_vertex(polar(outer, 0.5 * sector)),
       builder.add_vertex(polar(outer, 0.8 * sector))},
      1);
  builder.add_loop({builder.add_vertex({bore, 0})}, 2);
  builder.pslg().holes.push_back({0, 0});
  return builder.pslg();
}

Pslg flange(std::int32_t bolts, double outer, double pitch, double bolt, double bore) {
  SectorBuilder builder(bolts);
  const std::int32_t per_sector = 1 + 48 / bolts;
  std::vector<SectorBuilder::Vertex> rim;
  std::vector<SectorBuilder::Vertex> inner;
  for (std::int32_t i = 0; i < per_sector; ++i) {
    const double angle = kTurn * i / (bolts * per_sector);
    rim.push_back(builder.add_vertex(polar(outer, angle)));
    inner.push_back(builder.add_vertex(polar(bore, angle)));
  }
  builder.add_loop(rim, 1);
  builder.add_loop(inner, 2);
  std::vector<SectorBuilder::Vertex> round;
  for (std::int32_t i = 0; i < 12; ++i) {
    round.push_back(builder.add_vertex(Point2{pitch, 0} + polar(bolt, kTurn * i / 12)));
  }
  builder.add_closed(round, 3);
  builder.add_hole({pitch, 0});
  builder.pslg().holes.push_back({0, 0});
  return builder.pslg();
}

Pslg spoked_wheel(std::int32_t fold, double outer) {
  SectorBuilder builder(fold);
  const auto rim = builder.add_vertex({outer, 0});
  builder.add_loop({rim}, 1);
  builder.add_segment(rim, builder.add_centre(), 2);
  builder.add_region(polar(0.3 * outer, 0.5 * kTurn / fold), 7,
                     std::numeric_limits<double>::infinity());
  return builder.pslg();
}

Pslg transformed(Pslg pslg, double scale, double angle, Point2 offset) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  const auto move = [&](Point2& p) {
    p = {scale * (c * p.x - s * p.y) + offset.x, scale * (s * p.x + c * p.y) + offset.y};
  };
  for (Point2& p : pslg.vertices) move(p);
  for (Point2& p : pslg.holes) move(p);
  for (PslgRegion& r : pslg.regions) {
    move(r.point);
    r.max_area *= scale * scale;
  }
  return pslg;
}

Pslg shuffled(const Pslg& pslg, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::vector<std::int32_t> place(pslg.vertices.size());
  std::iota(place.begin(), place.end(), 0);
  std::shuffle(place.begin(), place.end(), engine);
  Pslg result = pslg;
  for (std::size_t i = 0; i < place.size(); ++i) result.vertices[at(place[i])] = pslg.vertices[i];
  for (PslgSegment& s : result.segments) {
    s.a = place[at(s.a)];
    s.b = place[at(s.b)];
    if (engine() % 2 == 0) std::swap(s.a, s.b);
  }
  std::shuffle(result.segments.begin(), result.segments.end(), engine);
  std::shuffle(result.holes.begin(), result.holes.end(), engine);
  std::shuffle(result.regions.begin(), result.regions.end(), engine);
  return result;
}

namespace {

// Works from the outermost loop inwards. Each thing stays in its own band of radii, so nothing can
// meet anything else; within a band, copies of a segment along which the radius grows are turned
// copies of a graph over the radius, so they cannot meet either.
class RandomModel {
 public:
  RandomModel(std::uint64_t seed, std::int32_t fold)
      : engine_(seed * 0x9e3779b97f4a7c15ULL + static_cast<std::uint64_t>(fold)),
        fold_(fold),
        sector_(kTurn / fold),
        builder_(fold) {
    traits_.fold = fold;
  }

  Pslg build(RandomPslgTraits* traits) {
    Loop outer = add_loop(1.0, {});
    const int bands = integer(0, 3);
    for (int i = 0; i < bands; ++i) outer = add_band(outer);
    add_core(outer);
    if (chance(0.25)) add_extra_vertices();
    const double angle = chance(0.3) ? 0 : uniform(0, kTurn);
    const double scale = std::pow(10.0, integer(-4, 4));
    const Point2 offset =
        chance(0.3) ? Point2{} : scale * Point2{uniform(-20, 20), uniform(-20, 20)};
    traits_.center = offset;
    traits_.scale = scale;
    traits_.area *= scale * scale;
    Pslg result = transformed(builder_.pslg(), scale, angle, offset);
    if (chance(0.5)) result = shuffled(result, engine_());
    if (traits != nullptr) *traits = traits_;
    return result;
  }

 private:
  using Vertex = SectorBuilder::Vertex;

  struct Loop {
    std::vector<Vertex> vertices;
    std::vector<double> angles;
    double inner = 0;  // nothing of the loop lies nearer to the centre
    double area = 0;
  };

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }
  bool chance(double probability) { return uniform(0, 1) < probability; }
  int marker() { return integer(0, 3); }

  // Vertices at `outer` radius and up to a tenth below; `angles`: where vertices must be.
  Loop add_loop(double outer, std::vector<double> angles) {
    const int least = fold_ == 1 ? 5 : fold_ == 2 ? 3 : fold_ <= 4 ? 2 : 1;
    const int most = std::max(least, chance(0.3) ? 12 : 40 / fold_);
    const int count = integer(least, most);
    const double phase = angles.empty() ? uniform(0, sector_) : angles.front();
    for (int i = angles.empty() ? 0 : 1; i < count; ++i) {
      angles.push_back(phase + sector_ * (i + uniform(-0.3, 0.3) * (i > 0)) / count);
    }
    std::sort(angles.begin(), angles.end());
    // A required angle and a random one may nearly coincide: keep the required (earlier added) one.
    Loop loop;
    std::vector<Point2> points;
    for (const double angle : angles) {
      if (!loop.angles.empty() && angle - loop.angles.back() < 0.05 * sector_ / count) continue;
      loop.angles.push_back(angle);
      points.push_back(polar(outer * uniform(0.9, 1.0), angle));
    }
    loop.inner = distance_to_origin(points.back(), builder_.turned(points.front(), 1));
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      loop.inner = std::min(loop.inner, distance_to_origin(points[i], points[i + 1]));
    }
    for (const Point2 p : points) loop.vertices.push_back(builder_.add_vertex(p));
    builder_.add_loop(loop.vertices, marker());
    loop.area = loop_area(builder_, points);
    ++traits_.curves;
    return loop;
  }

  // A band inside `outer` that ends in another loop: empty, with spokes, things, or a void.
  Loop add_band(const Loop& outer) {
    const double high = 0.97 * outer.inner;
    const double low = high * uniform(0.4, 0.8);
    const int kind = integer(0, 3);
    std::vector<double> angles;
    if (kind == 1) angles.push_back(outer.angles[outer.angles.size() / 2]);
    const Loop inner = add_loop(0.97 * low, angles);
    const double ring = outer.area - inner.area;
    if (kind == 0) {
      traits_.islands = true;
      builder_.pslg().holes.push_back(polar(0.5 * (high + low), uniform(0, kTurn)));
      return inner;
    }
    traits_.area += ring;
    if (kind == 1) {
      add_spokes(outer, inner);
    } else {
      if (kind == 2) add_things(low, high);
      if (chance(0.5)) {
        traits_.regions = true;
        // Outside the things' own radii.
        builder_.pslg().regions.push_back(
            {polar(0.5 * (high + outer.inner), uniform(0, kTurn)), integer(1, 5), max_area()});
      }
    }
    return inner;
  }

  double max_area() {
    return chance(0.5) ? std::numeric_limits<double>::infinity() : uniform(0.01, 0.1);
  }

  // The inner loop's first vertex has the angle of the outer one's middle vertex; both loops are
  // star-shaped, so the radial segment meets them at its ends only.
  void add_spokes(const Loop& outer, const Loop& inner) {
    traits_.spokes = true;
    const std::size_t o = outer.angles.size() / 2;
    const auto i = static_cast<std::size_t>(
        std::find(inner.angles.begin(), inner.angles.end(), outer.angles[o]) -
        inner.angles.begin());
    builder_.add_segment(outer.vertices[o], inner.vertices[i], marker());
    if (!chance(0.5)) return;
    traits_.regions = true;
    const Point2 between =
        0.5 * (builder_.position(outer.vertices[o]) + builder_.position(inner.vertices[i]));
    // Near the spoke: further round, a coarse loop may pass on the other side.
    builder_.add_region(polar(length(between), outer.angles[o] + 0.003 * sector_), integer(1, 5),
                        max_area());
  }

  void add_things(double low, double high) {
    const int count = integer(1, 3);
    const double ratio = std::pow(low / high, 1.0 / count);
    for (int i = 0; i < count; ++i) {
      const double top = 0.99 * high * std::pow(ratio, i);
      add_thing(1.01 * top * ratio / 0.99, top);
    }
  }

  void add_thing(double low, double high) {
    const int kind = integer(0, 3);
    const double angle = uniform(0, sector_);
    if (kind == 0) {
      add_small_hole(low, high, angle);
    } else if (kind == 1) {
      traits_.isolated = true;
      builder_.add_vertex(polar(uniform(low, high), angle));
    } else {
      add_swirl(low, high, angle, kind == 3);
    }
  }

  void add_small_hole(double low, double high, double angle) {
    const double middle = 0.5 * (low + high);
    const double room =
        std::min(0.5 * (high - low), middle * std::sin(std::min(0.5 * sector_, 1.5)));
    const double radius = 0.8 * room;
    const Point2 center = polar(middle, angle);
    const int corners = integer(3, 12);
    std::vector<Vertex> vertices;
    for (int i = 0; i < corners; ++i) {
      vertices.push_back(builder_.add_vertex(center + polar(radius, angle + kTurn * i / corners)));
    }
    builder_.add_closed(vertices, marker());
    const double area = 0.5 * corners * radius * radius * std::sin(kTurn / corners) * fold_;
    if (chance(0.7)) {
      traits_.small_holes = true;
      traits_.area -= area;
      builder_.add_hole(center);
    } else {
      traits_.regions = true;
      builder_.add_region(center, integer(1, 5), max_area());
    }
  }

  // A straight segment whose radius grows; with `fork` a second one from the same inner end.
  void add_swirl(double low, double high, double angle, bool fork) {
    traits_.dangling = true;
    const double widest = std::acos(low / high);
    const double turn = uniform(-0.95, 0.95) * widest;
    const Vertex foot = builder_.add_vertex(polar(low, angle));
    builder_.add_segment(foot, builder_.add_vertex(polar(high, angle + turn)), marker());
    if (!fork) return;
    const double apart = std::min(0.4 * sector_, 0.3 * widest) * uniform(0.2, 1);
    builder_.add_segment(
        foot, builder_.add_vertex(polar(high, angle + (turn > 0 ? turn - apart : turn + apart))),
        marker());
  }

  void add_core(const Loop& outer) {
    const int kind = integer(0, 4);
    if (kind == 0 && traits_.area > 0) {  // bore
      builder_.pslg().holes.push_back({0, 0});
      traits_.islands = traits_.islands && traits_.curves > 2;
      return;
    }
    traits_.area += outer.area;
    traits_.centre_meshed = true;
    if (kind == 1) {
      traits_.centre_vertex = traits_.isolated = true;
      builder_.add_centre();
    } else if (kind == 2) {
      traits_.centre_vertex = traits_.spokes = true;
      builder_.add_segment(outer.vertices.front(), builder_.add_centre(), marker());
    } else if (kind == 3 && fold_ == 2) {
      traits_.through_centre = true;
      builder_.add_diameter(outer.vertices.front(), marker());
    } else if (kind == 4) {
      add_things(0.3 * outer.inner, 0.97 * outer.inner);
    }
  }

  // Cuts one copy of some segments at a vertex that the other copies lack.
  void add_extra_vertices() {
    traits_.geometry_only = true;
    Pslg& pslg = builder_.pslg();
    const auto count = static_cast<std::int32_t>(pslg.segments.size());
    for (int i = integer(1, 4); i > 0; --i) {
      const PslgSegment segment = pslg.segments[at(integer(0, count - 1))];
      auto& original = *std::find(pslg.segments.begin(), pslg.segments.end(), segment);
      const Point2 a = pslg.vertices[at(segment.a)];
      const Point2 b = pslg.vertices[at(segment.b)];
      const auto middle = static_cast<std::int32_t>(pslg.vertices.size());
      pslg.vertices.push_back(a + uniform(0.2, 0.8) * (b - a));
      original.b = middle;
      pslg.segments.push_back({middle, segment.b, segment.marker});
    }
  }

  std::mt19937_64 engine_;
  std::int32_t fold_;
  double sector_;
  SectorBuilder builder_;
  RandomPslgTraits traits_;
};

}  // namespace

Pslg random_symmetric_pslg(std::uint64_t seed, std::int32_t fold, RandomPslgTraits* traits) {
  return RandomModel(seed, fold).build(traits);
}

}  // namespace symcell
