#include "core/mesh_pslg.hpp"

#include <chrono>
#include <optional>
#include <string>

#include "core/cells/build_cell_mesh.hpp"
#include "core/cells/extract_cell.hpp"
#include "core/cells/quadratic.hpp"
#include "core/delaunay/insert.hpp"
#include "core/improve/coarsen.hpp"
#include "core/initial/initial_triangulation.hpp"
#include "core/model/validate_pslg.hpp"
#include "core/refine/criteria.hpp"
#include "core/refine/refiner.hpp"
#include "core/stats/quality.hpp"
#include "core/symmetry/symmetrise.hpp"
#include "core/tds/validate.hpp"

namespace symcell {
namespace {

constexpr int kAttempts = 6;
constexpr int kSamples = 24;
constexpr double kSamplingAngleDeg = 38;

class Stopwatch {
 public:
  // Milliseconds since the last call.
  double lap() {
    const auto now = Clock::now();
    const double ms = std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
    return ms;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_ = Clock::now();
};

// A bound on the area asks for at least area / bound triangles: refuse at once what cannot fit.
Result<void> check_area_budget(const InitialTriangulation& start,
                               const Criteria& criteria,
                               const ExecutionContext& context) {
  double least = 0;
  for (TriangleId t = 0; t < start.mesh.triangle_slots(); ++t) {
    if (!start.mesh.alive(t)) continue;
    const Triangle& tri = start.mesh.triangle(t);
    const Point2 a = start.mesh.corner_point(tri, 0), b = start.mesh.corner_point(tri, 1),
                 c = start.mesh.corner_point(tri, 2);
    least += 0.5 * cross(b - a, c - a) / criteria.max_area(tri.face);
  }
  if (least <= static_cast<double>(context.max_elements())) return {};
  return fail(ErrorCode::kElementLimit,
              "the area bounds ask for at least " + std::to_string(least) +
                  " triangles in the cell, max_elements is " +
                  std::to_string(context.max_elements()) +
                  "; raise max_area (or the regions' max_area) or max_elements");
}

// Counts the exempt by reason. What is bad and not exempt must not be handed out.
Result<void> count_exempt(const QuotientTriangulation& mesh,
                          const Criteria& criteria,
                          Statistics& statistics) {
  std::uint64_t count[5] = {};
  for (TriangleId t = 0; t < mesh.triangle_slots(); ++t) {
    if (!mesh.alive(t)) continue;
    const Assessment a = criteria.assess(mesh, mesh.triangle(t));
    if (a.verdict == Verdict::kGood) continue;
    const Exemption why = a.too_large ? Exemption::kNone : criteria.exemption(mesh, t, a);
    if (why == Exemption::kNone) {
      return fail(ErrorCode::kInternal,
                  "triangle " + std::to_string(t) + " of the finished mesh breaks a bound");
    }
    ++count[static_cast<std::size_t>(why)];
  }
  constexpr const char* kReasons[4] = {"", "small_input_angle", "across_small_input_angle",
                                       "fold_angle_at_centre"};
  for (std::size_t i = 1; i < 4; ++i) {
    if (count[i] > 0) statistics.exempt.push_back({kReasons[i], count[i]});
  }
  return {};
}

}  // namespace

Result<MeshOutcome> mesh_pslg(const Pslg& pslg,
                              const MeshOptions& options,
                              ExecutionContext& context) {
  MeshOutcome outcome;
  Statistics& stats = outcome.statistics;
  Stopwatch total, watch;
  context.report(Phase::kSymmetry, 0.02);
  if (auto ok = validate_pslg(pslg, context); !ok) return tl::unexpected<Error>(ok.error());
  auto symmetric = symmetrise(pslg, options, context);
  if (!symmetric) return tl::unexpected<Error>(symmetric.error());
  stats.timings_ms.symmetry = watch.lap();

  context.report(Phase::kInitial, 0.08);
  auto start = triangulate_initial(*symmetric, context);
  if (!start) return tl::unexpected<Error>(start.error());
  const std::size_t input_vertices = start->mesh.vertex_slots();
  stats.timings_ms.initial = watch.lap();

  Criteria criteria(start->mesh, start->subdomains, options);
  if (auto ok = check_area_budget(*start, criteria, context); !ok) {
    return tl::unexpected<Error>(ok.error());
  }
  // Near 40 degrees a run may cascade where another, with other sampled points, does not: begin
  // again from the initial triangulation a few times before giving up.
  const QuotientTriangulation initial = start->mesh;
  const Criteria initial_criteria = criteria;
  DelaunayEditor editor(start->mesh);
  std::optional<Refiner> refiner;
  for (int attempt = 0;; ++attempt) {
    const bool sample =
        !options.plain && (attempt > 0 || options.min_angle_deg >= kSamplingAngleDeg);
    refiner.emplace(editor, criteria,
                    Refiner::Settings{symmetric->center, !options.plain, sample ? kSamples : 0,
                                      options.seed + static_cast<std::uint64_t>(attempt)},
                    context);
    auto ok = refiner->run();
    if (ok) break;
    if (ok.error().code != ErrorCode::kBoundUnreachable || options.plain ||
        attempt + 1 == kAttempts) {
      return tl::unexpected<Error>(ok.error());
    }
    start->mesh = initial;
    criteria = initial_criteria;
  }
  start->mesh.compact();
  Coarsener coarsener(editor, criteria, refiner->surgery(), context);
  if (!options.plain) {
    if (auto ok = coarsener.run(); !ok) return tl::unexpected<Error>(ok.error());
  }
  if (!options.plain) start->mesh.compact();
  if (auto ok = validate(start->mesh, ValidationLevel::kDelaunay); !ok) {
    return tl::unexpected<Error>(ok.error());
  }
  stats.timings_ms.refine = watch.lap();

  context.report(Phase::kCell, 0.92, start->mesh.triangle_count(), 1);
  auto cut = cut_cell(start->mesh);
  if (!cut) return tl::unexpected<Error>(cut.error());
  outcome.mesh = build_cell_mesh(*start, *cut, *symmetric);
  if (options.order == 2) outcome.mesh = elevate_to_quadratic(outcome.mesh);
  measure_cell_2(outcome.mesh, stats);
  if (auto ok = count_exempt(start->mesh, criteria, stats); !ok) {
    return tl::unexpected<Error>(ok.error());
  }
  stats.timings_ms.cell = watch.lap();

  stats.symmetry.fold = symmetric->fold;
  stats.symmetry.axis_origin = {symmetric->center.x, symmetric->center.y, 0};
  stats.symmetry.error_rel = symmetric->symmetry_error_rel;
  stats.symmetry.detected = symmetric->fold_detected;
  const RefineCounters& done = refiner->counters();
  for (std::size_t v = input_vertices; v < start->mesh.vertex_slots(); ++v) {
    stats.refinement.steiner_points +=
        start->mesh.kind(static_cast<VertexId>(v)) != VertexKind::kDeleted ? 1 : 0;
  }
  stats.refinement.splits = done.splits;
  const CoarsenCounters& coarsened = coarsener.counters();
  stats.refinement.relocations = done.relocations + coarsened.relocations;
  stats.refinement.removed = done.removed + coarsened.removed + coarsened.merged;
  stats.refinement.flips = editor.counters().flips;
  stats.refinement.crossings = editor.counters().crossings;
  stats.timings_ms.total = total.lap();
  stats.peak_memory_bytes = peak_memory_bytes();
  context.report(Phase::kDone, 1, stats.cell.elements, 1);
  return outcome;
}

}  // namespace symcell
