// From a validated PSLG and the user's fold, centre and tolerance to an exactly symmetric PSLG.
#pragma once

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/model/mesh_options.hpp"
#include "core/model/pslg.hpp"
#include "core/symmetry/symmetric_pslg.hpp"

namespace symcell {

// Detects (or checks the declared) fold and centre and averages every orbit.
// Requires: validate_pslg(pslg) passed.
// Errors: kBadFold, kBadAxis, kNotSymmetric (names fold, error found, tolerance and worst vertex),
// kDegenerateGeometry, kCancelled, kTimeLimit.  Cost: O(N log N) a candidate fold.
[[nodiscard]] Result<SymmetricPslg> symmetrise(const Pslg& pslg,
                                               const MeshOptions& options,
                                               ExecutionContext& context);

// One rung of the ladder of folds that detection looked at.
struct FoldCandidate {
  std::int32_t fold = 1;
  double error_rel = 0;  // largest distance of a rotated vertex from the shape / diameter
  bool accepted = false;
};

struct PslgInspection {
  std::int32_t fold = 1;
  Point2 center;
  double symmetry_error_rel = 0;
  double area = 0;  // of the meshed domain
  double diameter = 0;
  Point2 bbox_min;
  Point2 bbox_max;
  std::size_t vertices = 0;
  std::size_t segments = 0;
  std::size_t holes = 0;             // hole seeds
  std::size_t regions = 0;           // region seeds
  std::size_t components = 0;        // edge-connected pieces of the domain
  double min_input_angle_deg = 0;    // smallest angle between segments at a vertex, in the domain
  std::vector<FoldCandidate> folds;  // ascending
};

// `symcell inspect`: what symmetrise would find, without meshing.  Same errors as symmetrise.
[[nodiscard]] Result<PslgInspection> inspect_pslg(const Pslg& pslg,
                                                  const MeshOptions& options,
                                                  ExecutionContext& context);

}  // namespace symcell
