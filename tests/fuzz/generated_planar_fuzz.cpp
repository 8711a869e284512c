#include "api/formats/pslg_json.hpp"
#include "tests/fuzz/check_outcome.hpp"
#include "tests/fuzz/generated_model.hpp"

// Planar models made from the bytes: combs, tabs, T-junctions, narrow gaps, in rings and squares.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace symcell;
  fuzz::ByteSource bytes(data, size);
  const auto made = fuzz::generate_planar(bytes);
  fuzz::keep_model([&] { return write_pslg_json(made.geometry); });
  VerifyOptions checks;
  checks.model_measure = made.measure;
  fuzz::mesh_and_check(Model(made.geometry), made.options, 3'000, 5, checks);
  return 0;
}
