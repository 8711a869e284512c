#include "api/formats/stl.hpp"
#include "tests/fuzz/surface_fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace symcell;
  fuzz::check_surface(read_stl(fuzz::text_of(data, size)), size);
  return 0;
}
