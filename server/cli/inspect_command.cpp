#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "api/schema/statistics_json.hpp"
#include "core/model/validate_pslg.hpp"
#include "core/symmetry/symmetrise.hpp"
#include "server/cli/commands.hpp"
#include "server/cli/interrupt.hpp"
#include "server/cli/model_input.hpp"
#include "server/cli/option_flags.hpp"
#include "server/cli/report_error.hpp"

namespace symcell::cli {
namespace {

constexpr const char* kExamples = R"(Examples:
  symcell inspect part.json
  symcell inspect part.poly --symmetry-tolerance 1e-4 | jq .fold
)";

struct InspectArguments {
  std::string model;
  bool json_errors = false;
  OptionFlags flags;
};

Result<void> inspect(const InspectArguments& arguments) {
  const Result<MeshOptions> options = arguments.flags.options();
  if (!options) return tl::unexpected(options.error());
  const Result<Pslg> model = read_model_file(arguments.model);
  if (!model) return tl::unexpected(model.error());
  ExecutionContext context;
  context.set_time_limit(options->time_limit_s);
  const InterruptCancels interrupt(context);
  if (auto valid = validate_pslg(*model, context); !valid) return valid;
  const Result<PslgInspection> found = inspect_pslg(*model, *options, context);
  if (!found) return tl::unexpected(found.error());
  std::printf("%s\n", inspection_to_json(*found).dump(2).c_str());
  if (std::fflush(stdout) != 0) {
    return fail(ErrorCode::kWriteFailed, "cannot write to standard output");
  }
  return {};
}

}  // namespace

void add_inspect_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "inspect", "Tell a model's symmetry and size as JSON on standard output; mesh nothing");
  const auto arguments = std::make_shared<InspectArguments>();
  command->add_option("MODEL", arguments->model, "PSLG JSON or Triangle .poly; - : standard input")
      ->required()
      ->option_text(" ");
  arguments->flags.add_to(*command);
  command->add_flag("--json-errors", arguments->json_errors,
                    "errors as problem documents (JSON) on standard error");
  command->footer(kExamples);
  command->callback([arguments, &exit_code] {
    const Result<void> done = inspect(*arguments);
    exit_code = done ? 0 : report_error(done.error(), arguments->json_errors);
  });
}

}  // namespace symcell::cli
