#include "core/solid/cut/repair_cell.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <deque>
#include <tuple>
#include <unordered_set>
#include <utility>
#include <vector>

#include "core/solid/cut/cell_topology.hpp"

namespace symcell::solid {
namespace {

constexpr int kRounds = 16;              // of pieces and vertices in turn
constexpr std::int32_t kLayers = 4;      // by which a ball grows round a star
constexpr std::size_t kMaxBall = 4000;   // tetrahedra
constexpr std::size_t kCheckEvery = 64;  // each has a star searched

struct Move {
  TetId t;
  std::int32_t by;
};
using MoveSet = std::vector<Move>;

// What a set of moves changes.
struct Effect {
  std::int32_t flaws = 0;
  std::int32_t chains = 0;
  std::int64_t faces = 0;
};

class CellRepairer {
 public:
  CellRepairer(Representatives& cell, ExecutionContext& context)
      : cell_(cell), mesh_(cell.mesh()), context_(context), topology_(cell) {}

  Result<bool> repair() {
    for (int round = 0; round < kRounds; ++round) {
      changed_ = false;
      join_pieces();
      const auto left = repair_vertices();
      if (!left) return error_of(left);
      if (!*left && find_loose_pieces(cell_).empty()) return true;
      if (!changed_) return false;
    }
    return false;
  }

  Result<std::uint64_t> avoid_chains() {
    const std::size_t loose = find_loose_pieces(cell_).size();
    std::size_t steps = 0;
    for (const VertexId v : bound_vertices(cell_)) {
      if (++steps % kCheckEvery == 0) {
        SYMCELL_TRY(context_.check());
      }
      if (chain_at(v) == 0) continue;
      const MoveSet best = best_move(
          v, [](const Effect& e) { return e.flaws <= 0 && e.chains < 0 && e.faces <= 0; });
      if (best.empty()) continue;
      apply(best);
      // No look at single vertices shows whether the cell is in pieces now.
      if (find_loose_pieces(cell_).size() > loose) take_back(best);
    }
    std::uint64_t left = 0;
    for (const VertexId v : bound_vertices(cell_)) left += chain_at(v) == 0 ? 0 : 1;
    return left;
  }

 private:
  void apply(const MoveSet& moves) {
    for (const Move& m : moves) cell_.move(m.t, m.by);
  }
  void take_back(const MoveSet& moves) {
    for (const Move& m : moves) cell_.move(m.t, -m.by);
  }

  // Each loose piece goes to the copy that the most of its symmetry faces touch.
  void join_pieces() {
    for (const LoosePiece& piece : find_loose_pieces(cell_)) {
      std::vector<std::pair<std::int32_t, std::int32_t>> votes;  // jump, faces
      for (const TetId t : piece.tets) {
        for (HalfFace h = 4 * t; h < 4 * t + 4; ++h) {
          const std::int32_t jump = cell_.jump(h);
          if (jump == 0 || cell_.is_self_glued(h)) continue;
          const auto it = std::find_if(votes.begin(), votes.end(),
                                       [&](const auto& vote) { return vote.first == jump; });
          if (it == votes.end()) {
            votes.emplace_back(jump, 1);
          } else {
            ++it->second;
          }
        }
      }
      if (votes.empty()) continue;
      const auto best = std::max_element(votes.begin(), votes.end(), [](auto& a, auto& b) {
        return std::pair(a.second, -a.first) < std::pair(b.second, -b.first);
      });
      for (const TetId t : piece.tets) cell_.move(t, -best->first);
      changed_ = true;
    }
  }

  // True if a vertex with flaws is left.
  Result<bool> repair_vertices() {
    std::deque<VertexId> queue;
    std::unordered_set<VertexId> queued;  // looked up only
    for (const VertexId v : bound_vertices(cell_)) {
      if (topology_.flaws_at(v) == 0) continue;
      queue.push_back(v);
      queued.insert(v);
    }
    std::size_t steps = 0;
    bool left = false;
    while (!queue.empty()) {
      if (++steps % kCheckEvery == 0) {
        SYMCELL_TRY(context_.check());
      }
      const VertexId v = queue.front();
      queue.pop_front();
      queued.erase(v);
      if (topology_.flaws_at(v) == 0) continue;
      const MoveSet best = best_move(v, [](const Effect& e) { return e.flaws < 0; });
      if (best.empty()) {
        left = true;
        continue;
      }
      apply(best);
      changed_ = true;
      for (const VertexId w : corners_of(best)) {
        if (topology_.flaws_at(w) != 0 && queued.insert(w).second) queue.push_back(w);
      }
    }
    return left;
  }

