// Detours: where no operation betters a tetrahedron, one that makes shapes worse may open the way
// for others.
#include <algorithm>
#include <limits>
#include <queue>

#include "core/solid/improve/improver.hpp"

namespace symcell::solid {
namespace {

// A detour must better the worst by this share, since it may make much of the rest worse.
constexpr double kDetourGain = 0.02;
// Operations of one detour, the first not counted.
constexpr int kMostSteps = 40;
// What is larger than its bound by this factor, squared, after the first operation mostly stays so.
constexpr double kHopelessExcess2 = 4;
// Detours tried by one improver: some in any case, and some a tetrahedron.
constexpr std::uint64_t kLeastDetours = 2'000;
constexpr double kDetoursATet = 0.1;
// Of one tetrahedron: a new vertex, which helps most often, edges, faces, vertices into each other.
constexpr std::size_t kOwnWays = 1 + 6 + 4 + 12;
// In meshes below this size, where there is time, the new vertex comes last.
constexpr std::size_t kSmallMesh = 1'000;
// The neighbours' follow its own.
constexpr std::size_t kAllWays = 5 * kOwnWays;

}  // namespace

void Improver::allow_detours(double goal) {
  detour_goal_ = goal;
  detours_left_ = kLeastDetours +
                  static_cast<std::uint64_t>(kDetoursATet * static_cast<double>(mesh_.tet_count()));
}

bool Improver::is_small() const {
  return mesh_.tet_count() < kSmallMesh;
}

bool Improver::inserts(std::size_t way) const {
  return way % kOwnWays == (is_small() ? kOwnWays - 1 : 0);
}

bool Improver::open_detour(TetId t, std::size_t way) {
  if (way >= kOwnWays) {
    const HalfFace behind = mesh_.tet(t).nb[way / kOwnWays - 1];
    if (behind == kNoHalfFace) return false;
    t = tet_of(behind);
    way %= kOwnWays;
  }
  if (inserts(way)) return surgery_.insert_point(t);
  if (is_small()) ++way;
  if (way < 7) return surgery_.remove_edge(t, kEdgeCorners[way - 1][0], kEdgeCorners[way - 1][1]);
  if (way < 11) return surgery_.remove_face(t, static_cast<std::uint32_t>(way - 7));
  const auto pair = static_cast<std::uint32_t>(way - 11);
  const std::uint32_t from = pair / 3, to = (from + 1 + pair % 3) % 4;
  return surgery_.collapse(t, from, to, 0);
}

// Works on the worst of what the detour has touched, as long as that helps; the worst in the end,
// -infinity if it is not worth the work.
double Improver::mend_detour(double goal) {
  std::priority_queue<Entry> queue;
  const auto enqueue = [&](TetId t) {
    const double k = key(t);
    if (k < goal) queue.push({k, t, mesh_.tet(t).version});
  };
  for (const TetId t : touched_) enqueue(t);
  if (!queue.empty() && queue.top().key < -kHopelessExcess2 * kMustBeKept) {
    return -std::numeric_limits<double>::infinity();
  }
  for (int step = 0; !queue.empty() && step < kMostSteps; ++step) {
    const Entry e = queue.top();
    queue.pop();
    if (!mesh_.alive(e.t) || mesh_.tet(e.t).version != e.version) continue;
    if (!improve(e.t, Means::kAll)) break;
    for (const TetId t : surgery_.touched()) {
      touched_.push_back(t);
      enqueue(t);
    }
  }
  std::sort(touched_.begin(), touched_.end());
  touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
  std::erase_if(touched_, [&](TetId t) { return !mesh_.alive(t); });
  double worst = goal;
  for (const TetId t : touched_) worst = std::min(worst, key(t));
  return worst;
}

// Bounds that must be kept are bought at any shape, what the input exempts is not; and nothing at
// the price of a bound on size, which no refinement mends any more.
bool Improver::detour(TetId t) {
  const double before = key(t);
  const double least = must_be_mended(before) ? 0 : std::min(surgery_.shape(t), detour_goal_);
  const double wanted =
      before > 0 ? std::min(before * (1 + kDetourGain), detour_goal_) : before * (1 - kExcessGain);
  const auto size_excess2 = [&](TetId u) {
    return criteria_.size_excess2(surgery_.editor().measures(u), mesh_.tet(u).region);
  };
  const double size_before = std::max(1.0, size_excess2(t));
  const std::uint32_t version = mesh_.tet(t).version;
  // Where the input exempts what is bad there is mostly no way at all.
  const bool sharp = criteria_.exemption(mesh_, mesh_.tet(t)) == Exemption::kSmallInputAngle;
  const bool exempt = before < 0 && !must_be_mended(before);
  const std::size_t ways = sharp || exempt ? kOwnWays : kAllWays;
  for (std::size_t way = 0; way < ways && detours_left_ > 0; ++way) {
    surgery_.begin();
    surgery_.set_lenient(true);
    const bool opened = open_detour(t, way);
    surgery_.set_lenient(false);
    // The place for a new vertex is searched for long before it is known that there is none.
    if (opened || inserts(way)) --detours_left_;
    if (!opened) {
      surgery_.commit();  // of nothing
      continue;
    }
    touched_.assign(surgery_.touched().begin(), surgery_.touched().end());
    trying_ = true;
    const double worst = mend_detour(detour_goal_);
    trying_ = false;
    const bool will_do = std::all_of(touched_.begin(), touched_.end(), [&](TetId u) {
      return surgery_.shape(u) >= least && size_excess2(u) <= size_before;
    });
    const bool changed = !mesh_.alive(t) || mesh_.tet(t).version != version;
    if (changed && worst >= wanted && will_do) {
      surgery_.commit();
      return true;
    }
    surgery_.roll_back();
  }
  return false;
}

}  // namespace symcell::solid
