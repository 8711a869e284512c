#include "core/solid/improve/improver.hpp"

#include <algorithm>
#include <cmath>

namespace symcell::solid {
namespace {

constexpr std::uint64_t kCheckEvery = 64;  // steps, which cost far more than a look at the clock
constexpr std::uint64_t kCheckEveryDetours = 4;  // a tetrahedron's detours take some milliseconds
// Bound on the steps of one round, a tetrahedron: two operations cannot undo each other (each
// betters the worst), but a round need not go on for what little is left.
constexpr std::uint64_t kMaxStepsATet = 4;
// Changes at a vertex in one round, after which its tetrahedra are left alone. At the ends of long fans
// hundreds are of use: 300 costs real parts up to 39 % more tetrahedra, 3,000 none, and ends a cycle of
// 94,000 changes round a few vertices.
constexpr std::uint32_t kMostChanges = 3'000;
// Neighbours that merging is tried with, the nearest ones: all of them (14 as a rule) take 20 %
// more time for 0.4 % fewer tetrahedra.
constexpr std::size_t kMergeTargets = 6;
// Merges may break bounds by this much (squared lengths): moves spread what is over among the
// neighbours, and refinement mends the little that is left. Measured on the corpus at volume/40000:
// 1 gives 12 % more tetrahedra, 1.3 some 2 % less for half as much time again.
constexpr double kCoarseningExcess = 1.2;
// Least shapes that merging a vertex of the cut may leave, tried in turn: flat tetrahedra are
// mended by refinement and improvement more easily than a needless vertex.
constexpr double kCutFloors[] = {0.1, 0.02, 0.002};

}  // namespace

Improver::Improver(Surgery& surgery, const Criteria& criteria, ExecutionContext& context)
    : surgery_(surgery), mesh_(surgery.editor().mesh()), criteria_(criteria), context_(context) {
}

double Improver::key(TetId t) const {
  const Tet& tet = mesh_.tet(t);
  const Exemption exempt = criteria_.exemption(mesh_, tet);
  const TetMeasures& m = surgery_.editor().measures(t);
  const double excess = criteria_.excess(m, tet.region, exempt);
  if (excess > 1) return -kMustBeKept * excess;
  const double ratio = exempt != Exemption::kNone ? criteria_.ratio_excess(m) : 0;
  return ratio > 1 ? -ratio : surgery_.shape(t);
}

bool Improver::improve(TetId t, Means means) {
  for (const auto& e : kEdgeCorners) {
    if (surgery_.remove_edge(t, e[0], e[1])) return true;
  }
  for (std::uint32_t i = 0; i < 4; ++i) {
    if (surgery_.remove_face(t, i)) return true;
  }
  if (means == Means::kFlips) return false;
  for (std::uint32_t i = 0; i < 4; ++i) {
    if (smooth(mesh_.tet(t).v[i])) return true;
  }
  const double floor = surgery_.shape(t) * (1 + kGain);
  for (std::uint32_t i = 0; i < 4; ++i) {
    for (std::uint32_t j = 0; j < 4; ++j) {
      if (i != j && surgery_.collapse(t, i, j, floor)) return true;
    }
  }
  return false;
}

// What a vertex can be moved to depends on its star alone, and some twenty tetrahedra ask for it.
bool Improver::smooth(VertexId v) {
  const auto i = static_cast<std::size_t>(v);
  const auto when = [i](const std::vector<std::uint64_t>& of) {
    return i < of.size() ? of[i] : std::uint64_t{0};
  };
  if (!trying_ && when(changed_) < when(settled_)) return false;
  if (surgery_.smooth(v)) return true;
  if (!trying_) {
    settled_.resize(std::max(settled_.size(), mesh_.vertex_slots()), 0);
    settled_[i] = steps_;
  }
  return false;
}

Result<void> Improver::work_on_worst(double goal, Means means) {
  queue_ = {};
  std::fill(changes_.begin(), changes_.end(), 0);
  const auto enqueue = [&](TetId t) {
    const double k = key(t);
    if (k < goal && !is_hopeless(t)) queue_.push({k, t, mesh_.tet(t).version});
  };
  for (TetId t = 0; t < mesh_.tet_slots(); ++t) {
    if (mesh_.alive(t)) enqueue(t);
  }
  const std::uint64_t most = kMaxStepsATet * (mesh_.tet_count() + 100);
  const std::uint64_t check_every = detours_left_ > 0 ? kCheckEveryDetours : kCheckEvery;
  for (std::uint64_t step = 0; !queue_.empty() && step < most; ++step) {
    if (step % check_every == 0) {
      SYMCELL_TRY(context_.check(mesh_.tet_count()));
    }
    const Entry e = queue_.top();
    queue_.pop();
    if (!mesh_.alive(e.t) || mesh_.tet(e.t).version != e.version || is_restless(e.t)) continue;
    ++steps_;
    if (!change(e.t, means)) {
      if (means == Means::kAll) {
        given_up_.resize(std::max(given_up_.size(), mesh_.tet_slots()));
        given_up_[e.t] = {e.version, steps_};
      }
      continue;
    }
    note_changes();
    for (const TetId t : touched_) enqueue(t);
  }
  return {};
}

bool Improver::change(TetId t, Means means) {
  if (improve(t, means)) {
    touched_.assign(surgery_.touched().begin(), surgery_.touched().end());
    return true;
  }
  if (means == Means::kFlips) return false;
  // When too many were taken in vain, what is left is the input's.
  return detours_left_ > 0 && key(t) < detour_goal_ && detour(t);
}

void Improver::note_changes() {
  changed_.resize(std::max(changed_.size(), mesh_.vertex_slots()), 0);
  changes_.resize(changed_.size(), 0);
  for (const TetId t : touched_) {
    for (const VertexId v : mesh_.tet(t).v) {
      const auto i = static_cast<std::size_t>(v);
      if (changed_[i] != steps_) ++changes_[i];
      changed_[i] = steps_;
    }
  }
}

// Changed so often that operations undo each other: one takes off what breaks a bound and leaves poorer
// shapes, another betters these within the bounds' excess of a neighbour.
bool Improver::is_restless(TetId t) const {
  const Tet& tet = mesh_.tet(t);
  return std::any_of(tet.v, tet.v + 4, [&](VertexId v) {
    const auto i = static_cast<std::size_t>(v);
    return i < changes_.size() && changes_[i] > kMostChanges;
  });
}

// Given up, and nothing at its corners has changed since.
bool Improver::is_hopeless(TetId t) const {
  if (t >= given_up_.size()) return false;
  const GivenUp& given_up = given_up_[t];
  const Tet& tet = mesh_.tet(t);
  return given_up.when > 0 && given_up.version == tet.version &&
         std::all_of(tet.v, tet.v + 4, [&](VertexId v) {
           const auto i = static_cast<std::size_t>(v);
           return i >= changed_.size() || changed_[i] < given_up.when;
         });
}

Result<void> Improver::mend(double goal, int passes) {
  given_up_.clear();
  settled_.clear();
  for (int pass = 0; pass < passes; ++pass) {
    const std::uint64_t before = surgery_.edits();
    SYMCELL_TRY(work_on_worst(goal, Means::kAll));
    if (surgery_.edits() == before) break;
  }
  return {};
}

Result<void> Improver::smooth_all() {
  std::uint64_t step = 0;
  for (const VertexId v : vertices_in_order()) {
    if (step++ % kCheckEvery == 0) {
      SYMCELL_TRY(context_.check(mesh_.tet_count()));
    }
    static_cast<void>(surgery_.smooth(v));
  }
  return {};
}

// Those that are not the input's, in the order of the tetrahedra's slots: neighbours follow each
// other, and what one star has brought into the cache serves the next.
std::vector<VertexId> Improver::vertices_in_order() const {
  std::vector<VertexId> order;
  std::vector<std::uint8_t> seen(mesh_.vertex_slots(), 0);
  for (TetId t = 0; t < mesh_.tet_slots(); ++t) {
    if (!mesh_.alive(t)) continue;
    for (const VertexId v : mesh_.tet(t).v) {
      if (seen[static_cast<std::size_t>(v)] != 0) continue;
      seen[static_cast<std::size_t>(v)] = 1;
      if (mesh_.kind(v) != VertexKind::kInput) order.push_back(v);
    }
  }
  return order;
}

bool Improver::merge(VertexId v, double floor, Surgery::Bounds bounds) {
  const auto neighbours = surgery_.neighbours(v);
  targets_.assign(neighbours.begin(), neighbours.end());
  const bool coarsening = bounds == Surgery::Bounds::kKept;
  if (coarsening && targets_.size() > kMergeTargets) targets_.resize(kMergeTargets);
  for (const Surgery::Neighbour& n : targets_) {
    if (surgery_.merge(v, n.corner, floor, bounds)) return true;
  }
  return false;
}

std::size_t Improver::collapse_cut_vertices() {
  std::vector<VertexId> left;
  for (std::size_t i = 0; i < mesh_.vertex_slots(); ++i) {
    const auto v = static_cast<VertexId>(i);
    const VertexKind kind = mesh_.kind(v);
    const bool cut = kind == VertexKind::kSegment || kind == VertexKind::kFacet;
    if (cut && !mesh_.on_axis(v)) left.push_back(v);
  }
  for (const double floor : kCutFloors) {
    std::vector<VertexId> stay;
    for (const VertexId v : left) {
      if (merge(v, floor, Surgery::Bounds::kFree)) continue;
      // Flips round the vertex may open a way.
      star_.clear();
      mesh_.star(v, star_);
      const std::vector<TetCopy> around = star_;
      bool changed = false;
      for (const TetCopy& c : around) {
        for (std::uint32_t e = 0; e < 6 && !changed; ++e) {
          changed = surgery_.remove_edge(c.t, kEdgeCorners[e][0], kEdgeCorners[e][1]);
        }
        if (changed) break;
      }
      if (!changed || !merge(v, floor, Surgery::Bounds::kFree)) stay.push_back(v);
    }
    left = std::move(stay);
    if (left.empty()) break;
  }
  return left.size();
}

Result<void> Improver::coarsen(double floor) {
  std::uint64_t step = 0;
  for (const VertexId v : vertices_in_order()) {
    if (step++ % kCheckEvery == 0) {
      SYMCELL_TRY(context_.check(mesh_.tet_count()));
    }
    if (mesh_.kind(v) == VertexKind::kDeleted) continue;
    static_cast<void>(merge(v, floor, Surgery::Bounds::kKept));
  }
  return {};
}

Result<void> Improver::round(double goal) {
  // Flips alone: merges change most of the rest, and moves before them are wasted.
  SYMCELL_TRY(work_on_worst(goal, Means::kFlips));
  surgery_.allow_excess(kCoarseningExcess);
  SYMCELL_TRY(coarsen(goal));
  surgery_.allow_excess(1);
  SYMCELL_TRY(smooth_all());
  return mend(goal);
}

}  // namespace symcell::solid
