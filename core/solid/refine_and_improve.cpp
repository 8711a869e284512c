#include "core/solid/refine_and_improve.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "core/base/stopwatch.hpp"
#include "core/solid/delaunay/legalise.hpp"
#include "core/solid/improve/improver.hpp"
#include "core/solid/quotient/constraints.hpp"
#include "core/solid/quotient/validate.hpp"
#include "core/solid/refine/refiner.hpp"

namespace symcell::solid {
namespace {

// Depths of refinement after each round, full or not: no deeper before points are free to go
// anywhere.
constexpr int kDepths[] = {2, 2, 2, 2, 2, 3, 3, 4, 5};
// Depths of refinement where no improvement follows. What is bad after a shallow run is little, and
// so is the budget of the deeper one.
constexpr int kDepthsAlone[] = {2, 3, 4};
constexpr int kDepthsDelaunay[] = {2, 2, 3, 3, 4, 4, 6, 6, 8, 8};

struct Work {
  RoundLimits limits;
  std::uint64_t most_shaped = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t most_tets = 0;
  double least_distance = 0;
  bool exempt_too = false;   // in later runs: most of what is bad at first is mended without
  bool illegal_too = false;  // what is not Delaunay is refined like what is bad
  RefineCounters refined;
  std::size_t runs = 0;  // of refinement, so far

