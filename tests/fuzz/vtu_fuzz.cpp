#include "api/formats/vtu_reader.hpp"
#include "core/verify/verify_mesh.hpp"
#include "tests/fuzz/fuzz_support.hpp"

// Whatever can be read can be checked.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace symcell;
  const auto mesh = read_vtu(fuzz::text_of(data, size));
  if (!mesh) {
    fuzz::require(!mesh.error().message.empty(), "an error has a message");
    return 0;
  }
  VerifyOptions options;
  options.most_restored_nodes = 10'000;
  (void)verify_mesh(*mesh, nullptr, nullptr, options);
  (void)verify_mesh(*mesh, &*mesh, nullptr, options);
  return 0;
}
