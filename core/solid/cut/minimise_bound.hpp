// The cell with the fewest symmetry faces.
//
// With x the exponents in Z, the number of symmetry faces is the sum of |jump| over all faces of
// the quotient, jump(t -> g) = x_t + o_tg - x_g: an L-natural-convex function of x, even L-convex,
// as adding a constant changes nothing. For such functions an x that no step x + chi_S lowers, S
// any set of tetrahedra, is a global minimum [Murota03 thm. 7.14]. The best S for one step is a
// minimum s-t cut; the steps of all cuts together are the primal-dual method for the dual problem,
// a maximum-cost circulation of at most one unit a face, with x as potentials: the flow found so
// far stays feasible after a step. A flow without excess that is +1 (-1) on the faces with jump +1
// (-1) proves the minimum; it is a set of edge-disjoint loops round the axis, one a symmetry face.
//
// A jump of 2 or more would leave a face on no bound: each unit beyond 1 costs as much as kFarCost
// symmetry faces, which keeps the function convex.
//
// The maximum flow is found by passing units on along labels that are lower bounds of the way left
// [Goldberg-Tarjan88], exact again after every half as many relabels as tetrahedra; the quotient
// itself is the graph. Measured: augmenting paths by levels or by two kept search trees took 5 to
// 20 times as long, as the ways through the cell are long and each carries one unit.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/solid/cut/representatives.hpp"

namespace symcell::solid {

inline constexpr std::int32_t kFarCost = 1000;  // symmetry faces, see above; above any weight

// What a symmetry face costs, per half-face, equal on both sides, 1 to 255; empty: 1 each.
using FaceWeights = std::vector<std::uint8_t>;

// Lowers the number of symmetry faces, or their weight, to the global minimum. All components at
// once: one that does not wind about the axis ends with none.
// Cost: about 3 us a tetrahedron at 10^5 of them, 5 us at 10^6; 25 bytes a tetrahedron.
// Errors: limits.
[[nodiscard]] Result<void> minimise_bound(Representatives& cell,
                                          ExecutionContext& context,
                                          const FaceWeights& weights = {});

}  // namespace symcell::solid
