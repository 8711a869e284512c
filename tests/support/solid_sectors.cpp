#include "tests/support/solid_sectors.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "core/base/index.hpp"

namespace symcell::test {
namespace {

class PrismBuilder {
 public:
  explicit PrismBuilder(const PrismSpec& spec) : spec_(spec) {
    sector_.fold = spec.fold;
    sector_.start_angle = spec.start_angle;
    theta_ = 2 * std::numbers::pi / spec.fold;
  }

  solid::Sector build() && {
    for (std::size_t l = 0; l < spec_.levels.size(); ++l) add_level(l);
    for (std::size_t l = 0; l < spec_.levels.size(); ++l) add_disc(l);
    if (!spec_.discs_only) {
      for (std::size_t l = 0; l + 1 < spec_.levels.size(); ++l) add_walls(outer_, l, false);
      if (spec_.inner_radius > 0) {
        for (std::size_t l = 0; l + 1 < spec_.levels.size(); ++l) add_walls(inner_, l, true);
      }
      const double height = spec_.levels.back() - spec_.levels.front();
      sector_.expected_volume =
          height * (polygon_area(spec_.outer_radius) - polygon_area(spec_.inner_radius));
    }
    for (std::int32_t f = 0; f < facets_; ++f) sector_.facet_markers.push_back(f + 1);
    for (std::int32_t s = 0; s < segments_; ++s) sector_.segment_markers.push_back(s + 1);
    if (spec_.inward) {
      for (solid::SectorFace& f : sector_.faces) std::swap(f.v[1], f.v[2]);
    }
    return std::move(sector_);
  }

 private:
  // Sector vertices along a polygon at one level, from the lower cut to the higher one; closed for
  // fold 1, where the last is the first again.
  using Chain = std::vector<std::int32_t>;

  [[nodiscard]] double polygon_area(double radius) const {
    const double count = spec_.fold * spec_.corners;
    return 0.5 * count * radius * radius * std::sin(2 * std::numbers::pi / count);
  }

  std::int32_t add_orbit(Point3 p, solid::SectorVertexKind kind, bool axis) {
    sector_.orbit_points.push_back(p);
    sector_.kinds.push_back(kind);
    sector_.on_axis.push_back(axis ? 1 : 0);
    sector_.vertices.push_back({static_cast<std::int32_t>(sector_.orbit_points.size() - 1), 0});
    return static_cast<std::int32_t>(sector_.vertices.size() - 1);
  }

  [[nodiscard]] Point3 polar(double radius, double angle, double z) const {
    return {radius * std::cos(angle), radius * std::sin(angle), z};
  }

  Chain add_chain(double radius, double z) {
    Chain chain;
    const double step = theta_ / spec_.corners;
    if (spec_.fold > 1) {
      const double on_side = radius * std::cos(step / 2);
      chain.push_back(add_orbit(polar(on_side, spec_.start_angle, z),
                                solid::SectorVertexKind::kOnSegment, false));
    }
    for (std::int32_t c = 0; c < spec_.corners; ++c) {
      chain.push_back(add_orbit(polar(radius, spec_.start_angle + (c + 0.5) * step, z),
                                solid::SectorVertexKind::kFixed, false));
    }
    if (spec_.fold > 1) {
      const std::int32_t orbit = sector_.vertices[at(chain.front())].orbit;
      sector_.vertices.push_back({orbit, 1});
      chain.push_back(static_cast<std::int32_t>(sector_.vertices.size() - 1));
    } else {
      chain.push_back(chain.front());
    }
    return chain;
  }

  void add_level(std::size_t l) {
    const double z = spec_.levels[l];
    outer_.push_back(add_chain(spec_.outer_radius, z));
    if (spec_.inner_radius > 0) {
      inner_.push_back(add_chain(spec_.inner_radius, z));
    } else {
      // For fold 1 a vertex in the middle of the disc like any other.
      axis_.push_back(add_orbit({0, 0, z}, solid::SectorVertexKind::kOnFacet, spec_.fold > 1));
    }
  }

  void add_face(std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t facet) {
    sector_.faces.push_back({{a, b, c}, facet});
  }

  // Sides of a polygon: the first and the last piece are one side, across the cut.
  void add_sides(const Chain& chain) {
    const std::int32_t first = segments_;
    const auto pieces = static_cast<std::int32_t>(chain.size()) - 1;
    segments_ += spec_.corners;
    for (std::int32_t i = 0; i < pieces; ++i) {
      sector_.edges.push_back({chain[at(i)], chain[at(i + 1)], first + i % spec_.corners});
    }
  }

  void add_cut(std::int32_t a, std::int32_t b) {
    if (spec_.fold > 1) sector_.lower_cut.push_back({a, b});
  }

