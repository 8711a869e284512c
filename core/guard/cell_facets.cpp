#include "core/guard/cell_facets.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace symcell::internal {
namespace {

std::size_t at(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

class LinkChecker {
 public:
  LinkChecker(const SymmetryCellMesh& cell,
              const std::vector<char>& marked,
              const std::vector<ElementFacet>& facets,
              const std::vector<std::size_t>& inner,
              const std::vector<char>& pinched)
      : cell_(cell),
        marked_(marked),
        facets_(facets),
        inner_(inner),
        pinched_(pinched),
        dimension_(cell.dimension),
        corners_(static_cast<std::size_t>(cell.dimension) + 1) {}

  // All elements at a marked node, or at an edge between two, are one class.
  Result<void> check_links() {
    join_places();
    std::vector<std::uint32_t> class_of(cell_.nodes.size(), 0);
    std::vector<std::pair<std::int32_t, std::int32_t>> edges;  // each as often as it has classes
    for (std::size_t e = 0; e < place_.size(); ++e) {
      if (place_[e] == 0) continue;
      const std::size_t first = place_[e] * kPlaces;
      const std::int32_t* v = element(e);
      for (std::size_t i = 0; i < corners_; ++i) {
        if (!is_marked(v[i])) continue;
        const auto own = static_cast<std::uint32_t>(root(first + i));
        std::uint32_t& known = class_of[at(v[i])];
        if (known == 0) known = own;
        if (known != own && pinched_[at(cell_.nodes[at(v[i])].orbit)] == 0) {
          return broken("elements at node " + std::to_string(v[i]) + " touch there only");
        }
        for (std::size_t j = 0; j < i && dimension_ == 3; ++j) {
          const std::size_t place = first + kEdgePlace[i][j];
          if (is_marked(v[j]) && root(place) == place) {
            edges.emplace_back(std::min(v[i], v[j]), std::max(v[i], v[j]));
          }
        }
      }
    }
    std::sort(edges.begin(), edges.end());
    for (std::size_t i = 1; i < edges.size(); ++i) {
      const auto [a, b] = edges[i];
      const bool exempt = pinched_[at(cell_.nodes[at(a)].orbit)] != 0 &&
                          pinched_[at(cell_.nodes[at(b)].orbit)] != 0;
      if (edges[i] != edges[i - 1] || exempt) continue;
      return broken("elements at the edge " + name_of({a, b, -1}) + " touch there only");
    }
    return {};
  }

 private:
  // Places of an element at which others may join it: its corners, in space then its edges.
  static constexpr std::size_t kPlaces = 10;
  static constexpr std::size_t kEdgePlace[4][4] = {
      {0, 4, 5, 6}, {4, 0, 7, 8}, {5, 7, 0, 9}, {6, 8, 9, 0}};

  [[nodiscard]] const std::int32_t* element(std::size_t e) const {
    return &cell_.elements[e * corners_];
  }
  [[nodiscard]] bool is_marked(std::int32_t n) const { return marked_[at(n)] != 0; }

  [[nodiscard]] std::size_t local(std::int32_t e, std::int32_t node) const {
    const std::int32_t* v = element(at(e));
    return static_cast<std::size_t>(std::find(v, v + corners_, node) - v);
  }

  [[nodiscard]] std::size_t root(std::size_t i) {
    while (joined_[i] != i) i = joined_[i] = joined_[joined_[i]];
    return i;
  }
  void join(std::size_t i, std::size_t j) {
    i = root(i);
    j = root(j);
    joined_[std::max(i, j)] = static_cast<std::uint32_t>(std::min(i, j));
  }

  // Elements with a marked node, numbered; their places, joined over facets.
  void join_places() {
    place_.assign(cell_.element_count(), 0);
    std::size_t count = 0;
    for (const ElementFacet& f : facets_) {
      std::uint32_t& first = place_[at(f.element)];
      if (first == 0) first = static_cast<std::uint32_t>(++count);
    }
    joined_.resize((count + 1) * kPlaces);
    std::iota(joined_.begin(), joined_.end(), std::uint32_t{0});
    for (const std::size_t i : inner_) {
      const std::int32_t e = facets_[i].element, f = facets_[i + 1].element;
      const std::size_t first = place_[at(e)] * kPlaces, second = place_[at(f)] * kPlaces;
      std::array<std::size_t, 3> in_e{}, in_f{};
      for (std::size_t j = 0; j < static_cast<std::size_t>(dimension_); ++j) {
        in_e[j] = local(e, facets_[i].nodes[j]);
        in_f[j] = local(f, facets_[i].nodes[j]);
        join(first + in_e[j], second + in_f[j]);
        for (std::size_t k = 0; k < j && dimension_ == 3; ++k) {
          join(first + kEdgePlace[in_e[j]][in_e[k]], second + kEdgePlace[in_f[j]][in_f[k]]);
        }
      }
    }
  }

  const SymmetryCellMesh& cell_;
  const std::vector<char>& marked_;
  const std::vector<ElementFacet>& facets_;
  const std::vector<std::size_t>& inner_;
  const std::vector<char>& pinched_;
  std::int32_t dimension_;
  std::size_t corners_;
  std::vector<std::uint32_t> place_;   // per element: its number, 0: without a marked node
  std::vector<std::uint32_t> joined_;  // classes of places
};

}  // namespace

bool sort_nodes(Nodes& n, std::int32_t dimension) {
  bool even = true;
  const auto order = [&](std::size_t i, std::size_t j) {
    if (n[i] <= n[j]) return;
    std::swap(n[i], n[j]);
    even = !even;
  };
  order(0, 1);
  if (dimension == 2) return even;
  order(1, 2);
  order(0, 1);
  return even;
}

std::uint64_t number_of(const Nodes& n) {
  const auto mix = [](std::uint64_t x) {
    x ^= x >> 32;
    x *= 0xd6e8feb86659fd93ULL;
    x ^= x >> 29;
    x *= 0x9e3779b97f4a7c15ULL;
    return x ^ (x >> 32);
  };
  const auto u = [](std::int32_t i) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(i));
  };
  return mix(mix(u(n[0]) << 32 | u(n[1])) + u(n[2]) * 0xbf58476d1ce4e5b9ULL);
}

std::string name_of(const Nodes& n) {
  std::string name = "of nodes " + std::to_string(n[0]) + "-" + std::to_string(n[1]);
  return n[2] < 0 ? name : name + "-" + std::to_string(n[2]);
}

Failure broken(const std::string& what) {
  return fail(ErrorCode::kInternal, "mesh check 'cell': " + what);
}

Result<void> check_cell_links(const SymmetryCellMesh& cell,
                              const std::vector<char>& marked,
                              const std::vector<ElementFacet>& facets,
                              const std::vector<std::size_t>& inner,
                              const std::vector<char>& pinched) {
  return LinkChecker(cell, marked, facets, inner, pinched).check_links();
}

}  // namespace symcell::internal
