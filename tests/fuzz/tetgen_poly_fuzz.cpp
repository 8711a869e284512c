#include "api/formats/tetgen_poly.hpp"
#include "tests/fuzz/fuzz_support.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace symcell;
  const auto text = fuzz::text_of(data, size);
  for (const TetgenForm form : {TetgenForm::kPoly, TetgenForm::kSmesh}) {
    const auto model = read_tetgen(text, form);
    if (!model) {
      fuzz::require_good_message(model.error());
      continue;
    }
    fuzz::require(model->vertices.size() <= size && model->facets.size() <= size,
                  "no more entries than bytes");
  }
  (void)poly_dimension(text);
  return 0;
}