  // The best move at v among those that are `good`; empty if there is none. Small groups first:
  // balls are tried only where those do not do.
  template <class Good>
  MoveSet best_move(VertexId v, const Good& good) {
    std::vector<MoveSet> candidates;
    add_groups(v, candidates);
    for (std::int32_t layers = -1; layers < kLayers; ++layers) {
      if (layers >= 0) {
        candidates.clear();
        add_balls(v, layers, candidates);
      }
      MoveSet best;
      Effect best_effect;
      for (MoveSet& moves : candidates) {
        const Effect e = effect(moves);
        const auto rank = [](const Effect& x) { return std::tuple(x.flaws, x.chains, x.faces); };
        if (!good(e) || (!best.empty() && rank(e) >= rank(best_effect))) continue;
        best = std::move(moves);
        best_effect = e;
      }
      if (!best.empty()) return best;
    }
    return {};
  }

  static void add_candidate(std::vector<MoveSet>& candidates, MoveSet moves) {
    if (!moves.empty()) candidates.push_back(std::move(moves));
  }

  // Groups at v that share a node, or an edge from v, moved to their neighbours' copies; single
  // tetrahedra alike.
  void add_groups(VertexId v, std::vector<MoveSet>& candidates) {
    topology_.load_star(v);
    const LabelledStar& star = topology_.star();
    std::vector<std::int32_t> group;
    std::vector<OrbitVertex> others;
    for (const auto& m : star.members) {
      for (std::uint32_t i = 0; i < 4; ++i) {
        if (i != m.apex) others.push_back(m.corners[i]);
      }
    }
    const auto less = [](OrbitVertex a, OrbitVertex b) {
      return std::tie(a.orbit, a.exponent) < std::tie(b.orbit, b.exponent);
    };
    std::sort(others.begin(), others.end(), less);
    others.erase(std::unique(others.begin(), others.end()), others.end());
    add_parts(topology_.groups(nullptr, group), group, candidates);
    for (const OrbitVertex& u : others) {
      const std::int32_t parts = topology_.groups(&u, group);
      if (parts > 1) add_parts(parts, group, candidates);
    }
    group.assign(star.members.size(), -1);
    for (std::size_t i = 0; i < star.members.size(); ++i) {
      group[i] = 0;
      add_parts(1, group, candidates);
      group[i] = -1;
    }
  }

  // Every part is tried at each copy that a face of it touches.
  void add_parts(std::int32_t parts,
                 const std::vector<std::int32_t>& group,
                 std::vector<MoveSet>& candidates) {
    const LabelledStar& star = topology_.star();
    for (std::int32_t p = 0; p < parts; ++p) {
      std::vector<std::int32_t> jumps;
      std::vector<TetId> tets;
      for (std::size_t i = 0; i < group.size(); ++i) {
        if (group[i] != p) continue;
        const TetId t = star.members[i].copy.t;
        tets.push_back(t);
        for (HalfFace h = 4 * t; h < 4 * t + 4; ++h) {
          if (cell_.jump(h) != 0 && !cell_.is_self_glued(h)) jumps.push_back(cell_.jump(h));
        }
      }
      std::sort(jumps.begin(), jumps.end());
      jumps.erase(std::unique(jumps.begin(), jumps.end()), jumps.end());
      std::sort(tets.begin(), tets.end());
      // Two copies of one tetrahedron cannot move alike round one vertex.
      if (std::adjacent_find(tets.begin(), tets.end()) != tets.end()) continue;
      for (const std::int32_t jump : jumps) {
        MoveSet moves;
        for (const TetId t : tets) moves.push_back({t, -jump});
        add_candidate(candidates, std::move(moves));
      }
    }
  }

