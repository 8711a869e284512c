#include <CLI/CLI.hpp>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "api/formats/mesh_writer.hpp"
#include "core/base/execution_context.hpp"
#include "server/cli/commands.hpp"
#include "server/cli/distinct_files.hpp"
#include "server/cli/mesh_outputs.hpp"
#include "server/cli/model_input.hpp"
#include "server/cli/option_flags.hpp"
#include "server/cli/report_error.hpp"
#include "server/cli/supervised_run.hpp"

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
  std::string memory_limit;
  bool json_errors = false;
};

// In a process of its own.
Result<std::string> write_outputs(const ConvertArguments& arguments,
                                  std::vector<MeshOutput>& outputs,
                                  const ExecutionContext& context) {
  const Result<SymmetryCellMesh> cell = read_cell_file(arguments.input);
  if (!cell) return error_of(cell);
  for (const MeshOutput& output : outputs) {
    SYMCELL_TRY(check_mesh_output(*cell, output.part, output.format, output.options));
  }
  for (MeshOutput& output : outputs) {
    const Sink file = output.file.sink();
    const Sink sink = [&](std::string_view piece) { return !context.cancelled() && file(piece); };
    const auto written = write_mesh(*cell, output.part, output.format, output.options, sink);
    if (!written && context.cancelled()) {
      return fail(ErrorCode::kCancelled, "cancelled while writing; no output was left");
    }
    if (!written) return error_of(written);
  }
  return std::string();
}

Result<void> convert(const ConvertArguments& arguments) {
  if (arguments.meshes.cell.empty() && arguments.meshes.full.empty()) {
    return fail(ErrorCode::kBadOption, "nothing to write: give --cell, --full or both");
  }
  const Result<std::uint64_t> memory_bytes = memory_limit_bytes(arguments.memory_limit);
  if (!memory_bytes) return error_of(memory_bytes);
  SYMCELL_TRY(
      check_distinct({{"the cell that is read", arguments.input}},
                     {{"--cell", arguments.meshes.cell}, {"--full", arguments.meshes.full}}));
  Result<std::vector<MeshOutput>> outputs = open_outputs(arguments.meshes);
  if (!outputs) return error_of(outputs);
  const auto written = run_supervised(
      [&](ExecutionContext& context) { return write_outputs(arguments, *outputs, context); },
      {.memory_bytes = *memory_bytes});
  if (!written) return error_of(written);
  for (MeshOutput& output : *outputs) SYMCELL_TRY(output.file.commit());
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
  add_memory_limit(*command, arguments->memory_limit);
  command->add_flag("--json-errors", arguments->json_errors,
                    "errors as problem documents on standard error");
  command->footer(kExamples);
  command->callback([arguments, &exit_code] {
    const Result<void> done = convert(*arguments);
    exit_code = done ? 0 : report_error(done.error(), arguments->json_errors);
  });
}

}  // namespace symcell::cli
