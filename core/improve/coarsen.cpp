#include "core/improve/coarsen.hpp"

#include <algorithm>

#include "core/tds/star.hpp"

namespace symcell {
namespace {

// Rounds stop when one gains less than this share of the points, or after kMaxRounds; large meshes
// get fewer, so that the cost per triangle stays bounded.
constexpr double kLeastGain = 0.001;
constexpr int kMaxRounds = 24;
constexpr std::size_t kVertexVisits = 60'000;
// Moves tried to mend one removal before it is taken back.
constexpr int kMendingMoves = 6;
constexpr std::size_t kMostBadToMend = 8;

}  // namespace

Coarsener::Coarsener(DelaunayEditor& editor,
                     const Criteria& criteria,
                     StarSurgery& surgery,
                     ExecutionContext& context)
    : editor_(editor),
      mesh_(editor.mesh()),
      criteria_(criteria),
      surgery_(surgery),
      context_(context) {}

bool Coarsener::is_steiner(VertexId v) const {
  const VertexKind kind = mesh_.kind(v);
  return (kind == VertexKind::kFree || kind == VertexKind::kSegment) &&
         mesh_.corner_of(v) != kNoHalfEdge;
}

Result<void> Coarsener::run() {
  if (criteria_.goal_angle() <= 0) return {};
  std::size_t points = 0;
  for (std::size_t v = 0; v < mesh_.vertex_slots(); ++v) {
    points += is_steiner(static_cast<VertexId>(v)) ? 1 : 0;
  }
  if (points == 0) return {};
  const int rounds = static_cast<int>(
      std::clamp<std::size_t>(kVertexVisits / points, 1, static_cast<std::size_t>(kMaxRounds)));
  constexpr std::size_t kCheckInterval = 64;
  for (int round = 0; round < rounds; ++round) {
    std::size_t gained = 0;
    for (std::size_t i = 0; i < mesh_.vertex_slots(); ++i) {
      if (i % kCheckInterval == 0) {
        const auto elements = static_cast<std::uint64_t>(mesh_.triangle_count());
        context_.report(Phase::kImprove, 0.7 + 0.2 * (round + 1.0) / rounds, elements, 1);
        if (auto ok = context_.check(elements); !ok) return ok;
      }
      const auto v = static_cast<VertexId>(i);
      if (!is_steiner(v)) continue;
      if (merge_with_neighbour(v)) {
        ++counters_.merged;
        ++gained;
      } else if (remove_and_mend(v)) {
        ++counters_.removed;
        ++gained;
      } else if (round + 1 < rounds && surgery_.relocate(v)) {
        ++counters_.relocations;
      }
    }
    if (static_cast<double>(gained) < kLeastGain * static_cast<double>(points)) break;
  }
  return {};
}

// The neighbours of v, in its frame.
std::size_t Coarsener::link_of(VertexId v, std::vector<Corner>& link) const {
  link.clear();
  StarItem item = star_item(mesh_, mesh_.corner_of(v));
  to_star_begin(mesh_, item);
  const StarItem begin = item;
  for (;;) {
    link.push_back(star_corner(mesh_, item, 1));
    const StarItem last = item;
    if (!rotate_ccw(mesh_, item)) {
      link.push_back(star_corner(mesh_, last, 2));
      return link.size() - 1;
    }
    if (item.t == begin.t && item.i == begin.i) return link.size();
  }
}

bool Coarsener::merge_with_neighbour(VertexId v) {
  const std::size_t degree = link_of(v, link_);
  const std::size_t most = surgery_.most_edges() + 4;
  for (const Corner& w : link_) {
    if (w.v == v || !is_steiner(w.v)) continue;
    const bool v_free = mesh_.kind(v) == VertexKind::kFree;
    const bool w_free = mesh_.kind(w.v) == VertexKind::kFree;
    if (!v_free && !w_free && v > w.v) continue;  // looked at from the other end
    if (v_free && w_free && v > w.v) continue;
    const std::size_t sum = degree + link_of(w.v, other_link_);
    if (sum > most) continue;
    // The one on a segment, if any, goes first; its frame is the one used.
    const bool ok = v_free && !w_free
                        ? surgery_.merge({w.v, 0}, {v, mesh_.subtract(0, w.k)})
                        : surgery_.merge({v, 0}, w);
    if (ok) return true;
  }
  return false;
}

void Coarsener::collect_bad(std::vector<TriangleId>& bad) const {
  bad.clear();
  for (const TriangleId t : editor_.created()) {
    if (!mesh_.alive(t) || std::find(bad.begin(), bad.end(), t) != bad.end()) continue;
    if (criteria_.is_bad(mesh_, t)) bad.push_back(t);
  }
}

bool Coarsener::remove_and_mend(VertexId v) {
  mesh_.begin();
  const bool removed = mesh_.kind(v) == VertexKind::kFree ? surgery_.remove(v)
                                                           : surgery_.unsplit(v);
  if (removed && mend()) {
    mesh_.commit();
    return true;
  }
  mesh_.rollback();
  return false;
}

// Moves corners of bad triangles until none is left. The bad ones after a step are those it left
// and those it made.
bool Coarsener::mend() {
  collect_bad(bad_);
  for (int move = 0; !bad_.empty(); ++move) {
    if (move == kMendingMoves || bad_.size() > kMostBadToMend) return false;
    const Triangle t = mesh_.triangle(bad_.front());
    bool moved = false;
    for (std::uint32_t i = 0; i < 3 && !moved; ++i) {
      moved = is_steiner(t.v[i]) && surgery_.relocate(t.v[i]);
    }
    if (!moved) return false;
    ++counters_.relocations;
    std::vector<TriangleId> left;
    for (const TriangleId b : bad_) {
      if (mesh_.alive(b) && criteria_.is_bad(mesh_, b)) left.push_back(b);
    }
    for (const TriangleId c : editor_.created()) {
      if (mesh_.alive(c) && criteria_.is_bad(mesh_, c) &&
          std::find(left.begin(), left.end(), c) == left.end()) {
        left.push_back(c);
      }
    }
    bad_.swap(left);
  }
  return true;
}

}  // namespace symcell
