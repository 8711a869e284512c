#include "core/plane/symmetry/split_segment.hpp"

#include <string>
#include <vector>

#include "core/geometry/arc.hpp"

namespace symcell::plane {

Point2 place_of(const SymmetricPslg& pslg, const RotationTable& rotations, OrbitVertex v) {
  const Point2 p = pslg.orbit_points[static_cast<std::size_t>(v.orbit)];
  return v.orbit == pslg.centre_orbit ? p : rotations.rotate(p, v.exponent);
}

void split_segment(SymmetricPslg& pslg,
                   const RotationTable& rotations,
                   std::size_t segment,
                   std::span<const double> shares) {
  const SymmetricSegment whole = pslg.segments[segment];
  const bool has_arcs = !pslg.bulges.empty();
  const Point2 a = place_of(pslg, rotations, whole.a), b = place_of(pslg, rotations, whole.b);
  const double bulge = has_arcs ? pslg.bulges[segment] : 0;
  const double angle = angle_of_bulge(bulge);
  OrbitVertex last = whole.a;
  double from = 0;
  bool first = true;
  const auto add = [&](OrbitVertex end, double to) {
    SymmetricSegment part = whole;
    part.a = last;
    part.b = end;
    const double part_bulge = bulge_of_angle((to - from) * angle);
    if (first) {
      pslg.segments[segment] = part;
      if (has_arcs) pslg.bulges[segment] = part_bulge;
    } else {
      pslg.segments.push_back(part);
      if (has_arcs) pslg.bulges.push_back(part_bulge);
    }
    first = false;
    last = end;
    from = to;
  };
  for (const double share : shares) {
    const auto orbit = static_cast<std::int32_t>(pslg.orbit_points.size());
    pslg.orbit_points.push_back(arc_point(a, b, bulge, share));
    add({orbit, 0}, share);
  }
  add(whole.b, 1);
}

Result<void> divide_segments(SymmetricPslg& pslg, const std::vector<DivisionRequest>& divisions) {
  if (divisions.empty()) return {};
  const RotationTable rotations(pslg.fold);
  for (const DivisionRequest& request : divisions) {
    std::vector<double> shares;
    for (std::int32_t i = 1; i < request.parts; ++i) {
      shares.push_back(static_cast<double>(i) / request.parts);
    }
    bool any = false;
    const std::size_t segments = pslg.segments.size();
    for (std::size_t s = 0; s < segments; ++s) {
      if (!pslg.has_marker(s, request.marker)) continue;
      any = true;
      if (pslg.segments[s].divided) continue;  // its marker differs between copies
      if (!pslg.bulges.empty() && pslg.bulges[s] != 0) {
        return fail(ErrorCode::kBadOption,
                    "divisions: marker " + std::to_string(request.marker) +
                        " is one of arcs, whose chords follow chord_error and sizes",
                    {}, "/options/divisions");
      }
      pslg.segments[s].divided = true;
      split_segment(pslg, rotations, s, shares);
    }
    if (!any) {
      return fail(
          ErrorCode::kBadOption,
          "divisions: no segment of the domain has marker " + std::to_string(request.marker), {},
          "/options/divisions");
    }
  }
  return {};
}

}  // namespace symcell::plane
