// Pinches: nodes and edges whose elements do not hang together by facets there.
#include <algorithm>
#include <limits>
#include <tuple>

#include "core/verify/support.hpp"

namespace symcell::internal {
namespace {

// Places at elements are counted with 32 bits, six an element.
constexpr std::size_t kMostLinked = 300'000'000;

class PinchFinder {
 public:
  explicit PinchFinder(const FacetedMesh& mesh)
      : mesh_(mesh),
        corner_count_(static_cast<std::size_t>(mesh.mesh.dimension) + 1),
        edges_(edge_corners(mesh.mesh.dimension)) {}

  Pinches run() {
    find_nodes();
    if (mesh_.mesh.dimension == 3) find_edges();
    return std::move(result_);
  }

 private:
  [[nodiscard]] const std::int32_t* corners(std::int32_t element) const {
    return &mesh_.mesh.elements[static_cast<std::size_t>(element) *
                                static_cast<std::size_t>(mesh_.mesh.nodes_per_element)];
  }
  [[nodiscard]] std::size_t local(std::int32_t element, std::int32_t node) const {
    const std::int32_t* at = corners(element);
    return static_cast<std::size_t>(std::find(at, at + corner_count_, node) - at);
  }
  static std::int32_t slot(std::int32_t element, std::size_t places, std::size_t place) {
    return element * static_cast<std::int32_t>(places) + static_cast<std::int32_t>(place);
  }

  // f(first element, second element, nodes of their common facet)
  template <class F>
  void each_shared_facet(F f) const {
    for (std::size_t g = 0; g < mesh_.group_count(); ++g) {
      if (mesh_.sides(g) != 2) continue;
      f(mesh_.first(g).element, mesh_.second(g).element, mesh_.first(g).nodes);
    }
  }

  void find_nodes() {
    const auto elements = static_cast<std::int32_t>(mesh_.mesh.element_count());
    UnionFind classes(corner_count_ * mesh_.mesh.element_count());
    each_shared_facet(
        [&](std::int32_t a, std::int32_t b, const std::array<std::int32_t, 3>& facet) {
          for (std::size_t i = 0; i + 1 < corner_count_; ++i) {
            classes.join(slot(a, corner_count_, local(a, facet[i])),
                         slot(b, corner_count_, local(b, facet[i])));
          }
        });
    std::vector<std::int32_t> seen(mesh_.mesh.points.size(), -1);
    for (std::int32_t e = 0; e < elements; ++e) {
      for (std::size_t i = 0; i < corner_count_; ++i) {
        const std::int32_t root = classes.root(slot(e, corner_count_, i));
        std::int32_t& first = seen[static_cast<std::size_t>(corners(e)[i])];
        if (first < 0) first = root;
        if (first != root) result_.nodes.push_back(corners(e)[i]);
      }
    }
    std::ranges::sort(result_.nodes);
    result_.nodes.erase(std::unique(result_.nodes.begin(), result_.nodes.end()),
                        result_.nodes.end());
  }

  [[nodiscard]] std::size_t edge_of(std::size_t a, std::size_t b) const {
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      if ((edges_[i][0] == a && edges_[i][1] == b) || (edges_[i][0] == b && edges_[i][1] == a)) {
        return i;
      }
    }
    return 0;
  }

  void find_edges() {
    const auto elements = static_cast<std::int32_t>(mesh_.mesh.element_count());
    UnionFind classes(6 * mesh_.mesh.element_count());
    each_shared_facet([&](std::int32_t a, std::int32_t b, const std::array<std::int32_t, 3>& face) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::int32_t u = face[i], v = face[(i + 1) % 3];
        classes.join(slot(a, 6, edge_of(local(a, u), local(a, v))),
                     slot(b, 6, edge_of(local(b, u), local(b, v))));
      }
    });
    std::vector<std::array<std::int32_t, 2>> fans;  // the edge of each class
    for (std::int32_t e = 0; e < elements; ++e) {
      for (std::size_t i = 0; i < edges_.size(); ++i) {
        const std::int32_t at = slot(e, 6, i);
        if (classes.root(at) != at) continue;
        const auto [low, high] = std::minmax(corners(e)[edges_[i][0]], corners(e)[edges_[i][1]]);
        fans.push_back({low, high});
      }
    }
    std::ranges::sort(fans);
    for (std::size_t i = 1; i < fans.size(); ++i) {
      if (fans[i] != fans[i - 1]) continue;
      if (result_.edges.empty() || result_.edges.back() != fans[i]) {
        result_.edges.push_back(fans[i]);
      }
    }
  }

  const FacetedMesh& mesh_;
  std::size_t corner_count_;
  std::span<const std::array<std::size_t, 2>> edges_;
  Pinches result_;
};

[[nodiscard]] double distance_to_segment(const Point3& p, const std::array<Point3, 2>& s) {
  const Point3 d = s[1] - s[0];
  const double whole = squared_length(d);
  const double t = whole > 0 ? std::clamp(dot(p - s[0], d) / whole, 0.0, 1.0) : 0.0;
  return distance(p, s[0] + t * d);
}

std::string counted(std::size_t exempt) {
  return exempt == 0 ? "" : std::to_string(exempt) + " at pinches of the model itself";
}

}  // namespace

Pinches find_pinches(const FacetedMesh& mesh) {
  return PinchFinder(mesh).run();
}

bool ModelPinches::on_edge(const Point3& p) const {
  return std::ranges::any_of(
      edges, [&](const auto& edge) { return distance_to_segment(p, edge) <= tolerance; });
}

std::vector<char> ModelPinches::exempted(const std::vector<Point3>& places) const {
  std::vector<char> result(places.size(), 0);
  for (std::size_t i = 0; i < places.size(); ++i) result[i] = on_edge(places[i]) ? 1 : 0;
  for (const Point3& p : points) {
    const auto nearest = std::ranges::min_element(
        places, {}, [&](const Point3& place) { return squared_distance(place, p); });
    if (nearest == places.end() || distance(*nearest, p) > tolerance) continue;
    result[static_cast<std::size_t>(nearest - places.begin())] = 1;
  }
  return result;
}

void check_links(const FacetedMesh& mesh,
                 const std::string& tag,
                 const ModelPinches& pinches,
                 Checks& checks) {
  if (mesh.mesh.element_count() > kMostLinked) {
    checks.skip(tag + ".vertex_links", "the mesh is too large");
    return;
  }
  const Pinches found = find_pinches(mesh);
  std::vector<Point3> places;
  for (const std::int32_t node : found.nodes) places.push_back(mesh.point(node));
  const std::vector<char> exempts = pinches.exempted(places);
  Flaws nodes;
  for (std::size_t i = 0; i < exempts.size(); ++i) {
    if (exempts[i] != 0) continue;
    nodes.note([&] {
      return "the elements at node " + std::to_string(found.nodes[i]) +
             " do not hang together by facets";
    });
  }
  nodes.report(checks, tag + ".vertex_links", counted(places.size()));
  if (mesh.mesh.dimension == 2) return;
  Flaws edges;
  for (const std::array<std::int32_t, 2>& ends : found.edges) {
    const Point3 p = mesh.point(ends[0]), q = mesh.point(ends[1]);
    const bool exempt = pinches.on_edge(p) && pinches.on_edge(0.5 * (p + q)) && pinches.on_edge(q);
    if (exempt) continue;
    edges.note([&] {
      return "the elements round " + facet_name({ends[0], ends[1], -1}) +
             " do not hang together by faces";
    });
  }
  edges.report(checks, tag + ".edge_links", counted(found.edges.size()));
}

}  // namespace symcell::internal
