#include "core/plane/symmetry/prepared_pslg.hpp"

#include <cmath>
#include <map>
#include <utility>

#include "core/base/index.hpp"

namespace symcell::plane {
namespace {

std::int32_t label_of(const Subdomain& face) {
  if (!face.meshed) return kNotMeshed;
  return face.region < 0 ? kNoRegion : face.region;
}

// Class of each face.
std::vector<std::int32_t> classify(const Pslg& pslg,
                                   const Subdomains& subdomains,
                                   bool ignore_markers) {
  std::map<std::pair<std::int32_t, double>, std::int32_t> classes;
  std::vector<std::int32_t> result;
  result.reserve(subdomains.faces.size());
  for (const Subdomain& face : subdomains.faces) {
    if (!face.meshed) {
      result.push_back(0);
    } else if (face.region < 0 || ignore_markers) {
      result.push_back(1);
    } else {
      const PslgRegion& region = pslg.regions[at(face.region)];
      const auto next = static_cast<std::int32_t>(classes.size()) + 2;
      result.push_back(
          classes.try_emplace({region.attribute, region.max_area}, next).first->second);
    }
  }
  return result;
}

void measure(const Pslg& pslg, const Subdomains& subdomains, PreparedPslg& prepared) {
  Point2 low = pslg.vertices.front();
  Point2 high = low;
  for (const Point2 p : pslg.vertices) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  prepared.box_low = low;
  prepared.box_high = high;
  prepared.diameter = distance(low, high);
  prepared.magnitude =
      std::max({std::abs(low.x), std::abs(low.y), std::abs(high.x), std::abs(high.y)});
  Point2 moment;
  for (const Subdomain& face : subdomains.faces) {
    if (!face.meshed) continue;
    prepared.area += face.area;
    moment = moment + face.moment;
  }
  prepared.centroid = subdomains.reference;
  if (prepared.area > 0) prepared.centroid = prepared.centroid + (1 / prepared.area) * moment;
}

}  // namespace

PreparedPslg prepare_pslg(const Pslg& pslg, const Subdomains& subdomains, bool ignore_markers) {
  const PlanarMap& map = subdomains.map;
  const std::vector<std::int32_t> classes = classify(pslg, subdomains, ignore_markers);
  PreparedPslg result;
  result.ignore_markers = ignore_markers;
  measure(pslg, subdomains, result);

  std::vector<char> used(pslg.vertices.size(), 0);
  for (std::size_t p = 0; p < map.pieces.size(); ++p) {
    const PlanarPiece& piece = map.pieces[p];
    const std::int32_t left = classes[at(map.face[2 * p])];
    const std::int32_t right = classes[at(map.face[2 * p + 1])];
    if (left == 0 && right == 0) continue;
    const std::int32_t marker = pslg.segments[at(piece.segment)].marker;
    result.edges.push_back({piece.a, piece.b, marker, left, right,
                            label_of(subdomains.left_of(static_cast<std::int32_t>(2 * p))),
                            label_of(subdomains.left_of(static_cast<std::int32_t>(2 * p + 1))),
                            piece.segment});
    used[at(piece.a)] = used[at(piece.b)] = 1;
  }
  for (std::size_t v = 0; v < used.size(); ++v) {
    const std::int32_t face = map.vertex_face[v];
    if (face >= 0 && classes[at(face)] != 0) used[v] = 1;
  }
  std::vector<std::int32_t> renumbered(pslg.vertices.size(), -1);
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (used[v] == 0) continue;
    renumbered[v] = static_cast<std::int32_t>(result.points.size());
    result.points.push_back(pslg.vertices[v]);
    result.input_vertex.push_back(static_cast<std::int32_t>(v));
  }
  for (PreparedEdge& edge : result.edges) {
    edge.a = renumbered[at(edge.a)];
    edge.b = renumbered[at(edge.b)];
  }
  return result;
}

}  // namespace symcell::plane