  // Of the next run. Without improvement between them runs do not go beyond the limit of those.
  [[nodiscard]] std::size_t most_hidden(bool alone) const {
    if (alone) return limits.most_hidden_alone;
    return runs < limits.most_hidden.size() ? limits.most_hidden[runs] : Editor::kAny;
  }
};

double total_volume(const Editor& editor) {
  double sum = 0;
  for (TetId t = 0; t < editor.mesh().tet_slots(); ++t) {
    if (editor.mesh().alive(t)) sum += editor.measures(t).volume;
  }
  return sum;
}

double shortest_edge(const Editor& editor) {
  double least2 = std::numeric_limits<double>::infinity();
  for (TetId t = 0; t < editor.mesh().tet_slots(); ++t) {
    if (editor.mesh().alive(t)) least2 = std::min(least2, editor.measures(t).shortest2);
  }
  return std::sqrt(least2);
}

std::size_t count_bad(const Editor& editor, const Criteria& criteria) {
  const QuotientTetrahedralization& mesh = editor.mesh();
  std::size_t count = 0;
  for (TetId t = 0; t < mesh.tet_slots(); ++t) {
    if (!mesh.alive(t)) continue;
    const Exemption exempt = criteria.exemption(mesh, mesh.tet(t));
    count += criteria.is_bad(editor.measures(t), mesh.tet(t).region, exempt) ? 1 : 0;
  }
  return count;
}

// A bound on the volume asks for at least volume / bound tetrahedra: refuse at once what cannot
// fit.
Result<double> check_volume_budget(const Editor& editor,
                                   const Criteria& criteria,
                                   const ExecutionContext& context) {
  double least = 0;
  for (TetId t = 0; t < editor.mesh().tet_slots(); ++t) {
    if (!editor.mesh().alive(t)) continue;
    least += editor.measures(t).volume / criteria.max_volume(editor.mesh().tet(t).region);
  }
  if (least <= static_cast<double>(context.max_elements())) return least;
  return fail(ErrorCode::kElementLimit,
              "the volume bounds ask for at least " + std::to_string(least) +
                  " tetrahedra in the cell, max_elements is " +
                  std::to_string(context.max_elements()) +
                  "; raise max_volume (or the regions' max_volume) or max_elements");
}

Result<void> refine(Editor& editor,
                    const Criteria& criteria,
                    int depth,
                    bool alone,
                    ExecutionContext& context,
                    Work& work) {
  Refiner refiner(editor, criteria, context);
  refiner.set_most_tets(work.most_tets);
  refiner.set_most_shaped(work.most_shaped);
  refiner.set_least_distance(work.least_distance);
  refiner.set_max_depth(depth);
  refiner.set_most_hidden(work.most_hidden(alone));
  ++work.runs;
  if (work.illegal_too) refiner.treat_illegal();
  if (work.exempt_too) refiner.treat_exempt();
  work.exempt_too = true;
  auto done = refiner.run();
  work.refined += refiner.counters();
  work.most_shaped =
      std::min(work.most_shaped,
               work.limits.most_growth * editor.mesh().tet_count() + work.limits.least_growth);
  return done;
}

bool has_too_large(const Editor& editor, const Criteria& criteria) {
  const QuotientTetrahedralization& mesh = editor.mesh();
  for (TetId t = 0; t < mesh.tet_slots(); ++t) {
    if (!mesh.alive(t)) continue;
    if (criteria.size_excess2(editor.measures(t), mesh.tet(t).region) > 1) return true;
  }
  return false;
}

// Refines for the sake of `bad` bad tetrahedra. False where points caused others in a cascade: then the mesh
// is as it was.
Result<bool> refine_unless_cascading(std::optional<Editor>& editor,
                                     QuotientTetrahedralization& mesh,
                                     const Criteria& criteria,
                                     int depth,
                                     std::size_t bad,
                                     ExecutionContext& context,
                                     Work& work) {
  const RoundLimits& limits = work.limits;
  // What is too large must not stay. Where facets are kept as given, no other mesh has a better boundary:
  // at large folds of a ring what looked like a cascade was made up for.
  if (limits.most_followed == 0 || !limits.is_many_bad(bad, mesh.tet_count()) ||
      has_too_large(*editor, criteria)) {
    SYMCELL_TRY(refine(*editor, criteria, depth, false, context, work));
    return true;
  }
  const double most = work.runs < limits.most_hidden.size() ? limits.cascade : limits.late_cascade;
  const QuotientTetrahedralization before = mesh;
  const Work work_before = work;
  SYMCELL_TRY(refine(*editor, criteria, depth, false, context, work));
  if (mesh.tet_count() <= limits.cascade_from ||
      static_cast<double>(count_bad(*editor, criteria)) <= most * static_cast<double>(bad)) {
    return true;
  }
  mesh = before;
  work = work_before;
  editor.emplace(mesh);
  return false;
}

// Full rounds of improvement, each followed by refinement of what it left over the bounds; then, as
// long as something is bad, it is refined, ever deeper, and mended: alone where it is little.
Result<void> improve(std::optional<Editor>& working,
                     QuotientTetrahedralization& mesh,
                     const Criteria& criteria,
                     const MeshOptions& options,
                     ExecutionContext& context,
                     Work& work) {
  const double goal_deg = std::max(work.limits.goal_deg, options.min_dihedral_deg);
  const double goal = std::sin(goal_deg * std::numbers::pi / 180);
  bool full = true;
  std::size_t bad_before = mesh.tet_count();
  for (std::size_t round = 0; round < std::size(kDepths); ++round) {
    context.report(Phase::kImprove, 0.6 + 0.05 * static_cast<double>(round), mesh.tet_count());
    Editor& editor = *working;
    if (full) editor.compact();
    Surgery surgery(editor, criteria);
    Improver improver(surgery, criteria, context);
    SYMCELL_TRY(full ? improver.round(goal) : improver.mend(goal));
    const std::size_t count = mesh.tet_count();
    const std::size_t rounds =
        count > work.limits.large_cell ? work.limits.rounds_if_large : work.limits.rounds;
    bool last = false;
    const std::size_t bad = count_bad(editor, criteria);
    if (round + 1 >= rounds) {
      if (bad == 0) break;
      last =
          work.runs > work.limits.most_hidden.size() &&
          static_cast<double>(bad) > work.limits.least_progress * static_cast<double>(bad_before);
      bad_before = bad;
      full = bad > work.limits.few_bad &&
             static_cast<double>(bad) > work.limits.few_bad_share * static_cast<double>(count);
    }
    // What is too large must not stay, whatever else does.
    const int depth = last ? kDepths[0] : kDepths[round];
    auto done = refine_unless_cascading(working, mesh, criteria, depth, bad, context, work);
    if (!done) return error_of(done);
    if (last || !*done) break;
  }
  if (options.delaunay) return {};  // flips undo what comes now
  Surgery surgery(*working, criteria);
  surgery.keep_size();
  Improver improver(surgery, criteria, context);
  if (mesh.tet_count() <= work.limits.most_followed) {
    const auto left = static_cast<double>(count_bad(*working, criteria));
    if (left > work.limits.lost_share * static_cast<double>(mesh.tet_count())) {
      return improver.mend(goal);
    }
  }
  const double costly_deg = std::max(work.limits.costly_goal_deg, options.min_dihedral_deg);
  const double costly_goal = std::sin(costly_deg * std::numbers::pi / 180);
  improver.allow_detours(costly_goal);
  // What could not be mended may be after its neighbours were.
  return improver.mend(goal, work.limits.last_passes);
}

// A point for the sake of shape stands this share of the shortest edge from its vertices at least.
constexpr double kLeastShare = 0.45;

// The growth that a mesh is allowed is meant against cascades, and may be what kept it bad. It goes on
// while that helps; else the mesh is what it was before.
Result<void> grow_while_it_helps(std::optional<Editor>& editor,
                                 QuotientTetrahedralization& mesh,
                                 const Criteria& criteria,
                                 const MeshOptions& options,
                                 ExecutionContext& context,
                                 Work& work) {
  std::size_t bad = count_bad(*editor, criteria);
  for (int growths = 0; growths < work.limits.most_growths; ++growths) {
    if (!work.limits.is_many_bad(bad, mesh.tet_count())) break;
    const QuotientTetrahedralization before = mesh;
    const Work work_before = work;
    work.most_shaped = work.limits.more_growth * mesh.tet_count();
    auto done = refine(*editor, criteria, kDepths[0], false, context, work);
    // Where refinement alone makes more of them, improvement does not make up for it.
    const bool hopeful = done && count_bad(*editor, criteria) <= bad;
    if (hopeful) done = improve(editor, mesh, criteria, options, context, work);
    if (!done && done.error().code != ErrorCode::kElementLimit) return done;
    const std::size_t left = done && hopeful ? count_bad(*editor, criteria) : bad;
    if (static_cast<double>(left) > work.limits.least_decline * static_cast<double>(bad)) {
      mesh = before;
      work = work_before;
      editor.emplace(mesh);
      break;
    }
    bad = left;
  }
  return {};
}

// Counts the exempt by reason and finds the worst shape. A broken size bound must not be handed
// out, unless points that it would need are forbidden.
Result<void> count_exempt(const Editor& editor, const Criteria& criteria, RefinedSolid& result) {
  std::uint64_t sharp = 0, axis = 0, short_edges = 0;
  const QuotientTetrahedralization& mesh = editor.mesh();
  for (TetId t = 0; t < mesh.tet_slots(); ++t) {
    if (!mesh.alive(t)) continue;
    const TetMeasures& m = editor.measures(t);
    const double sine = min_dihedral_sine(mesh.corner_point(t, 0), mesh.corner_point(t, 1),
                                          mesh.corner_point(t, 2), mesh.corner_point(t, 3));
    const Exemption exemption = criteria.exemption(mesh, mesh.tet(t));
    double& least = exemption == Exemption::kNone ? result.least_sine : result.least_exempt_sine;
    least = std::min(least, sine);
    if (criteria.size_excess2(m, mesh.tet(t).region) > 1) {
      if (criteria.min_edge() > 0) {
        ++short_edges;
        continue;
      }
      const Point3 x = mesh.corner_point(t, 0);
      return fail(ErrorCode::kBoundUnreachable,
                  "a volume or edge bound cannot be reached: a tetrahedron of volume " +
                      std::to_string(m.volume) + " near (" + std::to_string(x.x) + ", " +
                      std::to_string(x.y) + ", " + std::to_string(x.z) +
                      ") of the axis' frame stays too large; raise max_volume or max_edge");
    }
    if (criteria.is_bad(m, mesh.tet(t).region, exemption)) {
      const bool too_short = kLeastShare * std::sqrt(m.shortest2) < criteria.min_edge();
      ++(too_short ? short_edges : result.guarded);
    } else if (criteria.is_bad(m, mesh.tet(t).region, Exemption::kNone)) {
      ++(exemption == Exemption::kAxis ? axis : sharp);
    }
  }
  if (sharp > 0) result.exempt.push_back({"small_input_angle", sharp});
  if (axis > 0) result.exempt.push_back({"fold_angle_at_axis", axis});
  if (short_edges > 0) result.exempt.push_back({"min_edge", short_edges});
  if (result.guarded > 0) result.exempt.push_back({"near_small_feature", result.guarded});
  return {};
}

// Everything but the improvement. A mesh that is to be Delaunay is made so first, for circumcentres
// mean little where it is not, and again after every run: what flips make bad is refined again.
Result<void> refine_alone(Editor& editor,
                          const Criteria& criteria,
                          const MeshOptions& options,
                          ExecutionContext& context,
                          Work& work) {
  if (!options.delaunay) {
    for (const int depth : kDepthsAlone) {
      SYMCELL_TRY(refine(editor, criteria, depth, true, context, work));
    }
    return {};
  }
  for (const int depth : kDepthsDelaunay) {
    SYMCELL_TRY(legalise(editor, context));
    work.illegal_too = count_illegal(editor) > 0;
    if (!work.illegal_too && count_bad(editor, criteria) == 0) return {};
    SYMCELL_TRY(refine(editor, criteria, depth, true, context, work));
  }
  SYMCELL_TRY(legalise(editor, context));
  // Flips know of no bound; where the two cannot be had together, the bounds are kept.
  if (count_bad(editor, criteria) == 0) return {};
  return refine(editor, criteria, kDepthsDelaunay[0], true, context, work);
}

// Whether all of the facets and segments is covered, once, and nothing else.
Result<void> check_cover(const InitialTetrahedralization& solid) {
  const auto cover = measure_facet_cover(constraints_of(solid.mesh, solid.axis_segment()));
  if (!cover) return error_of(cover);
  return compare_facet_covers(solid.cover, *cover, solid.diameter);
}

Statistics::Refinement count_work(const Editor& editor, const RefineCounters& refined) {
  Statistics::Refinement work;
  const QuotientTetrahedralization& mesh = editor.mesh();
  for (std::size_t v = 0; v < mesh.vertex_slots(); ++v) {
    const VertexKind kind = mesh.kind(static_cast<VertexId>(v));
    const bool steiner = kind != VertexKind::kInput && kind != VertexKind::kDeleted;
    work.steiner_points += steiner ? 1 : 0;
  }
  work.splits = refined.segment_splits;
  work.flips = editor.counters().flips;
  work.crossings = editor.counters().crossings;
  work.relocations = editor.counters().moves;
  work.removed = editor.counters().collapses;
  return work;
}

}  // namespace

Result<RefinedSolid> refine_and_improve(InitialTetrahedralization solid,
                                        const MeshOptions& options,
                                        std::uint64_t most_tets,
                                        ExecutionContext& context,
                                        const RoundLimits& limits) {
  RefinedSolid result;
  result.solid = std::move(solid);
  QuotientTetrahedralization& mesh = result.solid.mesh;
  std::optional<Editor> working(std::in_place, mesh);
  const double volume = total_volume(*working);
  const Criteria criteria(result.solid, options);
  const auto least = check_volume_budget(*working, criteria, context);
  if (!least) return error_of(least);
  result.least_count = *least;
  {
    Surgery surgery(*working, criteria);
    static_cast<void>(Improver(surgery, criteria, context).collapse_cut_vertices());
  }
  Work work;
  work.limits = limits;
  work.most_tets = most_tets;
  work.least_distance = work.limits.least_distance * shortest_edge(*working);
  if (!options.plain) {
    auto ok = refine(*working, criteria, kDepths[0], false, context, work);
    if (ok) ok = improve(working, mesh, criteria, options, context, work);
    if (ok) ok = grow_while_it_helps(working, mesh, criteria, options, context, work);
    if (!ok) return error_of(ok);
  }
  Editor& editor = *working;
  if (options.plain || options.delaunay) {
    auto ok = refine_alone(editor, criteria, options, context, work);
    if (!ok) return error_of(ok);
  }
  result.refinement = count_work(editor, work.refined);
  editor.compact();  // what follows goes from neighbour to neighbour
  Stopwatch watch;
  const auto report = validate(mesh, ValidationLevel::kEmbedding, volume);
  if (!report) return error_of(report);
  SYMCELL_TRY(check_cover(result.solid));
  result.check_ms = watch.lap();
  result.delaunay = count_illegal(editor) == 0;
  SYMCELL_TRY(count_exempt(editor, criteria, result));
  mesh.compact_vertices();
  return result;
}

}  // namespace symcell::solid
