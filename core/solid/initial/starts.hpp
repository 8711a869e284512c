// Initial tetrahedralizations of a solid, of one sector after the other.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/solid/initial/initial_tetrahedralization.hpp"
#include "core/solid/sector/sector_source.hpp"
#include "core/solid/tuning.hpp"

namespace symcell::solid {

class Starts {
 public:
  // `source` must outlive the object.
  explicit Starts(const SectorSource& source, const StartLimits& limits = {});

  // Candidates that are not preferred are for want of a mesh, or where there is time for them.
  void set_has_mesh(bool has_mesh) { has_mesh_ = has_mesh; }
  // Whether sectors are left that were not tried.
  [[nodiscard]] bool has_next() const { return !sectors_.empty() || next_ < most_candidates(); }

  // Of the next sector that can be tetrahedralized; at first of those worth comparing the one that
  // promises the smallest mesh.
  // Errors: kTetrahedralizationFailed (of all that were left), model codes, limits.
  [[nodiscard]] Result<InitialTetrahedralization> next(ExecutionContext& context);

  // Triangles that were worked on so far.
  [[nodiscard]] std::size_t effort() const { return effort_; }

 private:
  [[nodiscard]] std::int32_t most_candidates() const {
    const bool in_time = effort_ + source_.effort() <= limits_.start_budget;
    return !has_mesh_ || in_time ? most_ : std::min(most_, source_.preferred());
  }
  [[nodiscard]] bool is_worth_comparing() const;
  [[nodiscard]] bool cuts_are_alike() const;
  [[nodiscard]] Result<void> cut_one_more(ExecutionContext& context);

  const SectorSource& source_;
  StartLimits limits_;
  std::int32_t most_;
  std::int32_t next_ = 0;  // candidate of the source
  std::size_t effort_ = 0;
  bool has_mesh_ = false;
  std::vector<Sector> sectors_;  // cut already; the most promising is the last
  double cost_ = std::numeric_limits<double>::infinity();  // least of those that went well
  Error last_;
};

}  // namespace symcell::solid
