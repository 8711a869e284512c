#include "core/guard/cell_facets.hpp"

#include <algorithm>
#include <bit>
#include <tuple>
#include <utility>

#include "core/base/index.hpp"
#include "core/base/mix.hpp"
#include "core/base/union_find.hpp"

namespace symcell::internal {
namespace {

// Facet i lies opposite corner i; its nodes run counter-clockwise seen from outside.
constexpr std::int32_t kFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
constexpr std::int32_t kSides[3][2] = {{1, 2}, {2, 0}, {0, 1}};

// Of a table with open places for so many different things: at most two thirds are taken.
std::size_t table_size(std::size_t things) {
  return std::bit_ceil(things + things / 2 + 2);
}

class LinkChecker {
 public:
  LinkChecker(const SymmetryCellMesh& cell,
              const std::vector<char>& marked,
              const std::vector<std::int32_t>& at_surface,
              const std::vector<InnerFacet>& inner,
              const std::vector<char>& pinched)
      : cell_(cell),
        marked_(marked),
        at_surface_(at_surface),
        inner_(inner),
        pinched_(pinched),
        dimension_(cell.dimension),
        corners_(static_cast<std::size_t>(cell.dimension) + 1) {}

  // All elements at a marked node, or at an edge between two, are one class.
  Result<void> check_links() {
    join_places();
    std::vector<std::uint32_t> class_of(cell_.nodes.size(), 0);
    std::vector<std::uint64_t> edges;  // each as often as it has classes
    for (const std::int32_t e : at_surface_) {
      const std::size_t first = place_[at(e)] * kPlaces;
      const std::int32_t* v = element(at(e));
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
            edges.push_back(edge_name(std::min(v[i], v[j]), std::max(v[i], v[j])));
          }
        }
      }
    }
    return check_edges(edges);
  }

 private:
  // Places of an element at which others may join it: its corners, in space then its edges.
  static constexpr std::size_t kPlaces = 10;
  static constexpr std::size_t kEdgePlace[4][4] = {
      {0, 4, 5, 6}, {4, 0, 7, 8}, {5, 7, 0, 9}, {6, 8, 9, 0}};

  // Of nodes low < high, which is not 0.
  static std::uint64_t edge_name(std::int32_t low, std::int32_t high) {
    return static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint32_t>(high);
  }

  // What is named twice has two classes of elements.
  [[nodiscard]] Result<void> check_edges(const std::vector<std::uint64_t>& edges) const {
    std::vector<std::uint64_t> met(table_size(edges.size()), 0);
    const std::size_t last = met.size() - 1;
    for (const std::uint64_t edge : edges) {
      std::size_t i = mix(edge) & last;
      while (met[i] != 0 && met[i] != edge) i = (i + 1) & last;
      if (met[i] == 0) {
        met[i] = edge;
        continue;
      }
      const auto low = static_cast<std::int32_t>(edge >> 32);
      const auto high = static_cast<std::int32_t>(edge & 0xffffffffU);
      if (pinched_[at(cell_.nodes[at(low)].orbit)] != 0 &&
          pinched_[at(cell_.nodes[at(high)].orbit)] != 0) {
        continue;
      }
      return broken("elements at the edge " + name_of({low, high, -1}) + " touch there only");
    }
    return {};
  }

  [[nodiscard]] const std::int32_t* element(std::size_t e) const {
    return &cell_.elements[e * corners_];
  }
  [[nodiscard]] bool is_marked(std::int32_t n) const { return marked_[at(n)] != 0; }

  [[nodiscard]] std::size_t root(std::size_t place) {
    return at(joined_.root(static_cast<std::int32_t>(place)));
  }
  void join(std::size_t a, std::size_t b) {
    joined_.join(static_cast<std::int32_t>(a), static_cast<std::int32_t>(b));
  }

  [[nodiscard]] std::size_t local(std::int32_t e, std::int32_t node) const {
    const std::int32_t* v = element(at(e));
    return static_cast<std::size_t>(std::find(v, v + corners_, node) - v);
  }

  // Elements with a marked node, numbered; their places at marked nodes and at edges between two,
  // joined over facets.
  void join_places() {
    place_.assign(cell_.element_count(), 0);
    std::uint32_t count = 0;
    for (const std::int32_t e : at_surface_) place_[at(e)] = ++count;
    joined_ = UnionFind((count + std::size_t{1}) * kPlaces);
    const auto d = static_cast<std::size_t>(dimension_);
    for (const InnerFacet& f : inner_) {
      const auto [p, q] = f.elements;
      const std::size_t first = place_[at(p)] * kPlaces, second = place_[at(q)] * kPlaces;
      std::array<std::size_t, 3> in_p{}, in_q{};
      std::size_t n = 0;
      for (std::size_t j = 0; j < d; ++j) {
        if (!is_marked(f.nodes[j])) continue;
        in_p[n] = local(p, f.nodes[j]);
        in_q[n] = local(q, f.nodes[j]);
        join(first + in_p[n], second + in_q[n]);
        for (std::size_t k = 0; k < n && dimension_ == 3; ++k) {
          join(first + kEdgePlace[in_p[n]][in_p[k]], second + kEdgePlace[in_q[n]][in_q[k]]);
        }
        ++n;
      }
    }
  }

  const SymmetryCellMesh& cell_;
  const std::vector<char>& marked_;
  const std::vector<std::int32_t>& at_surface_;
  const std::vector<InnerFacet>& inner_;
  const std::vector<char>& pinched_;
  std::int32_t dimension_;
  std::size_t corners_;
  std::vector<std::uint32_t> place_;  // per element: its number, 0: without a marked node
  UnionFind joined_{0};               // of places
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

