#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "api/formats/cell_input.hpp"
#include "server/cli/commands.hpp"
#include "server/cli/mesh_outputs.hpp"
#include "server/cli/model_input.hpp"
#include "server/cli/report_error.hpp"

namespace symcell::cli {
namespace {

constexpr const char* kExamples =
    R"(CELL: JSON or VTU that symcell wrote as a cell, or the `cell` of a job in the data directory; gzip'd ones
too. JSON and a job's cell lose nothing but a rounding; packed JSON is not read. VTU has markers at nodes alone: facets get that of their nodes,
and groups have no names.

Examples:
  symcell convert cell.json --full full.msh
  symcell convert cell.json --cell cell.inp --analysis modal --material steel --support bore
  symcell convert ~/.local/state/symcell/jobs/JOB/cell --full full.vtu
)";

struct ConvertArguments {
  std::string input;
  OutputArguments meshes;
  bool json_errors = false;
};

Result<void> convert(const ConvertArguments& arguments) {
  if (arguments.meshes.cell.empty() && arguments.meshes.full.empty()) {
    return fail(ErrorCode::kBadOption, "nothing to write: give --cell, --full or both");
  }
  const Result<std::string> bytes = read_mesh_input(arguments.input);
  if (!bytes) return error_of(bytes);
  auto cell = read_cell(*bytes);
  if (!cell) {
    cell.error().message = arguments.input + ": " + cell.error().message;
    return error_of(cell);
  }
  Result<std::vector<MeshOutput>> outputs = open_outputs(arguments.meshes);
  if (!outputs) return error_of(outputs);
  for (MeshOutput& output : *outputs) {
    SYMCELL_TRY(check_mesh_output(*cell, output.part, output.format, output.options));
  }
  for (MeshOutput& output : *outputs) {
    SYMCELL_TRY(write_mesh(*cell, output.part, output.format, output.options, output.file.sink()));
    SYMCELL_TRY(output.file.commit());
  }
  return {};
}

}  // namespace

void add_convert_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "convert", "Write a cell in another format, or its full mesh, without meshing again");
  const auto arguments = std::make_shared<ConvertArguments>();
  command->add_option("CELL", arguments->input, "the cell; - : standard input")
      ->required()
      ->option_text(" ");
  add_output_flags(*command, arguments->meshes);
  command->add_flag("--json-errors", arguments->json_errors,
                    "errors as problem documents on standard error");
  command->footer(kExamples);
  command->callback([arguments, &exit_code] {
    const Result<void> done = convert(*arguments);
    exit_code = done ? 0 : report_error(done.error(), arguments->json_errors);
  });
}

}  // namespace symcell::cli
