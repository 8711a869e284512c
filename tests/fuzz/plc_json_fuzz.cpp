#include "api/formats/plc_json.hpp"
#include "tests/fuzz/fuzz_support.hpp"

// What is read and written reads back alike.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace symcell;
  const auto text = fuzz::text_of(data, size);
  const auto model = read_plc_json(text);
  const bool other_kind = json_model_kind(text) != ModelKind::kPlc;
  if (!model) {
    fuzz::require_good_message(model.error());
    return 0;
  }
  fuzz::require(!other_kind, "what can be read is recognised as such");
  const auto back = read_plc_json(write_plc_json(*model));
  fuzz::require(back.has_value(), "what was written can be read");
  fuzz::require(back->vertices == model->vertices && back->facets == model->facets &&
                    back->segments == model->segments && back->holes == model->holes &&
                    back->regions == model->regions,
                "writing and reading changes nothing");
  return 0;
}
