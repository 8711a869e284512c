#include "api/formats/model_reader.hpp"
#include "api/schema/statistics_json.hpp"
#include "core/mesh_model.hpp"
#include "tests/fuzz/fuzz_support.hpp"

// From the bytes of a solid to its inspection and to a coarse mesh, with a small budget: a result,
// or an error that is not ours.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace symcell;
  if (size > 20'000) return 0;
  const auto model = read_model(fuzz::text_of(data, size), std::nullopt);
  if (!model || is_planar(kind_of(*model))) return 0;
  MeshOptions options;
  options.max_elements = 5'000;
  options.time_limit_s = 5;
  const auto in_time = [&](ExecutionContext& context) {
    context.set_time_limit(options.time_limit_s);
    context.set_max_elements(options.max_elements);
  };
  ExecutionContext looking;
  in_time(looking);
  const auto inspection = inspect_model(*model, options, looking);
  if (!inspection) {
    fuzz::require_good_message(inspection.error());
  } else {
    fuzz::require(inspection_to_json(*inspection).dump().size() > 2, "a document can be written");
  }
  ExecutionContext meshing;
  in_time(meshing);
  const auto outcome = mesh_model(*model, options, meshing);
  if (!outcome) {
    fuzz::require_good_message(outcome.error());
    return 0;
  }
  fuzz::require(outcome->statistics.cell.elements > 0, "a mesh has elements");
  fuzz::require(outcome->statistics.cell.measure > 0, "and a volume");
  return 0;
}
