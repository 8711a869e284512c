// Fewer triangles at the same bounds: Steiner points are merged or removed while every star can be
// kept good, and neighbours are moved to make room.
//
// Greedy rounds over all Steiner points; each step keeps the mesh constrained Delaunay and all
// bounds, so the result is valid whenever the rounds stop. Steps, cheapest first: merge two
// adjacent points into one; remove a point and mend what became bad by moving points near it, or
// take the removal back from the journal; then move points to the middle of their feasible regions,
// which opens the next round's chances.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/execution_context.hpp"
#include "core/plane/delaunay/insert.hpp"
#include "core/plane/refine/criteria.hpp"
#include "core/plane/refine/star_surgery.hpp"

namespace symcell::plane {

struct CoarsenCounters {
  std::uint64_t merged = 0;
  std::uint64_t removed = 0;
  std::uint64_t relocations = 0;
};

class Coarsener {
 public:
  Coarsener(Editor& editor,
            const Criteria& criteria,
            StarSurgery& surgery,
            ExecutionContext& context);

  // Requires: no bad triangle.  Errors: cancel and time limit.
  [[nodiscard]] Result<void> run();
  [[nodiscard]] const CoarsenCounters& counters() const { return counters_; }

 private:
  [[nodiscard]] bool is_steiner(VertexId v) const;
  template <class Operation>
  [[nodiscard]] bool keep_if_none_bad(const Operation& operation);
  [[nodiscard]] bool merge_with_neighbour(VertexId v);
  [[nodiscard]] bool has_room_without(VertexId v);
  [[nodiscard]] bool remove_and_mend(VertexId v);
  [[nodiscard]] bool mend();
  [[nodiscard]] std::vector<VertexId> visiting_order() const;
  void gather_link(VertexId v);
  void collect_bad(std::vector<TriangleId>& bad) const;

  Editor& editor_;
  QuotientTriangulation& mesh_;
  const Criteria& criteria_;
  StarSurgery& surgery_;
  ExecutionContext& context_;
  CoarsenCounters counters_;
  std::vector<OrbitVertex> link_;
  std::vector<TriangleId> bad_;
};

}  // namespace symcell::plane
