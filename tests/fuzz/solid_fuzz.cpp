#include "api/formats/model_reader.hpp"
#include "api/schema/statistics_json.hpp"
#include "tests/fuzz/check_outcome.hpp"

// From the bytes of a solid to its inspection and to a checked coarse mesh, with a small budget.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace symcell;
  if (size > 20'000) return 0;
  const auto model = read_model(fuzz::text_of(data, size), std::nullopt);
  if (!model || is_planar(kind_of(*model))) return 0;
  constexpr std::uint64_t kMostElements = 5'000;
  constexpr double kSeconds = 5;
  ExecutionContext looking;
  looking.set_time_limit(kSeconds);
  looking.set_max_elements(kMostElements);
  const auto inspection = inspect_model(*model, {}, looking);
  if (!inspection) {
    fuzz::require_good_message(inspection.error());
  } else {
    fuzz::require(inspection_to_json(*inspection).dump().size() > 2, "a document can be written");
  }
  fuzz::mesh_and_check(*model, {}, kMostElements, kSeconds);
  return 0;
}
