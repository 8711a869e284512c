#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "api/formats/mesh_writer.hpp"
#include "api/schema/gates.hpp"
#include "api/schema/options.hpp"
#include "api/schema/statistics_json.hpp"
#include "core/base/stopwatch.hpp"
#include "core/mesh_model.hpp"
#include "server/base/fault_archive.hpp"
#include "server/base/identifiers.hpp"
#include "server/cli/atomic_output.hpp"
#include "server/cli/commands.hpp"
#include "server/cli/distinct_files.hpp"
#include "server/cli/mesh_outputs.hpp"
#include "server/cli/mesh_report.hpp"
#include "server/cli/model_input.hpp"
#include "server/cli/option_flags.hpp"
#include "server/cli/report_error.hpp"
#include "server/cli/supervised_run.hpp"

namespace symcell::cli {
namespace {

constexpr const char* kExamples =
    R"(Formats, from the ending or --format: vtu (ParaView), json, msh (Gmsh 4.1 with the periodic
bounds), msh2 (Gmsh 2.2), decks: inp (CalculiX, Abaqus), bdf (Nastran), cdb (ANSYS); vtp (the
boundary with its groups), glb (binary glTF, to be looked at), svg (a picture, planar models), stl (the boundary, solids). Lengths, areas and volumes are in the model's own units, angles in degrees.

Examples:
  symcell mesh gear.json --cell cell.vtu --full full.vtu --stats stats.json
  symcell mesh gear.poly --fold 17 --min-angle 33 --max-area 0.1 --cell cell.msh
  symcell mesh part.stl --fold 8 --max-volume 2 --cell cell.vtu --full full.vtu
  symcell mesh flange.json --cell cell.inp --analysis modal --material steel --support bore
  symcell mesh part.stl --fail-on 'cell.min_dihedral_deg<20,warnings>0' --junit mesh.xml --cell cell.msh
  symcell mesh nut.json --axis-origin 0,0,0 --axis-direction 0,0,1 --cell cell.vtu
  cat flange.json | symcell mesh - --max-edge 2 --full - --format json | jq .fold

Exit status: 0 done, 1 meshing failed, 2 wrong usage, 3 the model is not acceptable,
4 a limit was reached (time, memory, size).
)";

struct MeshArguments {
  std::string model;
  OutputArguments meshes;
  std::string stats;
  std::string report;
  std::string junit;
  bool json_errors = false;
  bool quiet = false;
  OptionFlags flags;
};

std::uint64_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

// All outputs are opened before the work begins: a wrong path costs nothing.
class MeshRun {
 public:
  explicit MeshRun(const MeshArguments& arguments) : arguments_(arguments) {}

  Result<void> run() {
    auto done = prepare();
    if (!done) return done;
    auto made = run_supervised(
        [this](ExecutionContext& context) {
          context_ = &context;
          return mesh_and_write();
        },
        {.time_limit_s = options_.time_limit_s,
         .memory_bytes = options_.memory_limit_bytes,
         .progress_bar = !arguments_.quiet});
    if (!made) {
      keep_fault(made.error());
      // The error is told whether or not that can be written.
      static_cast<void>(write_reports(make_report(made.error(), {})));
      return error_of(made);
    }
    const auto document = nlohmann::ordered_json::parse(*made, nullptr, false);
    const MeshReport report = make_report({}, document);
    const auto accepted = check_gates(report.gates);
    done = commit(accepted.has_value());
    if (done) done = write_reports(report);
    if (done) report_warnings(report.warnings.dump(), arguments_.json_errors);
    return done ? accepted : done;
  }

 private:
  // For us to look into; a model from standard input is gone.
  void keep_fault(Error& error) const {
    const std::filesystem::path state = server::default_state_directory();
    if (!server::is_fault(error.code) || state.empty() || arguments_.model == "-") return;
    // Of which kind the model is only the child knows.
    auto options = options_to_json(options_, ModelKind::kPslg);
    options.update(options_to_json(options_, ModelKind::kPlc));
    const auto kept = server::FaultArchive(state / "faults")
                          .keep(server::make_random_hex(), arguments_.model, options.dump(), error);
    if (kept) error.message += "; the model and the options are kept in " + kept->string();
  }

