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
#include "core/solid/improve/surgery.hpp"

namespace symcell::solid {

class Improver {
 public:
  Improver(Surgery& surgery, const Criteria& criteria, ExecutionContext& context);

  // Flips, coarsens, smooths and mends; some tetrahedra may break bounds a little afterwards.
  // `goal`: sine of the dihedral angle below which a tetrahedron is worked on.
  // Errors: kTimeLimit, kCancelled, kElementLimit.
  [[nodiscard]] Result<void> round(double goal);

  // Before refinement: merges the vertices that the cut of the sector made on segments and facets
  // of the input into their neighbours there. Returns how many stay. Source: [paper] sec. 5.1.
  [[nodiscard]] std::size_t collapse_cut_vertices();

  // Merges what can go; `floor`: least sine that collapses may leave.
  [[nodiscard]] Result<void> coarsen(double floor);
  // Works on tetrahedra whose shape is below `goal` or that break a bound, each until nothing
  // helps; in further passes on those whose neighbourhood has changed since they were given up.
  [[nodiscard]] Result<void> mend(double goal, int passes = 1);
  // From now on mend() takes detours where nothing else helps a tetrahedron below `goal`: a new
  // vertex or another operation that may make shapes worse, then others, if the worst is better in
  // the end.
  void allow_detours(double goal);
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
  enum class Means { kFlips, kAll };
  struct GivenUp {
    std::uint32_t version = 0;
    std::uint64_t when = 0;  // 0: never
  };
  [[nodiscard]] Result<void> work_on_worst(double goal, Means means);
  [[nodiscard]] bool is_hopeless(TetId t) const;
  [[nodiscard]] bool is_restless(TetId t) const;
  void note_changes();
  [[nodiscard]] std::vector<VertexId> vertices_in_order() const;
  [[nodiscard]] bool merge(VertexId v, double floor, Surgery::Bounds bounds);
  // Low where there is much to mend: broken bounds that must be kept (below -kMustBeKept), then
  // those that the input exempts (below 0), then poor shapes (their sine).
  static constexpr double kMustBeKept = 1e12;
  [[nodiscard]] double key(TetId t) const;
  [[nodiscard]] static bool must_be_mended(double key) { return key <= -kMustBeKept; }
  [[nodiscard]] bool improve(TetId t, Means means);
  [[nodiscard]] bool change(TetId t, Means means);
  [[nodiscard]] bool smooth(VertexId v);
  [[nodiscard]] bool detour(TetId t);
  [[nodiscard]] bool open_detour(TetId t, std::size_t way);
  [[nodiscard]] bool is_small() const;
  [[nodiscard]] bool inserts(std::size_t way) const;
  [[nodiscard]] double mend_detour(double goal);

  Surgery& surgery_;
  QuotientTetrahedralization& mesh_;
  const Criteria& criteria_;
  ExecutionContext& context_;
  std::priority_queue<Entry> queue_;
  // By steps of this improver: when a tetrahedron was given up, when one at a vertex last changed.
  std::uint64_t steps_ = 0;
  std::vector<GivenUp> given_up_;
  std::vector<std::uint64_t> changed_;
  std::vector<std::uint64_t> settled_;  // when a vertex was last tried to be moved, in vain
  bool trying_ = false;                 // what is done may be undone, and is not in changed_
  std::vector<std::uint32_t> changes_;  // per vertex, of tetrahedra at it, in this round
  std::vector<TetId> touched_;          // by the last change
  double detour_goal_ = -1;
  std::uint64_t detours_left_ = 0;
  std::vector<TetCopy> star_;
  std::vector<Surgery::Neighbour> targets_;
};

}  // namespace symcell::solid
