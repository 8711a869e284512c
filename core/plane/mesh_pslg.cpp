#include "core/plane/mesh_pslg.hpp"

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/base/stopwatch.hpp"
#include "core/cell/measure_cell.hpp"
#include "core/cell/quadratic.hpp"
#include "core/guard/check_cell.hpp"
#include "core/guard/check_curved.hpp"
#include "core/plane/arcs/split_chords.hpp"
#include "core/plane/cut/build_cell_mesh.hpp"
#include "core/plane/cut/cut_cell.hpp"
#include "core/plane/delaunay/insert.hpp"
#include "core/plane/initial/initial_triangulation.hpp"
#include "core/plane/quotient/segment_cover.hpp"
#include "core/plane/quotient/validate.hpp"
#include "core/plane/refine/coarsen.hpp"
#include "core/plane/refine/criteria.hpp"
#include "core/plane/refine/local_sizes.hpp"
#include "core/plane/refine/refiner.hpp"
#include "core/plane/symmetry/split_segment.hpp"

namespace symcell::plane {
namespace {

// Near 40 degrees a run may cascade where another, with other sampled points, does not.
constexpr int kAttempts = 6;              // after them the bound is reported as out of reach
constexpr int kSamples = 24;              // points tried for a bad triangle: each costs its star
constexpr double kSamplingAngleDeg = 38;  // below, samples are taken from the second attempt on
// Small cells are made several times, with other samples and for somewhat higher bounds (a coarse
// model may come out smaller for them), and the one with the fewest triangles is kept: a few
// milliseconds each, and greedy coarsening ends in different places.
constexpr std::size_t kSmallCell = 500;
constexpr double kFurtherStartsDeg[] = {0, 0, 0, 1, 2, 3};
// Where sizes decide the mesh, the angle hardly matters to the count, and chance does: starts for
// what other bounds would be given keep the count from falling where the angle grows.
constexpr double kFurtherStartsSizedDeg[] = {5, 10, 15, 20};
constexpr double kHighestSizedStartDeg = 30;  // above, angles ask for more than sizes do

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
  constexpr std::size_t kCounted = 6;  // reasons, none included
  std::uint64_t count[kCounted + 1] = {};
  for (TriangleId t = 0; t < mesh.triangle_slots(); ++t) {
    if (!mesh.alive(t)) continue;
    const Assessment a = criteria.assess(mesh, mesh.triangle(t));
    const bool short_edge = criteria.has_short_edge(mesh, mesh.triangle(t));
    if (a.verdict == Verdict::kGood && !short_edge) continue;
    Exemption why = a.too_large ? Exemption::kNone : criteria.exemption(mesh, t, a);
    if (why == Exemption::kNone && criteria.may_leave_bad()) {
      why = criteria.has_least_edge() ? Exemption::kMinEdge : Exemption::kKeptBoundary;
    }
    if (why == Exemption::kNone || short_edge) {
      return fail(ErrorCode::kInternal,
                  "triangle " + std::to_string(t) + " of the finished mesh breaks a bound");
    }
    ++count[static_cast<std::size_t>(why)];
  }
  constexpr const char* kReasons[kCounted] = {"",
                                              "small_input_angle",
                                              "across_small_input_angle",
                                              "fold_angle_at_centre",
                                              "kept_boundary",
                                              "min_edge"};
  for (std::size_t i = 1; i < kCounted; ++i) {
    if (count[i] > 0) statistics.exempt.push_back({kReasons[i], count[i]});
  }
  return {};
}

struct WorkDone {
  RefineCounters refined;
  CoarsenCounters coarsened;
  EditCounters edits;
};

// Refines until no triangle is bad, then coarsens.
Result<WorkDone> refine_and_coarsen(QuotientTriangulation& mesh,
                                    Criteria& criteria,
                                    const Refiner::Settings& settings,
                                    ExecutionContext& context) {
  Editor editor(mesh);
  Refiner refiner(editor, criteria, settings, context);
  SYMCELL_TRY(refiner.run());
  mesh.compact();
  Coarsener coarsener(editor, criteria, refiner.surgery(), context);
  if (settings.relocate) {
    SYMCELL_TRY(coarsener.run());
    mesh.compact();
  }
  return WorkDone{refiner.counters(), coarsener.counters(), editor.counters()};
}

std::size_t count_bad(const QuotientTriangulation& mesh, const Criteria& criteria) {
  std::size_t count = 0;
  for (TriangleId t = 0; t < mesh.triangle_slots(); ++t) {
    count += mesh.alive(t) && criteria.is_bad(mesh, t) ? 1 : 0;
  }
  return count;
}

// An edge shorter than so many least ones is not divided: smaller sizes would be asked for in vain,
// and what is refused for their sake leaves bad angles.
constexpr double kLeastSplitEdges = 2;

// A further start is given up where refinement, which coarsening follows, makes this many times the
// triangles of the best mesh: a higher bound may ask for a million where the one asked for needs none.
constexpr std::size_t kHopeless = 8;

std::vector<double> bounds_of_further_starts(const MeshOptions& options, bool sized) {
  std::vector<double> bounds;
  for (const double higher : kFurtherStartsDeg) {
    bounds.push_back(std::min(options.min_angle_deg + higher, kMaxMinAngleDeg));
  }
  for (const double higher : kFurtherStartsSizedDeg) {
    const double bound = options.min_angle_deg + higher;
    if (sized && bound <= kHighestSizedStartDeg) bounds.push_back(bound);
  }
  return bounds;
}

// From the initial triangulation again, with other samples, where a run cascades; and a few times
// more where the cell is small, keeping the best.
Result<WorkDone> refine_from_starts(InitialTriangulation& start,
                                    Criteria& criteria,
                                    const MeshOptions& options,
                                    const LocalSizes& sizes,
                                    Point2 centre,
                                    ExecutionContext& context) {
  constexpr std::size_t kAny = std::numeric_limits<std::size_t>::max();
  const auto attempt = [&](QuotientTriangulation& mesh, Criteria& own, int number,
                           std::size_t most) {
    const bool sample =
        !options.plain && (number > 0 || options.min_angle_deg >= kSamplingAngleDeg);
    return refine_and_coarsen(mesh, own,
                              {centre, !options.plain, sample ? kSamples : 0,
                               options.seed + static_cast<std::uint64_t>(number), most},
                              context);
  };
  const QuotientTriangulation initial = start.mesh;
  const Criteria initial_criteria = criteria;
  int number = 0;
  auto best = attempt(start.mesh, criteria, number++, kAny);
  while (!best) {
    const bool cascaded = best.error().code == ErrorCode::kBoundUnreachable;
    if (!cascaded || options.plain || number == kAttempts) return best;
    start.mesh = initial;
    criteria = initial_criteria;
    best = attempt(start.mesh, criteria, number++, kAny);
  }
  const bool untouched = best->refined.inserted == 0;
  if (options.plain || untouched || start.mesh.triangle_count() > kSmallCell) return best;
  std::size_t least_bad = count_bad(start.mesh, criteria);  // 0 unless edges have a least length
  for (const double bound : bounds_of_further_starts(options, criteria.has_size_bound())) {
    MeshOptions tighter = options;
    tighter.min_angle_deg = bound;
    QuotientTriangulation mesh = initial;
    Criteria own(mesh, start.subdomains, tighter, sizes);
    const std::size_t most = kHopeless * start.mesh.triangle_count();
    auto work = attempt(mesh, own, number++, most);
    if (!work) {
      const bool given_up =
          work.error().code == ErrorCode::kBoundUnreachable ||
          (work.error().code == ErrorCode::kElementLimit && mesh.triangle_count() > most);
      if (!given_up) return work;
      continue;
    }
    // What a higher bound exempts, the one asked for may not.
    Criteria asked = initial_criteria;
    asked.adopt_segment_ends(own);
    const std::size_t bad = count_bad(mesh, asked);
    const std::size_t triangles = mesh.triangle_count();
    if (std::pair(bad, triangles) >= std::pair(least_bad, start.mesh.triangle_count())) continue;
    least_bad = bad;
    start.mesh = std::move(mesh);
    criteria = std::move(asked);
    best = std::move(work);
  }
  return best;
}

struct Refined {
  InitialTriangulation start;  // with the refined mesh
  SegmentCover wanted;         // of the mesh before
  Criteria criteria;
  WorkDone work;
};

// `graded`: what the gradation allows, found on the first mesh if null.
Result<Refined> refine(const Pslg& model,
                       const SymmetricPslg& symmetric,
                       const MeshOptions& options,
                       std::shared_ptr<const GradedSize>& graded,
                       Stopwatch& watch,
                       Statistics& stats,
                       ExecutionContext& context) {
  auto sizes = resolve_sizes(model, symmetric, options.sizes);
  if (!sizes) return error_of(sizes);
  auto start = triangulate_initial(symmetric, context);
  if (!start) return error_of(start);
  if (options.gradation < kInfinity && !graded) {
    graded = std::make_shared<GradedSize>(
        grade_sizes(start->mesh, *sizes, options.gradation, kLeastSplitEdges * options.min_edge));
  }
  sizes->graded = graded;
  stats.timings_ms.initial += watch.lap();
  Criteria criteria(start->mesh, start->subdomains, options, *sizes);
  SYMCELL_TRY(check_area_budget(*start, criteria, context));
  SegmentCover wanted = measure_segment_cover(start->mesh);
  auto work = refine_from_starts(*start, criteria, options, *sizes, symmetric.centre, context);
  if (!work) return error_of(work);
  stats.timings_ms.refine += watch.lap();
  return Refined{std::move(*start), std::move(wanted), std::move(criteria), *work};
}

// Vertices that refinement sets on chords belong on the arcs: they become vertices of the model
// there, and meshing begins anew, until no chord is split. Each round leaves a quarter of the
// distance between chord and arc. `symmetric` becomes what was meshed last. Where the finer chords
// cannot be meshed, as in a gap that they close, those before stay. Edges grow away from what is
// small in the model, not from chords that were divided for their sake: those would get ever shorter.
Result<Refined> refine_on_arcs(const Pslg& model,
                               SymmetricPslg& symmetric,
                               const MeshOptions& options,
                               Stopwatch& watch,
                               Statistics& stats,
                               ExecutionContext& context) {
  constexpr int kMostRounds = 8;
  std::shared_ptr<const GradedSize> graded;
  auto best = refine(model, symmetric, options, graded, watch, stats, context);
  for (int round = 0; best && round < kMostRounds; ++round) {
    auto closer = split_chords(symmetric, best->start.mesh);
    if (!closer) break;
    auto next = refine(model, *closer, options, graded, watch, stats, context);
    if (!next && is_limit(next.error().code)) return next;
    if (!next) break;
    symmetric = std::move(*closer);
    best = std::move(next);
  }
  return best;
}

// Down to the Delaunay property, and that all of the domain is covered and nothing else.
Result<void> check_mesh(const QuotientTriangulation& mesh, const SegmentCover& wanted) {
  SYMCELL_TRY(validate(mesh, ValidationLevel::kDelaunay));
  return compare_segment_covers(wanted, measure_segment_cover(mesh));
}

// With the middles of chords on their arcs, unless that would fold a triangle, as where two arcs
// touch: such chords stay straight, and are counted.
Result<SymmetryCellMesh> elevate(SymmetryCellMesh mesh, std::size_t& straightened) {
  SymmetryCellMesh elevated = elevate_to_quadratic(mesh);
  if (mesh.boundary_bulges.empty()) return elevated;
  constexpr int kRounds = 2;  // a triangle without curved sides is not folded
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<std::size_t> folded = folded_elements(elevated);
    if (folded.empty()) return elevated;
    std::set<std::pair<std::int32_t, std::int32_t>> sides;
    for (const std::size_t e : folded) {
      const std::int32_t* corner = &mesh.elements[3 * e];
      for (std::size_t i = 0; i < 3; ++i) {
        sides.insert(std::minmax({corner[i], corner[(i + 1) % 3]}));
      }
    }
    for (std::size_t f = 0; f < mesh.boundary_bulges.size(); ++f) {
      const auto side = std::minmax({mesh.boundary[2 * f], mesh.boundary[2 * f + 1]});
      if (mesh.boundary_bulges[f] == 0 || !sides.contains(side)) continue;
      mesh.boundary_bulges[f] = 0;
      ++straightened;
    }
    elevated = elevate_to_quadratic(mesh);
  }
  if (folded_elements(elevated).empty()) return elevated;
  return fail(ErrorCode::kInternal, "a quadratic triangle with straight sides is folded");
}

