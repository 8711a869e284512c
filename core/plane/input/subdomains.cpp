#include "core/plane/input/subdomains.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/base/index.hpp"
#include "core/geometry/resolution.hpp"
#include "core/model/mesh_options.hpp"
#include "core/plane/input/near_vertices.hpp"

namespace symcell::plane {
namespace {

Point2 middle_of(const std::vector<Point2>& vertices) {
  if (vertices.empty()) return {};
  Point2 low = vertices.front();
  Point2 high = low;
  for (const Point2 p : vertices) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  return {low.x + 0.5 * (high.x - low.x), low.y + 0.5 * (high.y - low.y)};
}

// A face so many times its size away from a point has lost as many of its digits there.
constexpr double kFar = 1e3;

// Of each face a point to sum about: the reference, or a vertex of its own where that is far away, as where
// a vertex stands alone a long way off.
std::vector<Point2> origins(const Pslg& pslg, const Subdomains& subdomains) {
  const PlanarMap& map = subdomains.map;
  struct Box {
    Point2 low{kInfinity, kInfinity}, high{-kInfinity, -kInfinity};
  };
  std::vector<Box> boxes(subdomains.faces.size());
  for (std::size_t p = 0; p < map.pieces.size(); ++p) {
    const std::int32_t left = map.face[2 * p], right = map.face[2 * p + 1];
    if (left == right) continue;
    for (const std::int32_t f : {left, right}) {
      Box& box = boxes[at(f)];
      for (const std::int32_t v : {map.pieces[p].a, map.pieces[p].b}) {
        const Point2 q = pslg.vertices[at(v)];
        box.low = {std::min(box.low.x, q.x), std::min(box.low.y, q.y)};
        box.high = {std::max(box.high.x, q.x), std::max(box.high.y, q.y)};
      }
    }
  }
  std::vector<Point2> result;
  for (const Box& box : boxes) {
    const bool far = length(box.low - subdomains.reference) > kFar * length(box.high - box.low);
    result.push_back(far ? box.low : subdomains.reference);
  }
  return result;
}

// Green's theorem over the half-edges, triangle by triangle with the face's origin.
void measure(const Pslg& pslg, Subdomains& subdomains) {
  const PlanarMap& map = subdomains.map;
  const std::vector<Point2> origin = origins(pslg, subdomains);
  for (std::size_t p = 0; p < map.pieces.size(); ++p) {
    const std::int32_t left = map.face[2 * p], right = map.face[2 * p + 1];
    if (left == right) continue;  // what it adds on one side it takes off on the other
    const Point2 a = pslg.vertices[at(map.pieces[p].a)], b = pslg.vertices[at(map.pieces[p].b)];
    for (const auto& [f, sign] : {std::pair{left, 1.0}, {right, -1.0}}) {
      const Point2 u = a - origin[at(f)], v = b - origin[at(f)];
      const double area = sign * 0.5 * cross(u, v);
      Subdomain& face = subdomains.faces[at(f)];
      face.area += area;
      face.moment = face.moment + (area / 3.0) * (u + v);
    }
  }
  for (std::size_t f = 0; f < subdomains.faces.size(); ++f) {
    Subdomain& face = subdomains.faces[f];
    face.moment = face.moment + face.area * (origin[f] - subdomains.reference);
  }
  subdomains.faces[0].area = 0;
  subdomains.faces[0].moment = {};
}

// Vertices that touch a segment but for rounding lie on it: on one side of it the segments that end
// there cross it, on the other they leave a gap. The error, if one stays, is that of the input as
// given.
Result<PlanarMap> make_tolerant_map(const Pslg& pslg,
                                    const std::vector<Point2>& seeds,
                                    ExecutionContext& context) {
  auto exact = make_planar_map(pslg.vertices, pslg.segments, seeds, context);
  if (!exact && exact.error().code != ErrorCode::kSelfIntersection) return exact;
  const auto cut = cut_at_near_vertices(pslg.vertices, pslg.segments, resolution_of(pslg.vertices));
  const std::size_t cuts = cut ? cut->segments.size() - pslg.segments.size() : 0;
  if (!cut || (exact && cuts <= exact->cuts)) return exact;
  auto map = make_planar_map(pslg.vertices, cut->segments, seeds, context);
  if (!map) return exact;
  map->cuts += cuts;
  for (PlanarPiece& piece : map->pieces) piece.segment = cut->source[at(piece.segment)];
  return map;
}

}  // namespace

Result<Subdomains> make_subdomains(const Pslg& pslg, ExecutionContext& context) {
  std::vector<Point2> seeds = pslg.holes;
  for (const PslgRegion& region : pslg.regions) seeds.push_back(region.point);
  auto map = make_tolerant_map(pslg, seeds, context);
  if (!map) return error_of(map);

  Subdomains result;
  result.map = std::move(*map);
  result.reference = middle_of(pslg.vertices);
  result.faces.resize(at(result.map.face_count));
  for (std::size_t f = 1; f < result.faces.size(); ++f) result.faces[f].meshed = true;
  for (std::size_t q = 0; q < seeds.size(); ++q) {
    const std::int32_t face = result.map.query_face[q];
    if (face <= 0) continue;
    Subdomain& subdomain = result.faces[at(face)];
    if (q < pslg.holes.size()) {
      subdomain.hole = true;
      subdomain.meshed = false;
    } else if (subdomain.region < 0) {
      subdomain.region = static_cast<std::int32_t>(q - pslg.holes.size());
    }
  }
  measure(pslg, result);
  return result;
}

}  // namespace symcell::plane
