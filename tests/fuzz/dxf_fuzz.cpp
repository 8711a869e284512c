#include "api/formats/dxf.hpp"
#include "tests/fuzz/fuzz_support.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace symcell;
  const auto model = read_dxf(fuzz::text_of(data, size));
  if (!model) {
    fuzz::require_good_message(model.error());
    return 0;
  }
  fuzz::require(model->bulges.empty() || model->bulges.size() == model->segments.size(),
                "a bulge a segment");
  for (const PslgSegment& s : model->segments) {
    const auto count = static_cast<std::int32_t>(model->vertices.size());
    fuzz::require(s.a >= 0 && s.b >= 0 && s.a < count && s.b < count, "segments join vertices");
  }
  return 0;
}
