#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/formats/byte_order_mark.hpp"
#include "api/formats/mesh_writer.hpp"
#include "api/formats/nodal_results.hpp"
#include "core/base/execution_context.hpp"
#include "core/model/describe.hpp"
#include "server/cli/atomic_output.hpp"
#include "server/cli/commands.hpp"
#include "server/cli/distinct_files.hpp"
#include "server/cli/model_input.hpp"
#include "server/cli/option_flags.hpp"
#include "server/cli/report_error.hpp"
#include "server/cli/supervised_run.hpp"

namespace symcell::cli {
namespace {

// Results have six digits; more is no wave of one nodal diameter.
constexpr double kMostMismatch = 1e-2;

constexpr const char* kExamples =
    R"(RESULTS: a CalculiX .frd of the cell's deck (ASCII, *NODE FILE, U), or a VTU of the cell with a point
array. In sector s of the full mesh the vectors are those of the cell turned by s sectors, times
exp(i k 2 pi s / n); k, the nodal diameter and its direction, is that of the file, else the one that
the nodes of the bounds agree with.

Examples:
  symcell mesh flange.stl --cell cell.inp --analysis modal --material steel --support bore
  symcell convert cell.json --cell cell.inp --analysis modal --material steel && ccx cell
  symcell transfer cell.frd --cell cell.json --list
  symcell transfer cell.frd --cell cell.json --result 5 --full mode5.vtu
  symcell transfer cell.vtu --cell cell.json --array U --imaginary UI --nodal-diameter 2 --full mode.vtu
)";

struct TransferArguments {
  std::string results;
  std::string cell;
  std::string full;
  std::string array;
  std::string imaginary;
  std::size_t result = 1;
  std::optional<std::int32_t> nodal_diameter;
  double phase_deg = 0;
  std::string encoding = "raw";
  std::string memory_limit;
  bool list = false;
  bool json_errors = false;
};

bool is_xml(std::string_view bytes) {
  const std::string_view text = without_byte_order_mark(bytes);
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  return begin != std::string_view::npos && text[begin] == '<';
}

Result<std::vector<NodalResult>> read_results(const TransferArguments& arguments,
                                              std::size_t nodes) {
  const Result<std::string> bytes = read_mesh_input(arguments.results);
  if (!bytes) return error_of(bytes);
  if (arguments.array.empty() && is_xml(*bytes)) {
    return fail(ErrorCode::kBadOption,
                "this is no .frd; if it is a VTU, name its point array with the vectors by --array "
                "NAME, and that with their imaginary parts by --imaginary NAME");
  }
  if (arguments.array.empty()) return read_frd(*bytes, nodes);
  auto one = read_vtu_result(*bytes, nodes, arguments.array, arguments.imaginary);
  if (!one) return error_of(one);
  return std::vector<NodalResult>{std::move(*one)};
}

// In a process of its own. `file`: null to list what there is.
Result<std::string> transfer(const TransferArguments& arguments,
                             AtomicOutput* file,
                             const ExecutionContext& context) {
  const Result<SymmetryCellMesh> cell = read_cell_file(arguments.cell);
  if (!cell) return error_of(cell);
  auto results = read_results(arguments, cell->nodes.size());
  if (!results) {
    results.error().message = arguments.results + ": " + results.error().message;
    return error_of(results);
  }
  const auto diameter_of = [&](const NodalResult& r) {
    return find_nodal_diameter(
        *cell, r, arguments.nodal_diameter ? arguments.nodal_diameter : r.nodal_diameter);
  };
  if (file == nullptr) {
    std::printf("%6s %-10s %14s %14s %10s\n", "result", "name", "value", "nodal diameter",
                "mismatch");
    for (std::size_t i = 0; i < results->size(); ++i) {
      const NodalResult& r = (*results)[i];
      const NodalDiameter k = diameter_of(r);
      std::printf("%6zu %-10s %14.6g %14d %10.2g\n", i + 1, r.name.c_str(), r.value,
                  k.signed_diameter, k.mismatch);
    }
    return std::string();
  }
  if (arguments.result < 1 || arguments.result > results->size()) {
    return fail(ErrorCode::kBadOption, "--result must be from 1 to " +
                                           std::to_string(results->size()) +
                                           ": the file has no more; --list shows them");
  }
  const NodalResult& chosen = (*results)[arguments.result - 1];
  const NodalDiameter k = diameter_of(chosen);
  if (k.mismatch > kMostMismatch) {
    return fail(
        ErrorCode::kUnsupportedModel,
        "the nodes of the bounds do not fit nodal diameter " +
            std::to_string(std::abs(k.signed_diameter)) + ": they differ by " +
            describe_rounded(k.mismatch) +
            " of the largest vector; is an imaginary part missing, or are the results of another "
            "cell?");
  }
  // The parser takes no other name.
  const VtuEncoding encoding =
      vtu_encoding_from_name(arguments.encoding).value_or(VtuEncoding::kAppendedRaw);
  const Sink whole = file->sink();
  const Sink sink = [&](std::string_view piece) { return !context.cancelled() && whole(piece); };
  const auto written = write_full_result(*cell, chosen, k.signed_diameter,
                                         arguments.phase_deg * std::numbers::pi / 180,
                                         "displacement", encoding, sink);
  if (!written && context.cancelled()) {
    return fail(ErrorCode::kCancelled, "cancelled while writing; no output was left");
  }
  if (!written) return error_of(written);
  return std::string();
}

Result<void> run(const TransferArguments& arguments) {
  const Result<std::uint64_t> memory_bytes = memory_limit_bytes(arguments.memory_limit);
  if (!memory_bytes) return error_of(memory_bytes);
  std::optional<AtomicOutput> file;
  if (!arguments.list) {
    if (arguments.full.empty()) {
      return fail(ErrorCode::kBadOption, "give --full FILE.vtu for the result, or --list");
    }
    SYMCELL_TRY(check_distinct(
        {{"the results that are read", arguments.results}, {"--cell", arguments.cell}},
        {{"--full", arguments.full}}));
    Result<AtomicOutput> opened = AtomicOutput::open(arguments.full);
    if (!opened) return error_of(opened);
    file.emplace(std::move(*opened));
  }
  const auto done = run_supervised(
      [&](ExecutionContext& context) {
        return transfer(arguments, file ? &*file : nullptr, context);
      },
      {.memory_bytes = *memory_bytes});
  if (!done) return error_of(done);
  return file ? file->commit() : Result<void>{};
}

}  // namespace

