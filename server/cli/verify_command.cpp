#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/verify/verify_mesh.hpp"
#include "server/cli/commands.hpp"
#include "server/cli/model_input.hpp"
#include "server/cli/report_error.hpp"

namespace symcell::cli {
namespace {

constexpr const char* kExamples =
    R"(Without --full the full mesh is restored from the cell's own pairs and checked; its regions then
repeat with the sectors, so give --full for a model that was meshed with --ignore-markers.
Exit status: 0 all checks hold, 1 a check fails, 2 wrong usage, 3 a file is not acceptable.

Examples:
  symcell verify cell.vtu --full full.vtu --model gear.json
  symcell verify cell.vtu --model gear.json --min-angle 30
  symcell verify cell.vtu --json | jq '.checks[] | select(.status == "fail")'
)";

struct VerifyArguments {
  std::string cell;
  std::string full;
  std::string model;
  double tolerance = VerifyOptions{}.tolerance_rel;
  std::optional<double> model_tolerance;
  std::optional<double> min_angle;
  std::size_t exempt = 0;
  std::optional<std::int32_t> sector;
  std::optional<double> symmetry_tolerance;
  std::vector<double> center;
  std::string repair = "safe";
  bool curved = false;
  bool json = false;
  bool quiet = false;
  bool json_errors = false;
};

const char* status_name(Check::Status status) {
  switch (status) {
    case Check::Status::kPass: return "pass";
    case Check::Status::kFail: return "fail";
    case Check::Status::kSkip: return "skip";
  }
  return "fail";
}

void print_report(const VerifyReport& report, const VerifyArguments& arguments) {
  if (arguments.json) {
    nlohmann::ordered_json json;
    json["ok"] = report.ok();
    json["checks"] = nlohmann::ordered_json::array();
    for (const Check& c : report.checks) {
      json["checks"].push_back(
          {{"name", c.name}, {"status", status_name(c.status)}, {"detail", c.detail}});
    }
    std::printf("%s\n", json.dump(2).c_str());
    return;
  }
  for (const Check& c : report.checks) {
    if (arguments.quiet && c.status != Check::Status::kFail) continue;
    std::printf("%s  %-20s %s\n", status_name(c.status), c.name.c_str(), c.detail.c_str());
  }
  if (!arguments.quiet) std::printf("%s\n", report.ok() ? "all checks hold" : "NOT VALID");
}

Result<bool> verify(const VerifyArguments& arguments) {
  Result<MeshData> cell = read_mesh_file(arguments.cell);
  if (!cell) return error_of(cell);
  std::optional<MeshData> full;
  if (!arguments.full.empty()) {
    Result<MeshData> read = read_mesh_file(arguments.full);
    if (!read) return error_of(read);
    full = std::move(*read);
  }
  std::optional<Model> model;
  VerifyOptions options;
  options.tolerance_rel = arguments.tolerance;
  options.model_tolerance_rel = arguments.model_tolerance;
  options.min_angle_deg = arguments.min_angle;
  options.exempt_elements = arguments.exempt;
  options.symmetry_tolerance_rel = arguments.symmetry_tolerance;
  options.sector = arguments.sector;
  if (arguments.center.size() == 2) options.center = {arguments.center[0], arguments.center[1]};
  options.repair = arguments.repair == "all"    ? Repair::kAll
                   : arguments.repair == "none" ? Repair::kNone
                                                : Repair::kSafe;
  if (!arguments.model.empty()) {
    Result<Model> read = read_model_file(arguments.model);
    if (!read) return error_of(read);
    model = std::move(*read);
  }
  const auto* surface = model ? std::get_if<TriangleSurface>(&*model) : nullptr;
  cell->curved = arguments.curved || (surface != nullptr && surface->cad_notes);
  if (full) full->curved = cell->curved;
  const VerifyReport report =
      verify_mesh(*cell, full ? &*full : nullptr, model ? &*model : nullptr, options);
  print_report(report, arguments);
  return report.ok();
}

}  // namespace

void add_verify_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "verify", "Check a cell (VTU), its full mesh and its model against each other");
  const auto arguments = std::make_shared<VerifyArguments>();
  command->add_option("CELL", arguments->cell, "the symmetry cell, .vtu; - : standard input")
      ->required()
      ->option_text(" ");
  command->add_option("--full", arguments->full, "the full mesh, .vtu")->type_name("FILE");
  command->add_option("--model", arguments->model, "the model, as it was meshed")
      ->type_name("FILE");
  command
      ->add_option("--tolerance", arguments->tolerance,
                   "of pairs and copies, a share of the diameter [1e-9]")
      ->type_name("T")
      ->check(CLI::Range(0.0, 0.1));
  command
      ->add_option("--model-tolerance", arguments->model_tolerance,
                   "of nodes against the model, a share of the diameter\n[4 times the model's own "
                   "asymmetry; STL and its like 1e-3]")
      ->type_name("T")
      ->check(CLI::Range(0.0, 0.1));
  command
      ->add_option(
          "--min-angle", arguments->min_angle,
          "planar, with --model: the bound in degrees that all angles keep but those which "
          "the model forces")
      ->type_name("DEG")
      ->check(CLI::Range(0.0, kMaxMinAngleDeg));
  command
      ->add_option("--exempt", arguments->exempt,
                   "so many elements of the cell may be beyond bounds of angle and area: what the\n"
                   "statistics count under min_edge and kept_boundary [0]")
      ->type_name("N");
  command
      ->add_option("--sector", arguments->sector,
                   "the model is one of N sectors, as it was meshed with; of solids a surface")
      ->type_name("N")
      ->check(CLI::Range(2, kMaxFold));
  command
      ->add_option("--symmetry-tolerance", arguments->symmetry_tolerance,
                   "with --sector: as it was meshed with, a share of the diameter")
      ->type_name("T")
      ->check(CLI::Range(0.0, 0.1));
  command->add_option("--center", arguments->center, "planar: the centre of the sectors [0,0]")
      ->type_name("X,Y")
      ->delimiter(',')
      ->expected(2);
  command->add_option("--repair", arguments->repair, "planar: as the model was meshed with [safe]")
      ->type_name("none|safe|all")
      ->check(CLI::IsMember({"none", "safe", "all"}));
  command->add_flag(
      "--curved", arguments->curved,
      "order 2: edges of the boundary may follow curved faces, as they do where the model\nis "
      "STEP or IGES, or was meshed with curved=true");
  command->add_flag("--json", arguments->json, "the report as JSON");
  command->add_flag("-q,--quiet", arguments->quiet, "print failures only");
  command->add_flag("--json-errors", arguments->json_errors,
                    "errors as problem documents (JSON) on standard error");
  command->footer(kExamples);
  command->callback([arguments, &exit_code] {
    const Result<bool> holds = verify(*arguments);
    exit_code = holds ? (*holds ? 0 : 1) : report_error(holds.error(), arguments->json_errors);
  });
}

}  // namespace symcell::cli
