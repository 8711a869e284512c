#include "api/formats/model_reader.hpp"
#include "tests/fuzz/fuzz_support.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace symcell;
  const auto text = fuzz::text_of(data, size);
  for (const auto format : {std::optional<ModelFormat>(), std::optional(ModelFormat::kPslgJson),
                            std::optional(ModelFormat::kPoly), std::optional(ModelFormat::kSmesh),
                            std::optional(ModelFormat::kStl), std::optional(ModelFormat::kObj)}) {
    const auto model = read_model(text, format);
    if (!model) fuzz::require_good_message(model.error());
  }
  return 0;
}
