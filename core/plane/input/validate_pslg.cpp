#include "core/plane/input/validate_pslg.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/index.hpp"
#include "core/geometry/limits.hpp"
#include "core/geometry/point_grid.hpp"
#include "core/geometry/predicates.hpp"
#include "core/geometry/resolution.hpp"
#include "core/model/describe.hpp"
#include "core/plane/input/open_contours.hpp"
#include "core/plane/input/subdomains.hpp"

namespace symcell::plane {
namespace {

std::string pointer_to(const char* array, std::size_t index) {
  return "/" + std::string(array) + "/" + std::to_string(index);
}

Result<void> check_size(const Pslg& pslg) {
  const auto too_many = [](const char* what, std::size_t count, std::size_t limit) {
    return fail(ErrorCode::kTooLarge,
                std::to_string(count) + " " + what + " are more than the limit of " +
                    std::to_string(limit) + "; simplify the model",
                {}, "/" + std::string(what));
  };
  constexpr std::size_t kMaxSegments = 3 * kMaxPslgVertices;  // a planar graph has no more
  if (pslg.vertices.size() > kMaxPslgVertices) {
    return too_many("vertices", pslg.vertices.size(), kMaxPslgVertices);
  }
  if (pslg.segments.size() > kMaxSegments) {
    return too_many("segments", pslg.segments.size(), kMaxSegments);
  }
  if (pslg.holes.size() > kMaxPslgVertices) {
    return too_many("holes", pslg.holes.size(), kMaxPslgVertices);
  }
  if (pslg.regions.size() > kMaxPslgVertices) {
    return too_many("regions", pslg.regions.size(), kMaxPslgVertices);
  }
  return {};
}

Result<void> check_point(Point2 p, const char* array, std::size_t index, const char* what) {
  const auto name = std::string(what) + " " + std::to_string(index);
  if (!std::isfinite(p.x) || !std::isfinite(p.y)) {
    return fail(ErrorCode::kNonFinite,
                name + " has a coordinate that is not a finite number; give finite coordinates",
                {static_cast<std::int64_t>(index)}, pointer_to(array, index));
  }
  if (std::abs(p.x) > kMaxCoordinate || std::abs(p.y) > kMaxCoordinate) {
    return fail(ErrorCode::kCoordinateRange,
                name + " at " + describe_point(p) + " exceeds the largest coordinate of " +
                    describe_number(kMaxCoordinate) + "; use another length unit",
                {static_cast<std::int64_t>(index)}, pointer_to(array, index));
  }
  return {};
}

Result<void> check_points(const Pslg& pslg) {
  for (std::size_t i = 0; i < pslg.vertices.size(); ++i) {
    SYMCELL_TRY(check_point(pslg.vertices[i], "vertices", i, "vertex"));
  }
  for (std::size_t i = 0; i < pslg.holes.size(); ++i) {
    SYMCELL_TRY(check_point(pslg.holes[i], "holes", i, "hole seed"));
  }
  for (std::size_t i = 0; i < pslg.regions.size(); ++i) {
    SYMCELL_TRY(check_point(pslg.regions[i].point, "regions", i, "region seed"));
  }
  return {};
}

Result<void> check_extent(const Pslg& pslg) {
  if (pslg.vertices.size() < 3 || pslg.segments.size() < 3) {
    return fail(ErrorCode::kDegenerateGeometry,
                "the model has " + std::to_string(pslg.vertices.size()) + " vertices and " +
                    std::to_string(pslg.segments.size()) +
                    " segments, which enclose nothing; at least three of each are needed");
  }
  Point2 low = pslg.vertices.front();
  Point2 high = low;
  for (const Point2 p : pslg.vertices) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const double extent = std::max(high.x - low.x, high.y - low.y);
  if (extent < 1 / kMaxCoordinate && extent > 0) {
    return fail(ErrorCode::kCoordinateRange,
                "the model's extent of " + describe_number(extent) + " is below the smallest of " +
                    describe_number(1 / kMaxCoordinate) + "; use another length unit");
  }
  return {};
}

Result<void> check_segments(const Pslg& pslg) {
  const auto count = static_cast<std::int64_t>(pslg.vertices.size());
  for (std::size_t s = 0; s < pslg.segments.size(); ++s) {
    for (const std::int32_t v : {pslg.segments[s].a, pslg.segments[s].b}) {
      if (v >= 0 && v < count) continue;
      return fail(ErrorCode::kIndexOutOfRange,
                  "segment " + std::to_string(s) + " refers to vertex " + std::to_string(v) +
                      ", but vertices are numbered 0 to " + std::to_string(count - 1),
                  {static_cast<std::int64_t>(s)}, pointer_to("segments", s));
    }
  }
  for (std::size_t s = 0; s < pslg.segments.size(); ++s) {
    const PslgSegment& segment = pslg.segments[s];
    if (segment.a != segment.b) continue;
    return fail(ErrorCode::kZeroLengthSegment,
                "segment " + std::to_string(s) + " joins " +
                    describe_vertex(pslg.vertices, segment.a) + " to itself; remove it",
                {static_cast<std::int64_t>(s)}, pointer_to("segments", s));
  }
  return {};
}

// Against a segment as base: exact, whatever the vertices' order.
Result<void> check_not_collinear(const Pslg& pslg) {
  const Point2 first = pslg.vertices.front();
  const auto other = std::find_if(pslg.vertices.begin(), pslg.vertices.end(),
                                  [&](Point2 p) { return p != first; });
  const bool spread =
      other != pslg.vertices.end() && std::any_of(other, pslg.vertices.end(), [&](Point2 p) {
        return orientation(first, *other, p) != Sign::kZero;
      });
  if (spread) return {};
  return fail(ErrorCode::kDegenerateGeometry,
              "all vertices lie on one line; a plane model needs area");
}

// Vertices nearer to each other than coordinates of this size resolve are one: as two they would be
// features that no check of a mesh can distinguish from faults.
Result<void> check_near_duplicates(const Pslg& pslg) {
  const double resolution = resolution_of(pslg.vertices);
  if (!(resolution > 0)) return {};
  PointGrid grid(resolution, pslg.vertices.size());
  for (std::size_t i = 0; i < pslg.vertices.size(); ++i) {
    const Point2 p = pslg.vertices[i];
    const std::int32_t near = grid.nearest(p);
    const auto id = static_cast<std::int32_t>(i);
    if (near >= 0) {
      return fail(ErrorCode::kDuplicateVertices,
                  describe_near_duplicates(near, id, describe_point(p),
                                           distance(p, pslg.vertices[at(near)]), "segments"),
                  {near, id}, pointer_to("vertices", i));
    }
    grid.insert(p, id);
  }
  return {};
}

// Equal coordinates come before collinearity in the report, so they are looked for on their own.
Result<void> check_duplicates(const Pslg& pslg) {
  std::vector<std::int32_t> order(pslg.vertices.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::int32_t>(i);
  const auto key = [&](std::int32_t i) {
    return std::pair(pslg.vertices[at(i)].x, pslg.vertices[at(i)].y);
  };
  std::sort(order.begin(), order.end(), [&](std::int32_t i, std::int32_t j) {
    return std::pair(key(i), i) < std::pair(key(j), j);
  });
  for (std::size_t i = 1; i < order.size(); ++i) {
    const std::int32_t u = order[i - 1];
    const std::int32_t v = order[i];
    if (pslg.vertices[at(u)] != pslg.vertices[at(v)]) continue;
    return fail(ErrorCode::kDuplicateVertices,
                describe_duplicates(u, v, describe_point(pslg.vertices[at(v)]), "segments"), {u, v},
                pointer_to("vertices", at(v)));
  }
  return check_near_duplicates(pslg);
}

struct Seed {
  std::size_t index = 0;  // among holes or regions
  bool hole = false;
  Point2 point;

  [[nodiscard]] std::string name() const {
    return std::string(hole ? "hole seed " : "region seed ") + std::to_string(index) + " at " +
           describe_point(point);
  }
  [[nodiscard]] std::string pointer() const {
    return pointer_to(hole ? "holes" : "regions", index);
  }
};

Seed seed_of(const Pslg& pslg, std::size_t query) {
  if (query < pslg.holes.size()) return {query, true, pslg.holes[query]};
  const std::size_t r = query - pslg.holes.size();
  return {r, false, pslg.regions[r].point};
}

Result<void> check_seed_places(const Pslg& pslg, const PlanarMap& map) {
  const double resolution = resolution_of(pslg.vertices);
  PointGrid vertices(resolution, pslg.vertices.size());
  for (std::size_t v = 0; v < pslg.vertices.size(); ++v) {
    vertices.insert(pslg.vertices[v], static_cast<std::int32_t>(v));
  }
  for (std::size_t q = 0; q < map.query_face.size(); ++q) {
    const Seed seed = seed_of(pslg, q);
    if (map.query_piece[q] >= 0) {
      const std::int32_t s = map.pieces[at(map.query_piece[q])].segment;
      return fail(ErrorCode::kUnreachableSeed,
                  seed.name() + " lies on " + describe_segment(pslg.vertices, pslg.segments, s) +
                      "; move it into the face it is meant for",
                  {static_cast<std::int64_t>(seed.index)}, seed.pointer());
    }
    if (const std::int32_t v = vertices.nearest(seed.point); v >= 0) {
      return fail(ErrorCode::kUnreachableSeed,
                  seed.name() + " lies on vertex " + std::to_string(v) +
                      "; move it into the face it is meant for",
                  {static_cast<std::int64_t>(seed.index)}, seed.pointer());
    }
    if (map.query_face[q] == 0) {
      return fail(ErrorCode::kUnreachableSeed,
                  seed.name() +
                      " is not enclosed by segments; move it into a face, close the segments "
                      "round it, or remove it",
                  {static_cast<std::int64_t>(seed.index)}, seed.pointer());
    }
  }
  return {};
}

Result<void> check_seed_conflicts(const Pslg& pslg, const PlanarMap& map) {
  std::vector<std::int32_t> first(at(map.face_count), -1);
  for (std::size_t q = 0; q < map.query_face.size(); ++q) {
    std::int32_t& earlier = first[at(map.query_face[q])];
    if (earlier < 0) {
      earlier = static_cast<std::int32_t>(q);
      continue;
    }
    const Seed seed = seed_of(pslg, q);
    const Seed other = seed_of(pslg, at(earlier));
    bool agree = seed.hole == other.hole;
    if (agree && !seed.hole) {
      const PslgRegion& r = pslg.regions[seed.index];
      const PslgRegion& s = pslg.regions[other.index];
      agree = r.attribute == s.attribute && r.max_area == s.max_area;
    }
    if (agree) continue;
    return fail(ErrorCode::kConflictingSeeds,
                other.name() + " and " + seed.name() +
                    " lie in the same face, with no segment between; keep one of them or close the "
                    "segments between them",
                {static_cast<std::int64_t>(other.index), static_cast<std::int64_t>(seed.index)},
                seed.pointer());
  }
  return {};
}

Result<void> check_enclosed(const Pslg& pslg, const Subdomains& subdomains) {
  if (subdomains.map.face_count < 2) {
    return fail(ErrorCode::kDegenerateGeometry,
                "the segments enclose no area; close them into loops");
  }
  SYMCELL_TRY(check_seed_places(pslg, subdomains.map));
  SYMCELL_TRY(check_seed_conflicts(pslg, subdomains.map));
  if (std::none_of(subdomains.faces.begin(), subdomains.faces.end(),
                   [](const Subdomain& face) { return face.meshed; })) {
    return fail(ErrorCode::kDegenerateGeometry,
                "every face has a hole seed, so nothing is left to mesh; remove a hole seed");
  }
  return {};
}

// A contour that is open by a little is what most often makes two faces one.
Error with_loose_ends(Error error, const Pslg& pslg, const OpenContours& open) {
  if (is_limit(error.code)) return error;
  const LooseEnds* ends = open.outside ? &*open.outside : nullptr;
  if (ends == nullptr && !open.inside.empty()) ends = &open.inside.front();
  if (ends != nullptr) {
    error.message += "; a contour is open at " + describe_loose_ends(pslg, *ends);
  }
  return error;
}

}  // namespace

Result<void> check_entities(const Pslg& pslg) {
  SYMCELL_TRY(check_size(pslg));
  SYMCELL_TRY(check_points(pslg));
  return check_segments(pslg);
}

Result<void> validate_pslg(const Pslg& pslg, ExecutionContext& context) {
  SYMCELL_TRY(check_entities(pslg));
  SYMCELL_TRY(check_extent(pslg));
  SYMCELL_TRY(context.check());
  SYMCELL_TRY(check_duplicates(pslg));
  SYMCELL_TRY(check_not_collinear(pslg));
  const auto subdomains = make_subdomains(pslg, context);
  if (!subdomains) return error_of(subdomains);
  const OpenContours open = find_open_contours(pslg, *subdomains);
  auto enclosed = check_enclosed(pslg, *subdomains);
  if (!enclosed) return fail(with_loose_ends(enclosed.error(), pslg, open));
  if (!open.outside) return {};
  // What is meshed is less than the drawing shows.
  return fail(ErrorCode::kDegenerateGeometry,
              "a contour is open: " + describe_loose_ends(pslg, *open.outside) +
                  ", all but close it, and what it was to enclose would be left out; draw the ends "
                  "onto each other, or remove the contour",
              {open.outside->a, open.outside->b}, pointer_to("vertices", at(open.outside->a)));
}

}  // namespace symcell::plane
