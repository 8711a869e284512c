#include "core/solid/choose_fold.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "core/solid/initial/starts.hpp"
#include "core/solid/refine_and_improve.hpp"

namespace symcell::solid {
namespace {

std::vector<std::int32_t> divisors_descending(std::int32_t n) {
  std::vector<std::int32_t> divisors;
  for (std::int32_t d = n; d >= 1; --d) {
    if (n % d == 0) divisors.push_back(d);
  }
  return divisors;
}

// The mesh of one sector, of one that can be had quickly. `effort`: surface triangles worked on.
Result<SectorLoad> sample(const SectorSource& source,
                          const MeshOptions& options,
                          std::uint64_t most,
                          ExecutionContext& context,
                          const Tuning& tuning,
                          std::size_t& effort) {
  StartLimits limits = tuning.starts;
  limits.compared = tuning.folds.compared_cuts;
  limits.compare_budget = tuning.folds.compare_budget;
  limits.sectors = tuning.folds.sectors;
  Starts starts(source, limits);
  auto solid = starts.next(context);
  effort = starts.effort();
  if (!solid) return error_of(solid);
  auto refined = refine_and_improve(std::move(*solid), options, most, context, tuning.rounds);
  if (!refined) return error_of(refined);
  return SectorLoad(refined->solid.mesh);
}

class Choice {
 public:
  Choice(const SectorSource& largest,
         const MeshOptions& options,
         ExecutionContext& context,
         const Tuning& tuning)
      : largest_(largest), options_(options), context_(context), tuning_(tuning) {
    for (const std::int32_t d : divisors_descending(largest.symmetry().fold)) {
      folds_.push_back({{d, std::numeric_limits<double>::infinity(), false}, {}, {}, false});
    }
  }

  // Errors: limits.
  Result<void> run() {
    for (std::optional<std::size_t> next = 0; next; next = choose_next()) {
      SYMCELL_TRY(measure(*next));
      estimate();
    }
    return {};
  }

  [[nodiscard]] ChosenFold take() {
    ChosenFold chosen;
    const std::size_t found = best_meshed();
    for (const Tried& t : folds_) {
      if (std::isfinite(t.shown.elements)) chosen.candidates.push_back(t.shown);
    }
    chosen.source = std::move(folds_[found].source);
    return chosen;
  }

 private:
  struct Tried {
    FoldEstimate shown;
    std::optional<SectorLoad> load;
    std::unique_ptr<SectorSource> source;  // null for the largest
    bool failed = false;

    [[nodiscard]] bool meshed() const { return load.has_value(); }
  };

  // The one that promises the smallest cell, if that is small enough; before any could be meshed,
  // half the fold or less.
  [[nodiscard]] std::optional<std::size_t> choose_next() const {
    const FoldLimits& limits = tuning_.folds;
    if (meshed_ >= limits.most_meshed || made_ >= limits.most_made) return {};
    const bool any = folds_[best_meshed()].meshed();
    if (!any && last_ < limits.narrow) return {};
    double least = any ? limits.hope * folds_[best_meshed()].shown.elements
                       : std::numeric_limits<double>::infinity();
    std::optional<std::size_t> next;
    for (std::size_t i = 0; i < folds_.size(); ++i) {
      const Tried& t = folds_[i];
      if (t.meshed() || t.failed) continue;
      if (!any) {
        if (2 * t.shown.fold <= last_) return i;
        continue;
      }
      if (t.shown.elements >= least) continue;
      least = t.shown.elements;
      next = i;
    }
    return next;
  }

  Result<void> measure(std::size_t i) {
    Tried& t = folds_[i];
    ++meshed_;
    last_ = t.shown.fold;
    const SectorSource* source = &largest_;
    if (i > 0) {
      auto made = largest_.with_fold(t.shown.fold, context_);
      if (!made) return give_up(t, made.error());
      t.source = std::move(*made);
      source = t.source.get();
    }
    std::size_t effort = 0;
    auto load = sample(*source, options_, tuning_.folds.most_refined, context_, tuning_, effort);
    made_ += effort;
    if (!load) {
      made_ += tuning_.folds.most_refined;
      return give_up(t, load.error());
    }
    t.load = std::move(*load);
    t.shown.elements = t.load->count();
    t.shown.meshed = true;
    made_ += static_cast<std::uint64_t>(t.load->count());
    return {};
  }

