// Makes a choice of representatives a usable cell: what cell_topology.hpp finds is repaired by
// moving tetrahedra to another copy (FindMoveTets of [paper] sec. 5.2).
//
// A loose piece moves as a whole to where it joins most faces. At a vertex with flaws groups of its
// star are tried: those that share a node or an edge, single tetrahedra, the whole star, and balls
// that grow round it. Of the moves that leave fewer flaws the one with the fewest flaws, then the
// fewest symmetry faces, is taken. Each lowers the number of flaws, so the repair ends.
#pragma once

#include <cstdint>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/solid/cut/representatives.hpp"

namespace symcell::solid {

// True if the cell has no flaw in the end. Errors: limits.
[[nodiscard]] Result<bool> repair_cell(Representatives& cell, ExecutionContext& context);

// Nodes on both bounds off the axis (a chain p, Rp, R^2 p in one cell) are legal, but solvers for
// cyclic symmetry do not take them. Moves tetrahedra where that removes such a chain at no cost in
// symmetry faces or flaws; the number of chains left. Errors: limits.
[[nodiscard]] Result<std::uint64_t> avoid_chains(Representatives& cell, ExecutionContext& context);

}  // namespace symcell::solid
