// Which fold of a symmetric solid gives the smallest cell. It need not be the largest: every vertex
// has copies at the width of a sector, so where a ring is thick for its width, elements are as small
// as the sector is narrow, all through it, and their number in a cell grows with the fold squared.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/cell/statistics.hpp"
#include "core/model/mesh_options.hpp"
#include "core/solid/quotient/quotient_tetrahedralization.hpp"
#include "core/solid/sector/sector_source.hpp"
#include "core/solid/tuning.hpp"

namespace symcell::solid {

// How the tetrahedra of a refined mesh would change in number with the fold.
class SectorLoad {
 public:
  explicit SectorLoad(const QuotientTetrahedralization& mesh);

  [[nodiscard]] double count() const { return static_cast<double>(sizes_.size()); }
  // Tetrahedra in a cell at another fold. Those with an edge between two copies of a vertex are as
  // large as the sector allows, and grow with it; the others keep their size, but where the sector
  // gets narrower than that.
  [[nodiscard]] double estimate(std::int32_t fold) const;

 private:
  struct Size {
    double share = 0;      // of the width of one turn at its radius: mean edge / (2 pi radius)
    bool limited = false;  // by the sector
  };
  std::int32_t fold_;
  std::vector<Size> sizes_;
};

struct ChosenFold {
  std::unique_ptr<SectorSource> source;  // null: the one that was given
  std::vector<FoldEstimate> candidates;  // descending; empty where there is nothing to choose from
};

// Meshes a sector of the largest fold, then those of the divisors that the estimates of the meshes so
// far point to, and takes the one with the fewest tetrahedra.
// Errors: limits. What cannot be meshed at a fold is no candidate.
[[nodiscard]] Result<ChosenFold> choose_fold(const SectorSource& largest,
                                             const MeshOptions& options,
                                             ExecutionContext& context,
                                             const Tuning& tuning = {});

}  // namespace symcell::solid
