// Cost of restoring the full mesh from the cell: as nodes and elements, and as a VTU file that
// nobody keeps.
#include <benchmark/benchmark.h>

#include <string_view>

#include "api/formats/mesh_stream.hpp"
#include "api/formats/mesh_writer.hpp"
#include "tests/bench/bench_models.hpp"

namespace symcell::bench {
namespace {

constexpr double kTriangles = 1e6;

SymmetryCellMesh flange_cell(std::int32_t fold) {
  const Pslg model = flange_of(fold);
  return mesh(model, sized_options(model, fold, kTriangles, true)).mesh;
}

void count_per_triangle(benchmark::State& state, const SymmetryCellMesh& cell) {
  const double full = static_cast<double>(cell.element_count()) * cell.fold;
  state.counters["full"] = full;
  state.counters["s_per_triangle"] = benchmark::Counter(
      full, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

// Positions of all nodes and node ids of all elements, as any writer gets them.
void restore(benchmark::State& state) {
  const SymmetryCellMesh cell = flange_cell(static_cast<std::int32_t>(state.range(0)));
  for (auto _ : state) {
    MeshStream stream(cell, MeshPart::kFull);
    double sum = 0;
    stream.each_node([&](const Point3& p, std::int32_t) { sum += p.x; });
    std::int64_t ids = 0;
    stream.each_element([&](auto nodes, std::size_t, std::int32_t) { ids ^= nodes[0]; });
    benchmark::DoNotOptimize(sum);
    benchmark::DoNotOptimize(ids);
  }
  count_per_triangle(state, cell);
}
BENCHMARK(restore)->ArgName("fold")->Arg(6)->Arg(48)->Unit(benchmark::kMillisecond);

// The whole VTU document, raw, to a sink that drops it.
void restore_vtu(benchmark::State& state) {
  const SymmetryCellMesh cell = flange_cell(static_cast<std::int32_t>(state.range(0)));
  std::int64_t bytes = 0;
  for (auto _ : state) {
    const auto written =
        write_mesh(cell, MeshPart::kFull, MeshFormat::kVtu, {}, [&](std::string_view piece) {
          bytes += static_cast<std::int64_t>(piece.size());
          return true;
        });
    if (!written) state.SkipWithError(written.error().message.c_str());
  }
  state.SetBytesProcessed(bytes);
  count_per_triangle(state, cell);
}
BENCHMARK(restore_vtu)->ArgName("fold")->Arg(6)->Arg(48)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace symcell::bench