  Result<void> give_up(Tried& t, const Error& error) {
    SYMCELL_TRY(context_.check());
    if (error.code == ErrorCode::kCancelled || error.code == ErrorCode::kTimeLimit ||
        error.code == ErrorCode::kMemoryLimit) {
      return fail(error);
    }
    t.failed = true;
    t.source.reset();
    t.shown.elements = std::numeric_limits<double>::infinity();
    return {};
  }

  // By the mesh whose fold is the nearest.
  void estimate() {
    for (Tried& t : folds_) {
      if (t.meshed() || t.failed) continue;
      double nearest = std::numeric_limits<double>::infinity();
      for (const Tried& other : folds_) {
        if (!other.meshed()) continue;
        const double apart = std::abs(
            std::log(static_cast<double>(other.shown.fold) / static_cast<double>(t.shown.fold)));
        if (apart >= nearest) continue;
        nearest = apart;
        t.shown.elements = other.load->estimate(t.shown.fold);
      }
    }
  }

  // A smaller fold than the largest must be worth it.
  [[nodiscard]] std::size_t best_meshed() const {
    std::size_t found = 0;
    for (std::size_t i = 1; i < folds_.size(); ++i) {
      if (!folds_[i].meshed()) continue;
      const double gain = found == 0 ? tuning_.folds.worthwhile : 1;
      if (folds_[i].shown.elements < gain * folds_[found].shown.elements) found = i;
    }
    return found;
  }

  const SectorSource& largest_;
  const MeshOptions& options_;
  ExecutionContext& context_;
  const Tuning& tuning_;
  std::vector<Tried> folds_;  // by descending fold
  int meshed_ = 0;
  std::int32_t last_ = 0;   // fold that was meshed last
  std::uint64_t made_ = 0;  // tetrahedra, and triangles worked on
};

}  // namespace

SectorLoad::SectorLoad(const QuotientTetrahedralization& mesh) : fold_(mesh.fold()) {
  sizes_.reserve(mesh.tet_count());
  for (TetId t = 0; t < mesh.tet_slots(); ++t) {
    if (!mesh.alive(t)) continue;
    Size size;
    Point3 centre;
    double edges = 0;
    for (std::uint32_t i = 0; i < 4; ++i) centre = centre + 0.25 * mesh.corner_point(t, i);
    for (const auto& e : kEdgeCorners) {
      edges += distance(mesh.corner_point(t, e[0]), mesh.corner_point(t, e[1])) / 6;
      size.limited = size.limited || mesh.corner(t, e[0]).orbit == mesh.corner(t, e[1]).orbit;
    }
    const double radius = std::hypot(centre.x, centre.y);
    size.share = radius > 0 ? edges / (2 * std::numbers::pi * radius)
                            : std::numeric_limits<double>::infinity();
    sizes_.push_back(size);
  }
}

double SectorLoad::estimate(std::int32_t fold) const {
  const double ratio = static_cast<double>(fold) / static_cast<double>(fold_);
  double sum = 0;
  for (const Size& size : sizes_) {
    // Cubes of lengths; a free one has room as long as it is no larger than the sector is wide.
    const double narrow = size.limited ? ratio : std::max(1.0, size.share * fold);
    // Next to the axis everything is as narrow as it gets, at any fold.
    sum += std::isfinite(narrow)
               ? std::min(narrow * narrow * narrow, std::max(1.0, ratio * ratio * ratio))
               : ratio;
  }
  return sum / ratio;
}

Result<ChosenFold> choose_fold(const SectorSource& largest,
                               const MeshOptions& options,
                               ExecutionContext& context,
                               const Tuning& tuning) {
  if (options.fold || options.largest_fold || largest.symmetry().fold < tuning.folds.least) {
    return ChosenFold{};
  }
  Choice choice(largest, options, context, tuning);
  SYMCELL_TRY(choice.run());
  return choice.take();
}

}  // namespace symcell::solid
