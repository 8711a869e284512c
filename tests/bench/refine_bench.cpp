// Cost of refinement: the quotient of a 6-fold flange, and the whole flange meshed without its
// symmetry (fold 1), by plain refinement and with relocation and coarsening.
#include <benchmark/benchmark.h>

#include "tests/bench/bench_models.hpp"

namespace symcell::bench {
namespace {

constexpr std::int32_t kFold = 6;

// Arguments: fold of the mesher (the model has 6), triangles of the full mesh, plain.
void refine(benchmark::State& state) {
  const auto fold = static_cast<std::int32_t>(state.range(0));
  const bool plain = state.range(2) != 0;
  const Pslg model = flange_of(kFold);
  const MeshOptions options =
      sized_options(model, fold, static_cast<double>(state.range(1)), plain);
  double refine_ms = 0, total_ms = 0;
  Statistics last;
  for (auto _ : state) {
    last = mesh(model, options).statistics;
    refine_ms += last.timings_ms.refine;
    total_ms += last.timings_ms.total;
    state.SetIterationTime(1e-3 * last.timings_ms.refine);
  }
  const auto runs = static_cast<double>(state.iterations());
  const auto cell = static_cast<double>(last.cell.elements);
  state.counters["cell"] = cell;
  state.counters["full"] = static_cast<double>(last.full.elements);
  state.counters["min_angle"] = last.cell.min_angle_deg;
  state.counters["total_ms"] = total_ms / runs;
  state.counters["us_per_cell_triangle"] = 1e3 * refine_ms / runs / cell;
}
BENCHMARK(refine)
    ->ArgNames({"fold", "full", "plain"})
    ->ArgsProduct({{kFold, 1}, {10'000, 100'000, 1'000'000}, {1, 0}})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace symcell::bench
