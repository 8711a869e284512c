#include <algorithm>
#include <numeric>
#include <tuple>

#include "core/cells/verify_support.hpp"

namespace symcell::internal {
namespace {

// Classes of the slots that elements have at nodes or edges, joined across common faces.
class Classes {
 public:
  explicit Classes(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::int32_t{0});
  }
  [[nodiscard]] std::int32_t root(std::int32_t i) {
    auto at = static_cast<std::size_t>(i);
    while (parent_[at] != static_cast<std::int32_t>(at)) {
      parent_[at] = parent_[static_cast<std::size_t>(parent_[at])];
      at = static_cast<std::size_t>(parent_[at]);
    }
    return static_cast<std::int32_t>(at);
  }
  void join(std::int32_t i, std::int32_t j) {
    const std::int32_t a = root(i), b = root(j);
    parent_[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
  }

 private:
  std::vector<std::int32_t> parent_;
};

class PinchFinder {
 public:
  explicit PinchFinder(const FacetedMesh& mesh) : mesh_(mesh) {}

  Pinches run() {
    find_nodes();
    find_edges();
    return std::move(result_);
  }

 private:
  [[nodiscard]] const std::int32_t* corners(std::int32_t element) const {
    return &mesh_.mesh.elements[static_cast<std::size_t>(element) *
                                static_cast<std::size_t>(mesh_.mesh.nodes_per_element)];
  }
  [[nodiscard]] std::size_t local(std::int32_t element, std::int32_t node) const {
    const std::int32_t* at = corners(element);
    return static_cast<std::size_t>(std::find(at, at + 4, node) - at);
  }
  static std::int32_t slot(std::int32_t element, std::size_t places, std::size_t place) {
    return element * static_cast<std::int32_t>(places) + static_cast<std::int32_t>(place);
  }

  // f(first element, second element, nodes of their common face)
  template <class F>
  void each_inner_face(F f) const {
    for (std::size_t g = 0; g < mesh_.group_count(); ++g) {
      if (mesh_.sides(g) != 2) continue;
      f(mesh_.first(g).element, mesh_.second(g).element, mesh_.first(g).nodes);
    }
  }

  void find_nodes() {
    const auto elements = static_cast<std::int32_t>(mesh_.mesh.element_count());
    Classes classes(4 * mesh_.mesh.element_count());
    each_inner_face([&](std::int32_t a, std::int32_t b, const std::array<std::int32_t, 3>& face) {
      for (const std::int32_t node : face) {
        classes.join(slot(a, 4, local(a, node)), slot(b, 4, local(b, node)));
      }
    });
    std::vector<std::int32_t> seen(mesh_.mesh.points.size(), -1);
    for (std::int32_t e = 0; e < elements; ++e) {
      for (std::size_t i = 0; i < 4; ++i) {
        const std::int32_t root = classes.root(slot(e, 4, i));
        std::int32_t& first = seen[static_cast<std::size_t>(corners(e)[i])];
        if (first < 0) first = root;
        if (first != root) result_.nodes.push_back(corners(e)[i]);
      }
    }
    std::ranges::sort(result_.nodes);
    result_.nodes.erase(std::unique(result_.nodes.begin(), result_.nodes.end()),
                        result_.nodes.end());
  }

  static std::size_t edge_of(std::size_t a, std::size_t b) {
    const auto edges = edge_corners(3);
    for (std::size_t i = 0; i < edges.size(); ++i) {
      if ((edges[i][0] == a && edges[i][1] == b) || (edges[i][0] == b && edges[i][1] == a)) {
        return i;
      }
    }
    return 0;
  }

  void find_edges() {
    const auto elements = static_cast<std::int32_t>(mesh_.mesh.element_count());
    Classes classes(6 * mesh_.mesh.element_count());
    each_inner_face([&](std::int32_t a, std::int32_t b, const std::array<std::int32_t, 3>& face) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::int32_t u = face[i], v = face[(i + 1) % 3];
        classes.join(slot(a, 6, edge_of(local(a, u), local(a, v))),
                     slot(b, 6, edge_of(local(b, u), local(b, v))));
      }
    });
    std::vector<std::tuple<std::int32_t, std::int32_t, std::int32_t>> fans;  // edge and class
    for (std::int32_t e = 0; e < elements; ++e) {
      const auto edges = edge_corners(3);
      for (std::size_t i = 0; i < edges.size(); ++i) {
        const std::int32_t at = slot(e, 6, i);
        if (classes.root(at) != at) continue;  // one entry a class
        const auto [low, high] = std::minmax(corners(e)[edges[i][0]], corners(e)[edges[i][1]]);
        fans.emplace_back(low, high, at);
      }
    }
    std::ranges::sort(fans);
    for (std::size_t i = 1; i < fans.size(); ++i) {
      const auto [low, high, fan] = fans[i];
      if (std::tie(low, high) != std::tie(std::get<0>(fans[i - 1]), std::get<1>(fans[i - 1]))) {
        continue;
      }
      const std::array<std::int32_t, 2> edge{low, high};
      if (result_.edges.empty() || result_.edges.back() != edge) result_.edges.push_back(edge);
    }
  }

  const FacetedMesh& mesh_;
  Pinches result_;
};

}  // namespace

Pinches find_pinches(const FacetedMesh& mesh) {
  return PinchFinder(mesh).run();
}

}  // namespace symcell::internal
