// How the cell lies in the full mesh: its pieces, and which of its facets are inside.
#include <algorithm>
#include <array>

#include "core/base/index.hpp"
#include "core/verify/symmetry.hpp"

namespace symcell::internal {
namespace {

class CellInFull {
 public:
  CellInFull(const FacetedMesh& cell,
             const CellBounds& bounds,
             const FacetedMesh& full,
             double tolerance)
      : cell_(cell), bounds_(bounds), full_(full), tolerance_(tolerance) {}

  void run(Checks& checks) {
    check_bounds(checks);
    check_connected(checks);
  }

 private:
  // Nodes of the cell in the full mesh's sector 0, where an element may name its corners in
  // another order than the cell does.
  [[nodiscard]] std::vector<std::int32_t> nodes_in_full() const {
    std::vector<std::int32_t> result(cell_.mesh.points.size(), -1);
    const auto k = static_cast<std::size_t>(cell_.mesh.nodes_per_element);
    const auto corners = static_cast<std::size_t>(cell_.mesh.dimension) + 1;
    for (std::size_t e = 0; e < full_.mesh.element_count(); ++e) {
      if (full_.mesh.sectors[e] != 0) continue;
      const std::int32_t* there = &full_.mesh.elements[e * k];
      const std::int32_t* here = &cell_.mesh.elements[at(full_.mesh.cell_elements[e]) * k];
      for (std::size_t i = 0; i < corners; ++i) {
        const auto off = [&](std::int32_t node) {
          return distance(cell_.point(here[i]), full_.point(node));
        };
        const std::int32_t nearest =
            *std::min_element(there, there + corners,
                              [&](std::int32_t p, std::int32_t q) { return off(p) < off(q); });
        if (off(nearest) <= tolerance_) result[at(here[i])] = nearest;
      }
    }
    return result;
  }

  // Facets inside the full mesh but on the cell's boundary are exactly those of its bounds.
  void check_bounds(Checks& checks) const {
    const std::vector<std::int32_t> node = nodes_in_full();
    std::vector<char> bound(cell_.group_count(), 0);
    for (const std::size_t g : bounds_.lower) bound[g] = 1;
    for (const std::size_t g : bounds_.higher) bound[g] = 1;
    Flaws flaws;
    for (std::size_t g = 0; g < cell_.group_count(); ++g) {
      if (cell_.sides(g) != 1) continue;
      std::array<std::int32_t, 3> there{-1, -1, -1};
      for (std::size_t i = 0; i < static_cast<std::size_t>(cell_.mesh.dimension); ++i) {
        there[i] = node[at(cell_.first(g).nodes[i])];
      }
      sort_facet(there, cell_.mesh.dimension);
      const std::size_t found = full_.find(there);
      const bool inside = found < full_.group_count() && full_.sides(found) == 2;
      if (inside == (bound[g] != 0)) continue;
      flaws.note([&] {
        return facet_name(cell_.first(g).nodes) +
               (inside ? " of the cell is inside the full mesh and on no bound"
                       : " is on a bound and not inside the full mesh");
      });
    }
    flaws.report(checks, "cell.bounds_in_full");
  }

  // The cell may fall apart only as far as the full mesh does.
  void check_connected(Checks& checks) const {
    UnionFind of_cell(cell_.mesh.element_count()), of_quotient(cell_.mesh.element_count());
    each_inner_facet(cell_, [&](std::int32_t a, std::int32_t b) { of_cell.join(a, b); });
    const auto& source = full_.mesh.cell_elements;
    each_inner_facet(full_, [&](std::int32_t a, std::int32_t b) {
      of_quotient.join(source[at(a)], source[at(b)]);
    });
    const std::size_t found = of_cell.class_count(), wanted = of_quotient.class_count();
    checks.add(
        "cell.connected", found == wanted,
        std::to_string(found) + " connected pieces, modulo symmetry " + std::to_string(wanted));
  }

  const FacetedMesh& cell_;
  const CellBounds& bounds_;
  const FacetedMesh& full_;
  double tolerance_;
};

}  // namespace

void check_cell_in_full(const FacetedMesh& cell,
                        const CellBounds& bounds,
                        const FacetedMesh& full,
                        double tolerance,
                        Checks& checks) {
  CellInFull(cell, bounds, full, tolerance).run(checks);
}

}  // namespace symcell::internal
