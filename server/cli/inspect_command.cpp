#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <variant>

#include "api/schema/options.hpp"
#include "api/schema/statistics_json.hpp"
#include "core/mesh_model.hpp"
#include "server/cli/commands.hpp"
#include "server/cli/model_input.hpp"
#include "server/cli/option_flags.hpp"
#include "server/cli/report_error.hpp"
#include "server/cli/supervised_run.hpp"

namespace symcell::cli {
namespace {

constexpr const char* kExamples = R"(Examples:
  symcell inspect part.json
  symcell inspect part.stl | jq .folds
  symcell inspect part.poly --symmetry-tolerance 1e-4 | jq .fold
)";

struct InspectArguments {
  std::string model;
  bool json_errors = false;
  OptionFlags flags;
};

// Returns the warnings.
Result<std::string> inspect(const InspectArguments& arguments,
                            MeshOptions options,
                            ExecutionContext& context) {
  const Result<Model> model = read_model_file(arguments.model, reading_for(options));
  if (!model) return error_of(model);
  const Result<MeshOptions> fitting = options_for(kind_of(*model), std::move(options));
  if (!fitting) return error_of(fitting);
  context.set_time_limit(fitting->time_limit_s);
  const Result<Inspection> found = inspect_model(*model, *fitting, context);
  if (!found) return error_of(found);
  std::printf("%s\n", inspection_to_json(*found).dump(2).c_str());
  if (std::fflush(stdout) != 0) {
    return fail(ErrorCode::kWriteFailed, "cannot write to standard output");
  }
  const auto warnings_of = [](const auto& one) { return warnings_to_json(one.warnings).dump(); };
  return std::visit(warnings_of, *found);
}

Result<void> run(const InspectArguments& arguments) {
  const Result<MeshOptions> options = arguments.flags.options();
  if (!options) return error_of(options);
  const auto warnings = run_supervised(
      [&](ExecutionContext& context) { return inspect(arguments, *options, context); },
      {.time_limit_s = options->time_limit_s, .memory_bytes = options->memory_limit_bytes});
  if (!warnings) return error_of(warnings);
  report_warnings(*warnings, arguments.json_errors);
  return {};
}

}  // namespace

void add_inspect_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "inspect", "Tell a model's symmetry and size as JSON on standard output; mesh nothing");
  const auto arguments = std::make_shared<InspectArguments>();
  command->add_option("MODEL", arguments->model, "the model, planar or solid; - : standard input")
      ->required()
      ->option_text(" ");
  arguments->flags.add_to(*command);
  command->add_flag("--json-errors", arguments->json_errors,
                    "errors as problem documents, warnings as JSON, on standard error");
  command->footer(kExamples);
  command->callback([arguments, &exit_code] {
    const Result<void> done = run(*arguments);
    exit_code = done ? 0 : report_error(done.error(), arguments->json_errors);
  });
}

}  // namespace symcell::cli
