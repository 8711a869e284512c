#include "api/formats/model_reader.hpp"
#include "tests/fuzz/check_outcome.hpp"

// From the bytes of a model to a checked mesh, with a small budget.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace symcell;
  if (size > 20'000) return 0;
  const auto model = read_model(fuzz::text_of(data, size), std::nullopt);
  if (!model) return 0;
  MeshOptions options;
  options.min_angle_deg = 20;
  fuzz::mesh_and_check(*model, options, 2'000, 2, {});
  return 0;
}
