#include "core/plane/refine/coarsen.hpp"

#include <algorithm>

#include "core/plane/quotient/star.hpp"

namespace symcell::plane {
namespace {

// Rounds stop when one gains less than this share of the points, or after kMaxRounds; large meshes
// get fewer, so that the cost per triangle stays bounded.
constexpr double kLeastGain = 0.001;
constexpr int kMaxRounds = 24;
constexpr std::size_t kVertexVisits = 16'000;  // of all rounds together
// Moves tried to mend one removal before it is taken back.
constexpr int kMendingMoves = 4;
constexpr std::size_t kMostBadToMend = 3;  // triangles: so few moves mend no more
// Neighbours up to this many times as far (squared) as the nearest are tried for a merge: the
// others hardly ever have room (measured: a tenth of the time for nothing).
constexpr double kNearNeighbour2 = 1.5;
// A star this much too large for the area bound may still lose its vertex: mending moves others.
constexpr double kRoomSlack = 1.2;

}  // namespace

Coarsener::Coarsener(Editor& editor,
                     const Criteria& criteria,
                     StarSurgery& surgery,
                     ExecutionContext& context)
    : editor_(editor),
      mesh_(editor.mesh()),
      criteria_(criteria),
      surgery_(surgery),
      context_(context) {
}

bool Coarsener::is_steiner(VertexId v) const {
  const VertexKind kind = mesh_.kind(v);
  return (kind == VertexKind::kFree || kind == VertexKind::kSegment) &&
         mesh_.corner_of(v) != kNoHalfEdge;
}

// Steiner points in the order of the triangle slots: neighbours one after another, if the slots are
// in spatial order.
std::vector<VertexId> Coarsener::visiting_order() const {
  std::vector<VertexId> order;
  std::vector<std::uint8_t> met(mesh_.vertex_slots(), 0);
  for (TriangleId t = 0; t < mesh_.triangle_slots(); ++t) {
    if (!mesh_.alive(t)) continue;
    for (const VertexId v : mesh_.triangle(t).v) {
      std::uint8_t& seen = met[static_cast<std::size_t>(v)];
      if (seen == 0 && is_steiner(v)) order.push_back(v);
      seen = 1;
    }
  }
  return order;
}

Result<void> Coarsener::run() {
  if (!criteria_.has_bound()) return {};
  const std::vector<VertexId> order = visiting_order();
  const std::size_t points = order.size();
  if (points == 0) return {};
  const int rounds = static_cast<int>(
      std::clamp<std::size_t>(kVertexVisits / points, 1, static_cast<std::size_t>(kMaxRounds)));
  constexpr std::size_t kCheckEvery = 64;  // vertices: each is tried for merge and removal
  for (int round = 0; round < rounds; ++round) {
    std::size_t gained = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
      if (i % kCheckEvery == 0) {
        const auto elements = static_cast<std::uint64_t>(mesh_.triangle_count());
        context_.report(Phase::kImprove, 0.7 + 0.2 * (round + 1.0) / rounds, elements, 1);
        SYMCELL_TRY(context_.check(elements));
      }
      const VertexId v = order[i];
      if (!is_steiner(v)) continue;
      if (merge_with_neighbour(v)) {
        ++counters_.merged;
        ++gained;
      } else if (remove_and_mend(v)) {
        ++counters_.removed;
        ++gained;
      } else if (round + 1 < rounds && keep_if_none_bad([&] { return surgery_.relocate(v); })) {
        ++counters_.relocations;
      }
    }
    if (static_cast<double>(gained) < kLeastGain * static_cast<double>(points)) break;
  }
  return {};
}

// The neighbours of v, in its frame.
void Coarsener::gather_link(VertexId v) {
  link_.clear();
  StarItem item = star_item(mesh_, mesh_.corner_of(v));
  to_star_begin(mesh_, item);
  const StarItem begin = item;
  for (;;) {
    link_.push_back(star_corner(mesh_, item, 1));
    const StarItem last = item;
    if (!rotate_ccw(mesh_, item)) {
      link_.push_back(star_corner(mesh_, last, 2));
      return;
    }
    if (item.t == begin.t && item.i == begin.i) return;
  }
}

// The flips that follow an operation raise the smallest of two triangles' angles. Where that is the
// angle of an exempt triangle, the exemption may go to one of the new triangles and the other one be
// bad, although the star as it was made was good.
template <class Operation>
bool Coarsener::keep_if_none_bad(const Operation& operation) {
  if (!criteria_.exempts_any()) return operation();
  mesh_.begin();
  if (operation() && std::ranges::none_of(editor_.created(), [&](TriangleId t) {
        return mesh_.alive(t) && criteria_.is_bad(mesh_, t);
      })) {
    mesh_.commit();
    return true;
  }
  mesh_.roll_back();
  return false;
}

bool Coarsener::merge_with_neighbour(VertexId v) {
  gather_link(v);
  const Point2 p = mesh_.point(v);
  double nearest2 = kInfinity;
  for (const OrbitVertex& w : link_) {
    if (w.orbit != v)
      nearest2 = std::min(nearest2, squared_distance(p, mesh_.lift(w.orbit, w.exponent)));
  }
  for (const OrbitVertex& w : link_) {
    if (w.orbit == v || !is_steiner(w.orbit)) continue;
    if (squared_distance(p, mesh_.lift(w.orbit, w.exponent)) > kNearNeighbour2 * nearest2) continue;
    const bool v_free = mesh_.kind(v) == VertexKind::kFree;
    const bool w_free = mesh_.kind(w.orbit) == VertexKind::kFree;
    if (!v_free && !w_free && v > w.orbit) continue;  // looked at from the other end
    if (v_free && w_free && v > w.orbit) continue;
    // The one on a segment, if any, goes first; its frame is the one used.
    const auto merge = [&] {
      return v_free && !w_free ? surgery_.merge({w.orbit, 0}, {v, mesh_.subtract(0, w.exponent)})
                               : surgery_.merge({v, 0}, w);
    };
    if (keep_if_none_bad(merge)) return true;
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

// Whether the star of a free vertex, left with two triangles fewer, could keep the area bound.
bool Coarsener::has_room_without(VertexId v) {
  const double bound = criteria_.max_area(mesh_.triangle(triangle_of(mesh_.corner_of(v))).face);
  if (bound == kInfinity) return true;
  gather_link(v);
  const Point2 p = mesh_.point(v);
  double doubled = 0;
  Point2 last = mesh_.lift(link_.back().orbit, link_.back().exponent) - p;
  for (const OrbitVertex& c : link_) {
    const Point2 next = mesh_.lift(c.orbit, c.exponent) - p;
    doubled += cross(last, next);
    last = next;
  }
  return doubled <= kRoomSlack * 2 * bound * (static_cast<double>(link_.size()) - 2);
}

bool Coarsener::remove_and_mend(VertexId v) {
  if (mesh_.kind(v) == VertexKind::kFree && !has_room_without(v)) return false;
  mesh_.begin();
  const bool removed =
      mesh_.kind(v) == VertexKind::kFree ? surgery_.remove(v) : surgery_.unsplit(v);
  if (removed && mend()) {
    mesh_.commit();
    return true;
  }
  mesh_.roll_back();
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

}  // namespace symcell::plane
