#include "core/initial/solid_starts.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace symcell {
namespace {

// Sectors that are tried before a model is given up.
constexpr std::int32_t kMaxSectors = 40;

bool is_limit(ErrorCode code) {
  return code == ErrorCode::kCancelled || code == ErrorCode::kTimeLimit ||
         code == ErrorCode::kMemoryLimit || code == ErrorCode::kElementLimit;
}

// What a wrong seed or a wrong model causes is so for every sector.
bool is_worth_another_sector(ErrorCode code) {
  return code == ErrorCode::kTetrahedralizationFailed || code == ErrorCode::kInternal;
}

}  // namespace

SolidStarts::SolidStarts(const SectorSource& source)
    : source_(source), most_(std::min(source.candidates(), kMaxSectors)) {
}

Result<void> SolidStarts::cut_one_more(ExecutionContext& context) {
  auto sector = source_.sector(next_++, context);
  if (sector) {
    sectors_.push_back(std::move(*sector));
    return {};
  }
  last_ = sector.error();
  return is_limit(last_.code) ? tl::unexpected<Error>(last_) : Result<void>{};
}

Result<InitialTetrahedralization> SolidStarts::next(ExecutionContext& context) {
  if (next_ == 0) {
    while (next_ < std::min(most_, source_.worth_comparing())) {
      if (auto ok = cut_one_more(context); !ok) return tl::unexpected<Error>(ok.error());
      if (!sectors_.empty() && sectors_.back().narrow_corners == 0) break;
    }
    std::stable_sort(sectors_.begin(), sectors_.end(),
                     [](const SolidSector& a, const SolidSector& b) {
                       return a.meshing_cost > b.meshing_cost;
                     });
  }
  while (has_next()) {
    if (sectors_.empty()) {
      if (auto ok = cut_one_more(context); !ok) return tl::unexpected<Error>(ok.error());
      continue;
    }
    const SolidSector sector = std::move(sectors_.back());
    sectors_.pop_back();
    auto solid = tetrahedralize_sector(sector, context);
    if (solid) return solid;
    last_ = solid.error();
    if (!is_worth_another_sector(last_.code)) return solid;
  }
  return fail(ErrorCode::kTetrahedralizationFailed,
              "none of " + std::to_string(most_) +
                  " sectors of the model could be tetrahedralized; the last one: " + last_.message +
                  "; look for nearly touching or needle-like facets, or give another fold");
}

}  // namespace symcell
