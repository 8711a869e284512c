#include <nlohmann/json.hpp>

#include "api/formats/mesh_writer.hpp"
#include "api/schema/options.hpp"
#include "tests/fuzz/fuzz_support.hpp"

// The input is both a JSON object and a text for every option.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace symcell;
  const std::string text(fuzz::text_of(data, size));
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_discarded()) {
    const auto options = options_from_json(json);
    if (!options) {
      fuzz::require_good_message(options.error());
    } else {
      for (const ModelKind kind : {ModelKind::kPslg, ModelKind::kPlc, ModelKind::kSurface}) {
        const auto fitting = options_for(kind, *options);
        if (!fitting) {
          fuzz::require_good_message(fitting.error());
          continue;
        }
        const auto settings = options_to_json(*fitting, kind);
        const auto back = options_from_json(nlohmann::json(settings));
        fuzz::require(back.has_value(), "settings read back");
        fuzz::require(options_to_json(*back, kind) == settings, "and mean the same");
      }
    }
  }
  for (const OptionInfo& info : mesh_option_table()) {
    const auto options = options_from_texts({{std::string(info.name), text}});
    if (!options) fuzz::require_good_message(options.error());
  }
  (void)mesh_format_from_accept(text, 2);
  (void)mesh_format_from_accept(text, 3);
  return 0;
}
