// Constrained tetrahedralization of a complex of triangles by TetGen 1.5, in a process of its own:
// it aborts, crashes, loops or exits on valid input.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/base/child_process.hpp"
#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/geometry/point.hpp"

namespace symcell::solid {

struct TriangleComplex {
  std::vector<Point3> points;
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<std::array<std::int32_t, 2>> edges;  // that are not sides of triangles
};

struct Tetrahedralization {
  // The given ones first, bit by bit, then those added inside.
  std::vector<Point3> points;
  // Of the whole convex hull, in no set orientation.
  std::vector<std::array<std::int32_t, 4>> tets;
};

struct TetgenOptions {
  std::string switches = "pYYMcQb0";
  // Shuffles points and triangles before they are handed over; 0: as given. What crashes in one
  // order of insertion as a rule succeeds in another.
  std::uint64_t order = 0;
  // Runs in the child before TetGen; for tests of crashes and loops.
  std::function<void()> before;
};

// Of a complex of `size` points and triangles in all.
[[nodiscard]] ChildLimits tetgen_limits(std::size_t size);

// Switches of TetgenOptions: p of a complex, YY with its faces kept, M coplanar ones not merged, c
// the convex hull kept, b0 no Hilbert sort, Q quiet. Does not look whether triangles and edges are
// faces and edges of the result. Errors: kTetrahedralizationFailed (crash, time or memory limit,
// refusal, given points changed), kInternal, limits of the context.  Same input and options: same
// result.
[[nodiscard]] Result<Tetrahedralization> run_tetgen(const TriangleComplex& complex,
                                                    const TetgenOptions& options,
                                                    ExecutionContext& context);

}  // namespace symcell::solid
