// Improvement and coarsening of a refined solid: the worst tetrahedra first, flips before moves
// before collapses; then vertices that the bounds do not need are merged into neighbours. Bounds
// that are kept stay kept. Source: [KlingnerShewchuk07] (schedule), here with size bounds and in
// the quotient.
#pragma once

#include <cstdint>
#include <queue>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/improve/solid_surgery.hpp"

namespace symcell {

class SolidImprover {
 public:
  SolidImprover(SolidSurgery& surgery, const SolidCriteria& criteria, ExecutionContext& context);

  // Mends, coarsens, smooths and mends again; some tetrahedra may break bounds a little afterwards.
  // `goal`: sine of the dihedral angle below which a tetrahedron is worked on.
  // Errors: kTimeLimit, kCancelled, kElementLimit.
  [[nodiscard]] Result<void> round(double goal);

  // Before refinement: merges the vertices that the cut of the sector made on segments and facets
  // of the input into their neighbours there. Returns how many stay. Source: [paper] sec. 5.1.
  [[nodiscard]] std::size_t collapse_cut_vertices();

  // Merges what can go; `floor`: least sine that collapses may leave.
  [[nodiscard]] Result<void> coarsen(double floor);
  // Works on tetrahedra whose shape is below `goal` or that break a bound until nothing helps.
  [[nodiscard]] Result<void> mend(double goal);
  // From now on mend() inserts vertices where nothing else helps a tetrahedron below `goal`.
  void allow_insertion(double goal) { insertion_goal_ = goal; }
  // Moves every vertex once.
  [[nodiscard]] Result<void> smooth_all();

 private:
  struct Entry {
    double key;
    TetId t;
    std::uint32_t version;
    friend bool operator<(const Entry& a, const Entry& b) {
      return a.key != b.key ? a.key > b.key : a.t > b.t;
    }
  };
  [[nodiscard]] std::vector<VertexId> vertices_in_order() const;
  [[nodiscard]] bool merge(VertexId v, double floor, SolidSurgery::Bounds bounds);
  [[nodiscard]] double key(TetId t) const;
  [[nodiscard]] bool improve(TetId t);

  SolidSurgery& surgery_;
  QuotientTetrahedralization& mesh_;
  const SolidCriteria& criteria_;
  ExecutionContext& context_;
  std::priority_queue<Entry> queue_;
  double insertion_goal_ = -1;
  std::vector<TetCopy> star_;
  std::vector<SolidSurgery::Neighbour> targets_;
};

}  // namespace symcell
