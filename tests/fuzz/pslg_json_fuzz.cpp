#include "api/formats/pslg_json.hpp"
#include "tests/fuzz/fuzz_support.hpp"

// What is read and written reads back alike.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace symcell;
  const auto model = read_pslg_json(fuzz::text_of(data, size));
  if (!model) {
    fuzz::require_good_message(model.error());
    return 0;
  }
  const auto back = read_pslg_json(write_pslg_json(*model));
  fuzz::require(back.has_value(), "what was written can be read");
  fuzz::require(back->vertices == model->vertices && back->segments == model->segments &&
                    back->holes == model->holes && back->regions == model->regions,
                "writing and reading changes nothing");
  return 0;
}
