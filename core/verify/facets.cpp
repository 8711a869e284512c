// The facets and edges of a mesh, and other small things that the checks share.
#include <algorithm>
#include <charconv>
#include <utility>

#include "core/verify/support.hpp"

namespace symcell {

bool VerifyReport::ok() const {
  return !checks.empty() && std::ranges::none_of(checks, [](const Check& c) {
    return c.status == Check::Status::kFail;
  });
}

namespace internal {
namespace {

// Facets of elements by their corners, in the order that runs counter-clockwise seen from outside;
// facet i lies opposite corner i.
constexpr std::array<std::array<std::size_t, 3>, 4> kFaces{
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
constexpr std::array<std::array<std::size_t, 2>, 3> kSides{{{1, 2}, {2, 0}, {0, 1}}};

}  // namespace

bool sort_facet(std::array<std::int32_t, 3>& nodes, std::int32_t dimension) {
  bool even = true;
  const auto exchange = [&](std::size_t i, std::size_t j) {
    if (nodes[i] < nodes[j]) return;
    std::swap(nodes[i], nodes[j]);
    even = !even;
  };
  exchange(0, 1);
  if (dimension == 2) return even;
  exchange(1, 2);
  exchange(0, 1);
  return even;
}

std::vector<HalfFacet> sorted_facets(const MeshData& mesh) {
  const auto k = static_cast<std::size_t>(mesh.nodes_per_element);
  const auto corners = static_cast<std::size_t>(mesh.dimension) + 1;
  std::vector<HalfFacet> facets;
  facets.reserve(mesh.element_count() * corners);
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    const std::int32_t* nodes = &mesh.elements[e * k];
    for (std::size_t i = 0; i < corners; ++i) {
      HalfFacet facet;
      if (mesh.dimension == 2) {
        facet.nodes = {nodes[kSides[i][0]], nodes[kSides[i][1]], -1};
      } else {
        facet.nodes = {nodes[kFaces[i][0]], nodes[kFaces[i][1]], nodes[kFaces[i][2]]};
      }
      facet.even = sort_facet(facet.nodes, mesh.dimension);
      facet.element = static_cast<std::int32_t>(e);
      facet.opposite = static_cast<std::int32_t>(i);
      facets.push_back(facet);
    }
  }
  std::ranges::sort(facets, [](const HalfFacet& a, const HalfFacet& b) {
    return a.nodes != b.nodes ? a.nodes < b.nodes : a.element < b.element;
  });
  return facets;
}

std::vector<std::size_t> facet_groups(const std::vector<HalfFacet>& facets) {
  std::vector<std::size_t> groups;
  for (std::size_t i = 0; i < facets.size(); ++i) {
    if (i == 0 || facets[i].nodes != facets[i - 1].nodes) groups.push_back(i);
  }
  groups.push_back(facets.size());
  return groups;
}

std::size_t FacetedMesh::find(const std::array<std::int32_t, 3>& nodes) const {
  const auto end = groups.end() - 1;
  const auto at = std::lower_bound(
      groups.begin(), end, nodes,
      [this](std::size_t begin, const auto& wanted) { return facets[begin].nodes < wanted; });
  if (at == end || facets[*at].nodes != nodes) return group_count();
  return static_cast<std::size_t>(at - groups.begin());
}

std::string facet_name(const std::array<std::int32_t, 3>& nodes) {
  const std::string two = std::to_string(nodes[0]) + "-" + std::to_string(nodes[1]);
  return nodes[2] < 0 ? "edge " + two : "face " + two + "-" + std::to_string(nodes[2]);
}

std::span<const std::array<std::size_t, 2>> edge_corners(std::int32_t dimension) {
  // In VTK's order of mid-side nodes.
  static constexpr std::array<std::array<std::size_t, 2>, 3> kTriangle{{{0, 1}, {1, 2}, {2, 0}}};
  static constexpr std::array<std::array<std::size_t, 2>, 6> kTetrahedron{
      {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
  if (dimension == 2) return kTriangle;
  return kTetrahedron;
}

std::vector<ElementEdge> element_edges(const MeshData& mesh) {
  const auto k = static_cast<std::size_t>(mesh.nodes_per_element);
  const auto pairs = edge_corners(mesh.dimension);
  const std::size_t corners = static_cast<std::size_t>(mesh.dimension) + 1;
  std::vector<ElementEdge> edges;
  edges.reserve(mesh.element_count() * pairs.size());
  for (std::size_t at = 0; at < mesh.elements.size(); at += k) {
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const std::int32_t a = mesh.elements[at + pairs[i][0]];
      const std::int32_t b = mesh.elements[at + pairs[i][1]];
      edges.push_back(
          {std::min(a, b), std::max(a, b), mesh.order == 2 ? mesh.elements[at + corners + i] : -1});
    }
  }
  std::ranges::sort(edges);
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

std::array<Point3, 4> corners_of(const MeshData& mesh, std::size_t element) {
  const auto k = static_cast<std::size_t>(mesh.nodes_per_element);
  std::array<Point3, 4> p{};
  for (std::size_t i = 0; i <= static_cast<std::size_t>(mesh.dimension); ++i) {
    p[i] = mesh.points[static_cast<std::size_t>(mesh.elements[element * k + i])];
  }
  return p;
}

double total_measure(const MeshData& mesh) {
  double sum = 0;
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    const std::array<Point3, 4> p = corners_of(mesh, e);
    const Point3 normal = cross(p[1] - p[0], p[2] - p[0]);
    sum += mesh.dimension == 2 ? 0.5 * normal.z : dot(normal, p[3] - p[0]) / 6;
  }
  return sum;
}

double diameter(const std::vector<Point3>& points) {
  Point3 low{kFar, kFar, kFar};
  Point3 high{-kFar, -kFar, -kFar};
  for (const Point3& p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  return points.empty() ? 0 : distance(low, high);
}

std::string shown(double value) {
  char text[32];
  const auto end =
      std::to_chars(text, text + sizeof text, value, std::chars_format::general, 4).ptr;
  return {text, end};
}

bool Checks::add(std::string name, bool holds, std::string detail) {
  report_->checks.push_back(
      {std::move(name), holds ? Check::Status::kPass : Check::Status::kFail, std::move(detail)});
  return holds;
}

void Checks::skip(std::string name, std::string why) {
  report_->checks.push_back({std::move(name), Check::Status::kSkip, std::move(why)});
}

bool Flaws::report(Checks& checks, std::string name, std::string fine) const {
  if (none()) return checks.add(std::move(name), true, std::move(fine));
  const std::string more = count_ > 1 ? "; " + std::to_string(count_) + " such flaws" : "";
  return checks.add(std::move(name), false, first_ + more);
}

bool Flaws::report_beyond_bound(Checks& checks, std::string name, std::string fine) const {
  if (none() || count_ > checks.most_exempt()) {
    return report(checks, std::move(name), std::move(fine));
  }
  return checks.add(std::move(name), true, std::to_string(count_) + " elements are exempt");
}

}  // namespace internal
}  // namespace symcell