// Steiner points are the vertices behind the `input_orbits` of the symmetrised model, a centre that
// was added included.
void record(const WorkDone& work,
            const QuotientTriangulation& mesh,
            std::size_t input_orbits,
            Statistics::Refinement& out) {
  for (std::size_t v = input_orbits; v < mesh.vertex_slots(); ++v) {
    out.steiner_points += mesh.corner_of(static_cast<VertexId>(v)) != kNoHalfEdge ? 1 : 0;
  }
  out.splits = work.refined.splits;
  out.relocations = work.refined.relocations + work.coarsened.relocations;
  out.removed = work.refined.removed + work.coarsened.removed + work.coarsened.merged;
  out.flips = work.edits.flips;
  out.crossings = work.edits.crossings;
}

}  // namespace

Result<MeshOutcome> mesh_pslg(const Pslg& model,
                              const SymmetricPslg& symmetric,
                              const MeshOptions& options,
                              ExecutionContext& context) {
  MeshOutcome outcome;
  Statistics& stats = outcome.statistics;
  Stopwatch watch;
  context.report(Phase::kInitial, 0.08);
  // The model as it is meshed: with the vertices that the options and finer chords ask for.
  SymmetricPslg meshed = symmetric;
  SYMCELL_TRY(divide_segments(meshed, options.divisions));
  const bool has_arcs = !meshed.bulges.empty();
  std::shared_ptr<const GradedSize> graded;
  const auto refined = has_arcs ? refine_on_arcs(model, meshed, options, watch, stats, context)
                                : refine(model, meshed, options, graded, watch, stats, context);
  if (!refined) return error_of(refined);
  const QuotientTriangulation& mesh = refined->start.mesh;
  record(refined->work, mesh, symmetric.orbit_points.size(), stats.refinement);

  context.report(Phase::kCell, 0.92, mesh.triangle_count(), 1);
  SYMCELL_TRY(check_mesh(mesh, refined->wanted));
  stats.timings_ms.check = watch.lap();
  SYMCELL_TRY(count_exempt(mesh, refined->criteria, stats));
  auto cut = cut_cell(mesh);
  if (!cut) return error_of(cut);
  outcome.mesh = build_cell_mesh(refined->start, *cut, meshed);
  stats.timings_ms.cell = watch.lap();
  SYMCELL_TRY(check_cell(outcome.mesh));
  stats.timings_ms.check += watch.lap();
  std::size_t straightened = 0;
  if (options.order == 2) {
    auto elevated = elevate(std::move(outcome.mesh), straightened);
    if (!elevated) return error_of(elevated);
    outcome.mesh = std::move(*elevated);
  }
  if (has_arcs) {
    const std::size_t off_arcs = vertices_on_chords(meshed, mesh);
    if (off_arcs + straightened > 0) {
      stats.warnings.push_back(arcs_as_chords_warning(off_arcs, straightened));
    }
  }
  measure_cell_2(outcome.mesh, stats);
  stats.timings_ms.cell += watch.lap();
  stats.peak_memory_bytes = peak_memory_bytes();
  context.report(Phase::kDone, 1, stats.cell.elements, 1);
  return outcome;
}

}  // namespace symcell::plane