  // The star of v and `layers` layers of tetrahedra round it, all brought to one label. On the axis
  // only the half of a star on one side of a face can be: no ball there.
  void add_balls(VertexId v, std::int32_t layers, std::vector<MoveSet>& candidates) {
    topology_.load_star(v);
    const LabelledStar& star = topology_.star();
    if (star.on_axis) return;
    struct Item {
      TetId t;
      std::int32_t label;
    };
    std::vector<Item> ball;
    std::unordered_set<TetId> seen;  // looked up only
    std::vector<std::int32_t> labels;
    for (const auto& m : star.members) {
      if (!seen.insert(m.copy.t).second) return;  // meets a copy of itself
      ball.push_back({m.copy.t, m.label});
      labels.push_back(m.label);
    }
    std::size_t begin = 0;
    for (std::int32_t layer = 0; layer < layers; ++layer) {
      const std::size_t end = ball.size();
      for (; begin < end; ++begin) {
        const Item item = ball[begin];
        for (std::uint32_t i = 0; i < 4; ++i) {
          const HalfFace g = mesh_.tet(item.t).nb[i];
          if (g == kNoHalfFace || !seen.insert(tet_of(g)).second) continue;
          ball.push_back({tet_of(g), item.label - cell_.jump(4 * item.t + i)});
        }
      }
      if (ball.size() > kMaxBall) return;
    }
    std::sort(labels.begin(), labels.end());
    labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
    for (const std::int32_t label : labels) {
      MoveSet moves;
      for (const Item& item : ball) {
        if (item.label != label) moves.push_back({item.t, label - item.label});
      }
      add_candidate(candidates, std::move(moves));
    }
  }

  [[nodiscard]] std::vector<VertexId> corners_of(const MoveSet& moves) const {
    std::vector<VertexId> corners;
    for (const Move& m : moves) {
      for (const VertexId v : mesh_.tet(m.t).v) corners.push_back(v);
    }
    std::sort(corners.begin(), corners.end());
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    return corners;
  }

  // 1 if nodes at three exponents stand in the cell.
  std::int32_t chain_at(VertexId v) {
    if (mesh_.on_axis(v)) return 0;
    topology_.load_star(v);
    return spans_chain(topology_.star());
  }
  static std::int32_t spans_chain(const LabelledStar& star) {
    if (star.on_axis || star.members.empty()) return 0;
    std::int32_t low = star.members[0].label, high = low;
    for (const auto& m : star.members) {
      low = std::min(low, m.label);
      high = std::max(high, m.label);
    }
    return high - low >= 2 ? 1 : 0;
  }

  void measure(const MoveSet& moves, const std::vector<VertexId>& corners, Effect& e, int sign) {
    moving_.clear();
    for (const Move& m : moves) moving_.push_back(m.t);
    std::sort(moving_.begin(), moving_.end());
    for (const VertexId v : corners) {
      e.flaws += sign * topology_.flaws_at(v);
      e.chains += sign * spans_chain(topology_.star());
    }
    for (const Move& m : moves) {
      for (std::uint32_t i = 0; i < 4; ++i) {
        const HalfFace h = 4 * m.t + i, g = mesh_.tet(m.t).nb[i];
        if (g == kNoHalfFace || cell_.is_self_glued(h)) continue;
        // Faces between two that move are seen from both.
        const bool twice = std::binary_search(moving_.begin(), moving_.end(), tet_of(g));
        if (!twice || h < g) e.faces += sign * std::abs(cell_.jump(h));
      }
    }
  }

  Effect effect(const MoveSet& moves) {
    Effect e;
    const std::vector<VertexId> corners = corners_of(moves);
    measure(moves, corners, e, -1);
    apply(moves);
    measure(moves, corners, e, 1);
    take_back(moves);
    return e;
  }

  Representatives& cell_;
  const QuotientTetrahedralization& mesh_;
  ExecutionContext& context_;
  CellTopology topology_;
  bool changed_ = false;
  std::vector<TetId> moving_;  // of measure
};

}  // namespace

Result<bool> repair_cell(Representatives& cell, ExecutionContext& context) {
  if (cell.mesh().fold() == 1) return true;
  return CellRepairer(cell, context).repair();
}

Result<std::uint64_t> avoid_chains(Representatives& cell, ExecutionContext& context) {
  if (cell.mesh().fold() == 1) return 0;
  return CellRepairer(cell, context).avoid_chains();
}

}  // namespace symcell::solid
