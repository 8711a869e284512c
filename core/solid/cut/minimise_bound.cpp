#include "core/solid/cut/minimise_bound.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <vector>

namespace symcell::solid {
namespace {

// No neighbour to pass units to; the label of tetrahedra from which no way leads to one that takes
// units.
constexpr TetId kNoTet = std::numeric_limits<TetId>::max();
constexpr std::uint32_t kNever = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint32_t kCheckEvery = 8192;  // a step discharges one tetrahedron

// flow(h) is the slope of the cost of face h at its jump, antisymmetric; excess(t), the sum over
// its faces, is the slope of the total cost in x_t. Tetrahedra with a negative excess have units to
// pass on (they want to rise), those with a positive one take some. One more unit of flow on
// h = (t -> g) raises excess(t) and lowers excess(g).
class BoundMinimiser {
 public:
  BoundMinimiser(Representatives& cell, const FaceWeights& weights, ExecutionContext& context)
      : cell_(cell),
        mesh_(cell.mesh()),
        weights_(weights),
        context_(context),
        flow_(4 * mesh_.tet_slots(), 0),
        excess_(mesh_.tet_slots(), 0),
        label_(mesh_.tet_slots(), kNever),
        next_(mesh_.tet_slots(), 0) {}

  Result<void> run() {
    saturate_bounds();
    for (;;) {
      label_all();
      if (reached_.empty()) return {};  // all excess is gone
      if (active_.empty()) {
        raise_source_side();
      } else
        SYMCELL_TRY(pass_on());
    }
  }

 private:
  [[nodiscard]] std::int32_t weight(HalfFace h) const { return weights_.empty() ? 1 : weights_[h]; }
  // Largest slope of the cost of a face at its jump; the smallest is that of the jump before.
  [[nodiscard]] std::int32_t steepest(HalfFace h) const {
    const std::int32_t jump = cell_.jump(h), w = weight(h);
    if (jump >= 1) return w + kFarCost;
    if (jump == 0) return w;
    return jump == -1 ? -w : -w - kFarCost;
  }
  [[nodiscard]] std::int32_t start_flow(HalfFace h) const {
    const std::int32_t jump = cell_.jump(h), w = weight(h);
    if (std::abs(jump) > 1) return jump > 0 ? w + kFarCost : -w - kFarCost;
    return jump * w;
  }

  [[nodiscard]] HalfFace mate(HalfFace h) const { return mesh_.tet(tet_of(h)).nb[face_of(h)]; }
  [[nodiscard]] std::int32_t room(HalfFace h) const { return steepest(h) - flow_[h]; }
  // The tetrahedron behind a face, none for the hull and for faces between copies of one.
  [[nodiscard]] TetId behind(HalfFace h) const {
    const HalfFace g = mate(h);
    return g == kNoHalfFace || tet_of(g) == tet_of(h) ? kNoTet : tet_of(g);
  }

  void saturate_bounds() {
    for (TetId t = 0; t < mesh_.tet_slots(); ++t) {
      if (!mesh_.alive(t)) continue;
      for (HalfFace h = 4 * t; h < 4 * t + 4; ++h) {
        if (cell_.jump(h) == 0 || cell_.is_self_glued(h)) continue;
        flow_[h] = static_cast<std::int16_t>(start_flow(h));
        excess_[t] += flow_[h];
      }
    }
  }

  // Exact labels: the number of faces to the nearest tetrahedron that takes units, kNever if there
  // is no way. Lists the tetrahedra that have units and a way for them.
  void label_all() {
    std::fill(label_.begin(), label_.end(), kNever);
    std::fill(next_.begin(), next_.end(), std::uint8_t{0});
    active_.clear();
    reached_.clear();
    for (TetId t = 0; t < label_.size(); ++t) {
      if (excess_[t] <= 0) continue;
      label_[t] = 0;
      reached_.push_back(t);
    }
    for (std::size_t at = 0; at < reached_.size(); ++at) {
      const TetId t = reached_[at];
      for (HalfFace h = 4 * t; h < 4 * t + 4; ++h) {
        const TetId from = behind(h);
        if (from == kNoTet || label_[from] != kNever || room(mate(h)) <= 0) continue;
        label_[from] = label_[t] + 1;
        reached_.push_back(from);
        if (excess_[from] < 0) active_.push_back(from);
      }
    }
  }

  // First in, first out, until the labels are worth finding anew.
  Result<void> pass_on() {
    const std::size_t budget = label_.size() / 2 + 100;  // relabels; measured: 1/3 to 1 do well
    std::size_t relabels = 0, steps = 0;
    std::vector<TetId> batch;
    while (!active_.empty()) {
      batch.swap(active_);
      active_.clear();
      for (const TetId t : batch) {
        if (++steps % kCheckEvery == 0) {
          SYMCELL_TRY(context_.check());
        }
        relabels += discharge(t);
        if (relabels > budget) return {};
      }
    }
    return {};
  }

  // Passes all units of t on, or as many as there is a way for; the number of relabels.
  std::size_t discharge(TetId t) {
    std::size_t relabels = 0;
    while (excess_[t] < 0) {
      if (next_[t] == 4) {
        ++relabels;
        if (!relabel(t)) return relabels;
        continue;
      }
      const HalfFace h = 4 * t + next_[t];
      const TetId to = behind(h);
      if (to == kNoTet || label_[to] == kNever || label_[to] + 1 != label_[t] || room(h) <= 0) {
        ++next_[t];
        continue;
      }
      const std::int32_t amount = std::min(-excess_[t], room(h));
      flow_[h] = static_cast<std::int16_t>(flow_[h] + amount);
      const HalfFace g = mate(h);
      flow_[g] = static_cast<std::int16_t>(flow_[g] - amount);
      excess_[t] += amount;
      if (excess_[to] >= 0 && excess_[to] < amount) active_.push_back(to);
      excess_[to] -= amount;
    }
    return relabels;
  }

  bool relabel(TetId t) {
    std::uint32_t least = kNever;
    for (HalfFace h = 4 * t; h < 4 * t + 4; ++h) {
      const TetId to = behind(h);
      if (to != kNoTet && room(h) > 0) least = std::min(least, label_[to]);
    }
    next_[t] = 0;
    label_[t] = least == kNever ? kNever : least + 1;
    return least != kNever;
  }

  // What no way leads from is the source side of a minimum cut: lifting it lowers the cost by all
  // that is left there. The flow on its boundary is at a corner of the cost, so it stays feasible.
  void raise_source_side() {
    for (TetId t = 0; t < label_.size(); ++t) {
      if (mesh_.alive(t) && label_[t] == kNever) cell_.move(t, 1);
    }
  }

  Representatives& cell_;
  const QuotientTetrahedralization& mesh_;
  const FaceWeights& weights_;
  ExecutionContext& context_;
  std::vector<std::int16_t> flow_;    // per half-face
  std::vector<std::int32_t> excess_;  // per tetrahedron
  std::vector<std::uint32_t> label_;  // per tetrahedron: at most the number of faces to go
  std::vector<std::uint8_t> next_;    // per tetrahedron: face to try next
  std::vector<TetId> active_;         // with units to pass on
  std::vector<TetId> reached_;        // by label_all
};

}  // namespace

Result<void> minimise_bound(Representatives& cell,
                            ExecutionContext& context,
                            const FaceWeights& weights) {
  if (cell.mesh().fold() == 1) return {};
  return BoundMinimiser(cell, weights, context).run();
}

}  // namespace symcell::solid