  // Seen from above counter-clockwise, but for the bottom.
  void add_disc(std::size_t l) {
    const std::int32_t facet = facets_++;
    const bool bottom = l == 0 && !spec_.discs_only;
    const auto face = [&](std::int32_t a, std::int32_t b, std::int32_t c) {
      bottom ? add_face(a, c, b, facet) : add_face(a, b, c, facet);
    };
    const Chain& out = outer_[l];
    add_sides(out);
    if (spec_.inner_radius > 0) {
      const Chain& in = inner_[l];
      add_sides(in);
      for (std::size_t i = 0; i + 1 < out.size(); ++i) {
        face(in[i], out[i], out[i + 1]);
        face(in[i], out[i + 1], in[i + 1]);
      }
      add_cut(in.front(), out.front());
    } else {
      for (std::size_t i = 0; i + 1 < out.size(); ++i) face(axis_[l], out[i], out[i + 1]);
      add_cut(axis_[l], out.front());
    }
  }

  void add_walls(const std::vector<Chain>& chains, std::size_t l, bool inner) {
    const Chain& low = chains[l];
    const Chain& high = chains[l + 1];
    const std::int32_t first = facets_;
    facets_ += spec_.corners;
    for (std::size_t i = 0; i + 1 < low.size(); ++i) {
      const std::int32_t facet = first + static_cast<std::int32_t>(i) % spec_.corners;
      if (inner) {
        add_face(low[i], high[i + 1], low[i + 1], facet);
        add_face(low[i], high[i], high[i + 1], facet);
      } else {
        add_face(low[i], low[i + 1], high[i + 1], facet);
        add_face(low[i], high[i + 1], high[i], facet);
      }
    }
    // Upright edges at the corners; the ends of the chain lie inside a side.
    const std::size_t begin = spec_.fold > 1 ? 1 : 0;
    for (std::size_t i = begin; i + 1 < low.size(); ++i) {
      sector_.edges.push_back({low[i], high[i], segments_++});
    }
    add_cut(low.front(), high.front());
  }

  const PrismSpec spec_;
  double theta_ = 0;
  solid::Sector sector_;
  std::int32_t facets_ = 0;
  std::int32_t segments_ = 0;
  std::vector<Chain> outer_;  // per level
  std::vector<Chain> inner_;
  std::vector<std::int32_t> axis_;
};

}  // namespace

solid::Sector prism_sector(const PrismSpec& spec) {
  return PrismBuilder(spec).build();
}

solid::Sector block_sector(std::int32_t fold, double radius, double size, double start_angle) {
  solid::Sector sector;
  sector.fold = fold;
  sector.start_angle = start_angle;
  const double middle = start_angle + std::numbers::pi / fold;
  const double x = radius * std::cos(middle), y = radius * std::sin(middle);
  sector.orbit_points = {{x, y, 0}, {x + size, y, 0}, {x, y + size, 0}, {x, y, size}};
  for (std::int32_t i = 0; i < 4; ++i) {
    sector.on_axis.push_back(0);
    sector.kinds.push_back(solid::SectorVertexKind::kFixed);
    sector.vertices.push_back({i, 0});
    sector.facet_markers.push_back(i + 1);
  }
  sector.faces = {{{0, 2, 1}, 0}, {{0, 1, 3}, 1}, {{0, 3, 2}, 2}, {{1, 2, 3}, 3}};
  std::int32_t segment = 0;
  for (std::int32_t a = 0; a < 4; ++a) {
    for (std::int32_t b = a + 1; b < 4; ++b) {
      sector.edges.push_back({a, b, segment++});
      sector.segment_markers.push_back(segment);
    }
  }
  sector.expected_volume = fold * size * size * size / 6;
  return sector;
}

solid::Sector joined(solid::Sector first, const solid::Sector& second, bool cavity) {
  const auto orbits = static_cast<std::int32_t>(first.orbit_points.size());
  const auto vertices = static_cast<std::int32_t>(first.vertices.size());
  const auto facets = static_cast<std::int32_t>(first.facet_markers.size());
  const auto segments = static_cast<std::int32_t>(first.segment_markers.size());
  const auto append = [](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  append(first.orbit_points, second.orbit_points);
  append(first.on_axis, second.on_axis);
  append(first.kinds, second.kinds);
  append(first.holes, second.holes);
  append(first.regions, second.regions);
  for (const OrbitVertex v : second.vertices) {
    first.vertices.push_back({v.orbit + orbits, v.exponent});
  }
  for (const solid::SectorFace& f : second.faces) {
    first.faces.push_back(
        {{f.v[0] + vertices, f.v[1] + vertices, f.v[2] + vertices}, f.facet + facets});
  }
  for (const solid::SectorEdge& e : second.edges) {
    first.edges.push_back({e.a + vertices, e.b + vertices, e.segment + segments});
  }
  for (const auto& [a, b] : second.lower_cut)
    first.lower_cut.push_back({a + vertices, b + vertices});
  for (const std::int32_t m : second.facet_markers) first.facet_markers.push_back(facets + m);
  for (const std::int32_t m : second.segment_markers) first.segment_markers.push_back(segments + m);
  first.expected_volume += cavity ? -second.expected_volume : second.expected_volume;
  return first;
}

}  // namespace symcell::test
