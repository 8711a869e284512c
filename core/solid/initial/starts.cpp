#include "core/solid/initial/starts.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace symcell::solid {
namespace {

// What a wrong seed or a wrong model causes is so for every sector.
bool is_worth_another_sector(ErrorCode code) {
  return code == ErrorCode::kTetrahedralizationFailed || code == ErrorCode::kInternal;
}

}  // namespace

Starts::Starts(const SectorSource& source, const StartLimits& limits)
    : source_(source), limits_(limits), most_(std::min(source.candidates(), limits.sectors)) {
}

// Whether a cut more is worth its time, before any is meshed.
bool Starts::is_worth_comparing() const {
  if (next_ == 0) return true;
  if (next_ == source_.preferred() && !sectors_.empty()) return false;
  const std::size_t one_more = effort_ / static_cast<std::size_t>(next_);
  return next_ < most_ && sectors_.size() < limits_.compared && effort_ > 0 &&
         effort_ + one_more <= limits_.compare_budget;
}

// Whether the last cut made no difference.
bool Starts::cuts_are_alike() const {
  if (sectors_.size() < 2) return false;
  const double ratio = sectors_.back().meshing_cost / sectors_[sectors_.size() - 2].meshing_cost;
  return 1 / limits_.alike < ratio && ratio < limits_.alike;
}

Result<void> Starts::cut_one_more(ExecutionContext& context) {
  auto sector = source_.sector(next_++, context);
  effort_ += sector ? std::max(source_.effort(), sector->triangles_made) : source_.effort();
  if (sector) {
    sectors_.push_back(std::move(*sector));
    return {};
  }
  last_ = sector.error();
  return is_limit(last_.code) ? fail(last_) : Result<void>{};
}

Result<InitialTetrahedralization> Starts::next(ExecutionContext& context) {
  if (next_ == 0) {
    while (is_worth_comparing()) {
      SYMCELL_TRY(cut_one_more(context));
      const bool good = !sectors_.empty() && sectors_.back().narrow_corners == 0;
      if (good && (effort_ >= limits_.enough_compared || cuts_are_alike())) break;
    }
    // Among much the same the earlier is the better one: it was cut where there is more room.
    for (std::size_t i = 0; i < sectors_.size(); ++i) {
      sectors_[i].meshing_cost *= 1 + limits_.later_cost * static_cast<double>(i);
    }
    std::stable_sort(sectors_.begin(), sectors_.end(), [](const Sector& a, const Sector& b) {
      return a.meshing_cost > b.meshing_cost;
    });
  }
  while (has_next()) {
    if (sectors_.empty()) {
      SYMCELL_TRY(cut_one_more(context));
      continue;
    }
    const Sector sector = std::move(sectors_.back());
    sectors_.pop_back();
    if (sector.meshing_cost > limits_.most_costlier * cost_) continue;
    auto solid = tetrahedralize_sector(sector, context);
    if (solid) {
      cost_ = std::min(cost_, sector.meshing_cost);
      solid->sizes = source_.size_field();
      return solid;
    }
    last_ = solid.error();
    if (!is_worth_another_sector(last_.code)) return solid;
  }
  return fail(ErrorCode::kTetrahedralizationFailed,
              "none of " + std::to_string(most_) +
                  " sectors of the model could be tetrahedralized; the last one: " + last_.message +
                  "; look for nearly touching or needle-like facets, or give another fold");
}

}  // namespace symcell::solid
