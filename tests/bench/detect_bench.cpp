// Cost of detection where more and more is allowed: a wavy ring of 3,000 vertices with a fine bore.
#include <benchmark/benchmark.h>

#include <cmath>

#include "core/plane/symmetry/symmetrise.hpp"
#include "tests/bench/bench_models.hpp"
#include "tests/support/shape_models.hpp"

namespace symcell::bench {
namespace {

// Argument: decades by which the tolerance is below the model's diameter.
void detect(benchmark::State& state) {
  const Pslg model = test::wavy_ring();
  MeshOptions options;
  options.symmetry_tolerance_rel = std::pow(10, -static_cast<double>(state.range(0)));
  for (auto _ : state) {
    ExecutionContext context;
    const auto found = plane::inspect_pslg(model, options, context);
    if (!found) state.SkipWithError(found.error().message.c_str());
    benchmark::DoNotOptimize(found);
  }
}
BENCHMARK(detect)->ArgName("decades")->DenseRange(1, 6)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace symcell::bench
