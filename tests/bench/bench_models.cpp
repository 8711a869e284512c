#include "tests/bench/bench_models.hpp"

#include <cstdio>
#include <cstdlib>

#include "core/plane/symmetry/symmetrise.hpp"
#include "tests/support/pslg_builders.hpp"

namespace symcell::bench {
namespace {

// Mean area of a triangle as a share of the bound, measured.
constexpr double kMeanAreaPlain = 0.635;
constexpr double kMeanArea = 0.83;

template <class T>
T value_of(Result<T> result) {
  if (!result) {
    std::fprintf(stderr, "%s\n", result.error().message.c_str());
    std::abort();
  }
  return std::move(*result);
}

}  // namespace

Pslg flange_of(std::int32_t fold) {
  return flange(fold, 10, 7, 12.0 / (6 + fold), 3);
}

MeshOptions sized_options(const Pslg& model, std::int32_t fold, double triangles, bool plain) {
  ExecutionContext context;
  MeshOptions options;
  options.fold = fold;
  options.plain = plain;
  const double area = value_of(plane::inspect_pslg(model, options, context)).area;
  options.max_area = area / (triangles * (plain ? kMeanAreaPlain : kMeanArea));
  return options;
}

MeshOutcome mesh(const Pslg& model, const MeshOptions& options) {
  ExecutionContext context;
  return value_of(mesh_model(model, options, context));
}

}  // namespace symcell::bench
