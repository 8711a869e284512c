// A symmetric solid from which exact sectors can be cut at several angles: where one candidate
// fails (the cut meets the surface badly, or its tetrahedralization fails), the next is tried.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/geometry/axis_frame.hpp"
#include "core/symmetry/solid_sector.hpp"

namespace symcell {

// What was found, for statistics and `inspect`.
struct SolidSymmetry {
  std::int32_t fold = 1;
  AxisFrame frame;
  double error_rel = 0;  // largest over k = 1 .. n-1, as a share of the diameter
  double diameter = 0;   // bounding-box diagonal of the model
  bool fold_detected = false;
  bool axis_detected = false;
};

class SectorSource {
 public:
  virtual ~SectorSource() = default;

  [[nodiscard]] virtual const SolidSymmetry& symmetry() const = 0;
  [[nodiscard]] virtual const std::vector<std::string>& repairs() const = 0;

  // The number of different sectors that may be asked for, >= 1.
  [[nodiscard]] virtual std::int32_t candidates() const = 0;
  // The first so many may be chosen from; the others are for those models that all of them fail on.
  [[nodiscard]] virtual std::int32_t preferred() const { return candidates(); }
  // Triangles that are worked on for one candidate. 0: candidates differ in nothing but the cut.
  [[nodiscard]] virtual std::size_t effort() const { return 0; }
  // Candidate `index` in [0, candidates()), the most promising first.  Errors: kInternal or a model
  // code if this candidate cannot be cut; limits.
  [[nodiscard]] virtual Result<SolidSector> sector(std::int32_t index,
                                                   ExecutionContext& context) const = 0;
};

}  // namespace symcell
