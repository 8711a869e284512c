// Flips that restore the Delaunay property: 2-3, 3-2, and 4-4 and 2-2 where four points lie in a
// plane. Insertion in the quotient leaves a few faces that are not locally Delaunay where a cavity
// met its own copies or had to shrink.
#pragma once

#include <cstdint>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/solid/delaunay/editor.hpp"

namespace symcell::solid {

// Flips until every free face is locally Delaunay or cannot be flipped. Subfacets are flipped only
// together with what is behind them (2-2, in the facet's plane).
// Returns the number of flips.  Errors: limits.  Source: [Joe91], in the quotient.
[[nodiscard]] Result<std::uint64_t> legalise(Editor& editor, ExecutionContext& context);

// Whether the corner behind free face i lies inside the sphere of t, by more than rounding.
[[nodiscard]] bool is_illegal(const Editor& editor, TetId t, std::uint32_t i);

// Free faces that are not locally Delaunay by more than rounding.
[[nodiscard]] std::uint64_t count_illegal(const Editor& editor);

}  // namespace symcell::solid