  // `document`: what the child process returned; null if it failed.
  [[nodiscard]] MeshReport make_report(std::optional<Error> error,
                                       const nlohmann::ordered_json& document) {
    MeshReport report;
    report.model = arguments_.model;
    report.error = std::move(error);
    report.seconds = total_.lap() / 1000;
    if (!document.is_object()) return report;
    report.warnings = document.value("warnings", nlohmann::ordered_json::array());
    report.statistics = document.value("statistics", nlohmann::ordered_json());
    report.gates = judge(options_.fail_on, report.statistics);
    if (const auto accepted = check_gates(report.gates); !accepted) report.error = accepted.error();
    return report;
  }

  Result<void> write_reports(const MeshReport& report) {
    if (report_) {
      constexpr auto kReplace = nlohmann::ordered_json::error_handler_t::replace;
      const std::string text = report_to_json(report).dump(2, ' ', false, kReplace) + "\n";
      if (!report_->sink()(text))
        return fail(ErrorCode::kWriteFailed, "the report could not be written");
      SYMCELL_TRY(report_->commit());
    }
    if (!junit_) return {};
    if (!junit_->sink()(reports_to_junit({report}))) {
      return fail(ErrorCode::kWriteFailed, "the JUnit file could not be written");
    }
    return junit_->commit();
  }

  // In the child process: what it does to this object is not seen by commit(), but for the files.
  // Returns the warnings and the statistics.
  Result<std::string> mesh_and_write() {
    auto outcome = mesh();
    if (!outcome) return error_of(outcome);
    if (!options_.fail_on.empty()) {
      const auto judged =
          judge(options_.fail_on, statistics_to_json(outcome->statistics, options_, kind_));
      // What is not acceptable is left nowhere; its statistics are.
      if (!check_gates(judged)) meshes_.clear();
    }
    auto done = write(*outcome);
    // A sink that stops for a signal looks like a failed write.
    if (!done && context_->cancelled()) {
      return fail(ErrorCode::kCancelled, "cancelled while writing; no output was left");
    }
    if (!done) return error_of(done);
    nlohmann::ordered_json document;
    document["warnings"] = warnings_to_json(outcome->statistics.warnings);
    document["statistics"] = statistics_to_json(outcome->statistics, options_, kind_);
    return document.dump();
  }

  Result<void> prepare() {
    const Result<MeshOptions> options = arguments_.flags.options();
    if (!options) return error_of(options);
    options_ = *options;
    SYMCELL_TRY(
        check_distinct({{"the model", arguments_.model}}, {{"--cell", arguments_.meshes.cell},
                                                           {"--full", arguments_.meshes.full},
                                                           {"--stats", arguments_.stats},
                                                           {"--report", arguments_.report},
                                                           {"--junit", arguments_.junit}}));
    Result<std::vector<MeshOutput>> meshes = open_outputs(arguments_.meshes);
    if (!meshes) return error_of(meshes);
    meshes_ = std::move(*meshes);
    for (const auto& [path, file] :
         {std::pair{&arguments_.report, &report_}, {&arguments_.junit, &junit_}}) {
      if (path->empty()) continue;
      Result<AtomicOutput> opened = AtomicOutput::open(*path);
      if (!opened) return error_of(opened);
      file->emplace(std::move(*opened));
    }
    // With no output asked for, the figures are what one wants to see.
    const bool nothing = meshes_.empty() && arguments_.stats.empty() && !report_ && !junit_;
    if (!nothing && arguments_.stats.empty()) return {};
    Result<AtomicOutput> file = AtomicOutput::open(nothing ? "-" : arguments_.stats);
    if (!file) return error_of(file);
    statistics_.emplace(std::move(*file));
    return {};
  }