namespace {

// Sums of these are told apart: no two sets of nodes are expected to have the same.
std::uint64_t key_of(std::int32_t node) {
  return mix(static_cast<std::uint32_t>(node) + std::uint64_t{0x9e3779b97f4a7c15ULL});
}

// The number if `odd` is 0, the negative if it is 1.
std::uint64_t with_sign(std::uint64_t number, std::uint64_t odd) {
  return (number ^ (~odd + 1)) + odd;
}

std::uint64_t exceeds(std::int32_t a, std::int32_t b) {
  return a > b ? 1 : 0;
}

}  // namespace

std::uint64_t number_of(const Nodes& n) {
  return mix(key_of(n[0]) + key_of(n[1]) + (n[2] < 0 ? 0 : key_of(n[2])));
}

// Facets as in kSides and kFaces. A permutation is odd if its pairs in falling order are; they are
// counted without branches, for which way is as good as random.
std::uint64_t signed_sides_2(const std::int32_t* v) {
  const std::array<std::uint64_t, 3> key{key_of(v[0]), key_of(v[1]), key_of(v[2])};
  return with_sign(mix(key[1] + key[2]), exceeds(v[1], v[2])) +
         with_sign(mix(key[2] + key[0]), exceeds(v[2], v[0])) +
         with_sign(mix(key[0] + key[1]), exceeds(v[0], v[1]));
}

std::uint64_t signed_faces_3(const std::int32_t* v) {
  const std::array<std::uint64_t, 4> key{key_of(v[0]), key_of(v[1]), key_of(v[2]), key_of(v[3])};
  const std::uint64_t all = key[0] + key[1] + key[2] + key[3];
  const std::uint64_t o01 = exceeds(v[0], v[1]), o02 = exceeds(v[0], v[2]),
                      o03 = exceeds(v[0], v[3]), o12 = exceeds(v[1], v[2]),
                      o13 = exceeds(v[1], v[3]), o23 = exceeds(v[2], v[3]);
  return with_sign(mix(all - key[0]), o12 ^ o13 ^ o23) +
         with_sign(mix(all - key[1]), o02 ^ o03 ^ o23 ^ 1) +
         with_sign(mix(all - key[2]), o01 ^ o03 ^ o13) +
         with_sign(mix(all - key[3]), o01 ^ o02 ^ o12 ^ 1);
}

