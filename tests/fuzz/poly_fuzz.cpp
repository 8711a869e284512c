#include "api/formats/poly.hpp"
#include "tests/fuzz/fuzz_support.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace symcell;
  const auto model = read_poly(fuzz::text_of(data, size));
  if (!model) {
    fuzz::require_good_message(model.error());
    return 0;
  }
  fuzz::require(model->vertices.size() <= size && model->segments.size() <= size,
                "no more entries than bytes");
  return 0;
}