  Result<MeshOutcome> mesh() {
    context_->set_time_limit(options_.time_limit_s);
    context_->set_max_elements(options_.max_elements);
    Stopwatch watch;
    const Result<Model> model = read_model_file(arguments_.model, reading_for(options_));
    if (!model) return error_of(model);
    const double parse_ms = watch.lap();
    kind_ = kind_of(*model);
    const Result<MeshOptions> fitting = options_for(kind_, options_);
    if (!fitting) return error_of(fitting);
    options_ = *fitting;
    for (const MeshOutput& output : meshes_) {
      // Told by the model, but it is the command line that asks for it.
      const auto fits = check_mesh_format(output.format, is_planar(kind_) ? 2 : 3);
      if (!fits) return fail(ErrorCode::kBadOption, fits.error().message);
    }
    Result<MeshOutcome> outcome = mesh_model(*model, options_, *context_);
    if (!outcome) return outcome;
    outcome->statistics.timings_ms.parse = parse_ms;
    for (const MeshOutput& output : meshes_) {
      SYMCELL_TRY(check_mesh_output(outcome->mesh, output.part, output.format, output.options));
    }
    return outcome;
  }

  Result<void> write(MeshOutcome& outcome) {
    context_->report(Phase::kWrite, 0.99, outcome.mesh.element_count(), 1);
    Statistics::TimingsMs& timings = outcome.statistics.timings_ms;
    for (MeshOutput& output : meshes_) {
      Stopwatch watch;
      const Sink file = output.file.sink();
      const Sink sink = [&](std::string_view piece) {
        return !context_->cancelled() && file(piece);
      };
      auto written = write_mesh(outcome.mesh, output.part, output.format, output.options, sink);
      if (!written) return written;
      (output.part == MeshPart::kFull ? timings.restore : timings.write) += watch.lap();
    }
    timings.total = total_.lap();
    outcome.statistics.peak_memory_bytes =
        std::max(outcome.statistics.peak_memory_bytes, peak_memory());
    if (!statistics_) return {};
    const std::string text = statistics_to_json(outcome.statistics, options_, kind_).dump(2) + "\n";
    if (statistics_->sink()(text)) return {};
    return fail(ErrorCode::kWriteFailed, "the statistics could not be written");
  }

  Result<void> commit(bool meshes_too) {
    for (MeshOutput& output : meshes_) {
      if (!meshes_too) break;
      SYMCELL_TRY(output.file.commit());
    }
    return statistics_ ? statistics_->commit() : Result<void>{};
  }

  const MeshArguments& arguments_;
  Stopwatch total_;
  MeshOptions options_;
  ModelKind kind_ = ModelKind::kPslg;  // of the model, once it is read
  std::vector<MeshOutput> meshes_;
  std::optional<AtomicOutput> statistics_;
  std::optional<AtomicOutput> report_;
  std::optional<AtomicOutput> junit_;
  ExecutionContext* context_ = nullptr;
};

}  // namespace

void add_mesh_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "mesh", "Mesh one model: its symmetry cell, the full mesh, the statistics");
  const auto arguments = std::make_shared<MeshArguments>();
  command->add_option("MODEL", arguments->model, "the model, planar or solid; - : standard input")
      ->required()
      ->option_text(" ");
  add_output_flags(*command, arguments->meshes);
  const auto add = [&](const char* name, std::string& target, const std::string& help,
                       const char* value) {
    command->add_option(name, target, help)->type_name(value)->group("Output");
  };
  add("--stats", arguments->stats, "the statistics, JSON; the default if no output is named",
      "FILE");
  add("--report", arguments->report,
      "JSON with status, error, warnings, gates of --fail-on and statistics; written whatever "
      "happens",
      "FILE");
  add("--junit", arguments->junit, "JUnit XML: whether there is a mesh, and each gate of --fail-on",
      "FILE");
  arguments->flags.add_to(*command);
  command->add_flag("--json-errors", arguments->json_errors,
                    "errors as problem documents, warnings as JSON, on standard error");
  command->add_flag("-q,--quiet", arguments->quiet, "no progress bar");
  command->footer(kExamples);
  command->callback([arguments, &exit_code] {
    const Result<void> done = MeshRun(*arguments).run();
    exit_code = done ? 0 : report_error(done.error(), arguments->json_errors);
  });
}

}  // namespace symcell::cli