void add_transfer_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "transfer", "Take nodal results of a cell, as modes, to the full mesh (VTU)");
  const auto arguments = std::make_shared<TransferArguments>();
  command
      ->add_option("RESULTS", arguments->results,
                   "what the solver wrote: .frd, or VTU with --array")
      ->required()
      ->option_text(" ");
  command->add_option("--cell", arguments->cell, "the cell, JSON, VTU or of a job")
      ->type_name("FILE")
      ->required();
  command
      ->add_option("--full", arguments->full,
                   "the full mesh with `displacement`, .vtu; - : standard output")
      ->type_name("FILE");
  command->add_option("--result", arguments->result, "which of the file's results [1]")
      ->type_name("N");
  command->add_flag("--list", arguments->list, "what results there are, and their nodal diameters");
  command->add_option("--nodal-diameter", arguments->nodal_diameter, "if the file does not say it")
      ->type_name("K")
      ->check(CLI::Range(0, 30000));
  command
      ->add_option("--phase", arguments->phase_deg, "degrees of the vibration that are shown [0]")
      ->type_name("DEG");
  command->add_option("--array", arguments->array, "VTU: the point array with the vectors")
      ->type_name("NAME");
  command->add_option("--imaginary", arguments->imaginary, "VTU: that with their imaginary parts")
      ->type_name("NAME");
  command->add_option("--encoding", arguments->encoding, "of the VTU file [raw]")
      ->type_name("raw|zlib|ascii")
      ->check(CLI::IsMember({"raw", "zlib", "ascii"}));
  add_memory_limit(*command, arguments->memory_limit);
  command->add_flag("--json-errors", arguments->json_errors,
                    "errors as problem documents on standard error");
  command->footer(kExamples);
  command->callback([arguments, &exit_code] {
    const Result<void> done = run(*arguments);
    exit_code = done ? 0 : report_error(done.error(), arguments->json_errors);
  });
}

}  // namespace symcell::cli
