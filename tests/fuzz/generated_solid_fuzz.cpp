#include "api/formats/plc_json.hpp"
#include "tests/fuzz/check_outcome.hpp"
#include "tests/fuzz/generated_model.hpp"

// Solids made from the bytes: layers with tabs, ribs, pockets, walls, and facets of any outline.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace symcell;
  fuzz::ByteSource bytes(data, size);
  const auto made = fuzz::generate_solid(bytes);
  fuzz::keep_model([&] { return write_plc_json(made.geometry); });
  VerifyOptions checks;
  checks.model_measure = made.measure;
  fuzz::mesh_and_check(Model(made.geometry), made.options, 5'000, 10, checks);
  return 0;
}
