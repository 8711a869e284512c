#include "api/formats/dxf.hpp"
#include "tests/fuzz/fuzz_support.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace symcell;
  fuzz::require_good_drawing(read_dxf(fuzz::text_of(data, size)));
  return 0;
}