std::string name_of(const Nodes& n) {
  std::string name = "of nodes " + std::to_string(n[0]) + "-" + std::to_string(n[1]);
  return n[2] < 0 ? name : name + "-" + std::to_string(n[2]);
}

Failure broken(const std::string& what) {
  return fail(ErrorCode::kInternal, "mesh check 'cell': " + what);
}

namespace {

Nodes nodes_of_facet(const SymmetryCellMesh& cell, std::size_t e, std::size_t i) {
  if (cell.dimension == 2) {
    const std::int32_t* v = &cell.elements[3 * e];
    return {v[kSides[i][0]], v[kSides[i][1]], -1};
  }
  const std::int32_t* v = &cell.elements[4 * e];
  return {v[kFaces[i][0]], v[kFaces[i][1]], v[kFaces[i][2]]};
}

}  // namespace

ElementFacet element_facet(const SymmetryCellMesh& cell, std::size_t e, std::size_t i) {
  ElementFacet facet;
  facet.element = static_cast<std::int32_t>(e);
  facet.nodes = nodes_of_facet(cell, e, i);
  facet.even = sort_nodes(facet.nodes, cell.dimension);
  facet.number = number_of(facet.nodes);
  return facet;
}

FacetTable::FacetTable(const SymmetryCellMesh& cell, std::size_t most)
    : cell_(cell),
      corners_(static_cast<std::uint32_t>(cell.dimension) + 1),
      left_(most),
      places_(table_size(most)) {
}

bool FacetTable::holds(const Place& place, std::uint64_t number, const Nodes& nodes) const {
  if (place.number != number) return false;
  Nodes own = nodes_of_facet(cell_, place.facet / corners_, place.facet % corners_);
  sort_nodes(own, cell_.dimension);
  return own == nodes;
}

std::size_t FacetTable::place_of(std::uint64_t number, const Nodes& nodes) const {
  const std::size_t last = places_.size() - 1;
  std::size_t i = number & last;
  while (places_[i].count != 0 && !holds(places_[i], number, nodes)) i = (i + 1) & last;
  return i;
}

Result<std::int32_t> FacetTable::add(const ElementFacet& facet, std::size_t i) {
  Place& place = places_[place_of(facet.number, facet.nodes)];
  if (place.count == 0) {
    if (left_ == 0) return broken("more facets have one element than are on its surface");
    --left_;
    place = {facet.number,
             static_cast<std::uint32_t>(facet.element) * corners_ + static_cast<std::uint32_t>(i),
             1, facet.even};
    return -1;
  }
  if (++place.count > 2 || place.even == facet.even) {
    return broken("the facet " + name_of(facet.nodes) + " has " + std::to_string(place.count) +
                  " elements");
  }
  return static_cast<std::int32_t>(place.facet / corners_);
}

bool FacetTable::is_inner(const Nodes& sorted) const {
  return places_[place_of(number_of(sorted), sorted)].count == 2;
}

std::vector<ElementFacet> FacetTable::outer() const {
  std::vector<ElementFacet> found;
  for (const Place& place : places_) {
    if (place.count != 1) continue;
    found.push_back(element_facet(cell_, place.facet / corners_, place.facet % corners_));
  }
  std::sort(found.begin(), found.end(), [](const ElementFacet& a, const ElementFacet& b) {
    return std::tie(a.number, a.nodes) < std::tie(b.number, b.nodes);
  });
  return found;
}

Result<void> check_cell_links(const SymmetryCellMesh& cell,
                              const std::vector<char>& marked,
                              const std::vector<std::int32_t>& at_surface,
                              const std::vector<InnerFacet>& inner,
                              const std::vector<char>& pinched) {
  return LinkChecker(cell, marked, at_surface, inner, pinched).check_links();
}

}  // namespace symcell::internal
