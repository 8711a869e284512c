#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <array>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "api/formats/mesh_writer.hpp"
#include "api/schema/options.hpp"
#include "api/schema/statistics_json.hpp"
#include "core/base/stopwatch.hpp"
#include "core/mesh_model.hpp"
#include "server/base/fault_archive.hpp"
#include "server/base/identifiers.hpp"
#include "server/cli/atomic_output.hpp"
#include "server/cli/commands.hpp"
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
  symcell mesh nut.json --axis-origin 0,0,0 --axis-direction 0,0,1 --cell cell.vtu
  cat flange.json | symcell mesh - --max-edge 2 --full - --format json | jq .fold

Exit status: 0 done, 1 meshing failed, 2 wrong usage, 3 the model is not acceptable,
4 a limit was reached (time, memory, size).
)";

struct MeshArguments {
  std::string model;
  std::string cell;
  std::string full;
  std::string stats;
  std::string format;
  std::string encoding = "raw";
  std::string packed = "false";
  std::vector<std::pair<std::string, std::string>> deck;
  bool json_errors = false;
  bool quiet = false;
  OptionFlags flags;
};

std::uint64_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

Result<MeshFormat> output_format(const std::string& path, const std::string& format) {
  std::string name = format;
  if (name.empty() && path == "-") name = "vtu";
  if (name.empty()) name = std::filesystem::path(path).extension().string();
  if (const std::optional<MeshFormat> found = mesh_format_from_name(name)) return *found;
  const std::string whose = format.empty() ? "the ending of " + path : "--format " + format;
  return fail(ErrorCode::kBadOption,
              whose + " names no format for meshes; take " + mesh_format_list());
}

Result<WriteOptions> write_options(const MeshArguments& arguments) {
  WriteOptions options;
  for (const auto& [name, value] : arguments.deck) {
    SYMCELL_TRY(set_deck_option(options.deck, name, value));
  }
  const auto packed = packed_reals_from_name(arguments.packed);
  if (!packed) {
    return fail(ErrorCode::kBadOption,
                "--packed must be true, exact or false, not " + arguments.packed);
  }
  options.packed = *packed;
  const std::string& encoding = arguments.encoding;
  if (encoding == "zlib") options.vtu_encoding = VtuEncoding::kAppendedZlib;
  if (encoding == "ascii") {
    options.vtu_encoding = VtuEncoding::kAscii;
    options.stl_ascii = true;
  }
  if (encoding == "raw" || encoding == "zlib" || encoding == "ascii") return options;
  return fail(ErrorCode::kBadOption, "--encoding must be raw, zlib or ascii, not " + encoding);
}

struct MeshOutput {
  MeshPart part;
  MeshFormat format;
  AtomicOutput file;
};

// All outputs are opened before the work begins: a wrong path costs nothing.
class MeshRun {
 public:
  explicit MeshRun(const MeshArguments& arguments) : arguments_(arguments) {}

  Result<void> run() {
    auto done = prepare();
    if (!done) return done;
    auto warnings = run_supervised(
        [this](ExecutionContext& context) {
          context_ = &context;
          return mesh_and_write();
        },
        {.time_limit_s = options_.time_limit_s,
         .memory_bytes = options_.memory_limit_bytes,
         .progress_bar = !arguments_.quiet});
    if (!warnings) {
      keep_fault(warnings.error());
      return error_of(warnings);
    }
    done = commit();
    if (done) report_warnings(*warnings, arguments_.json_errors);
    return done;
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

  // In the child process: what it does to this object is not seen by commit(), but for the files.
  // Returns the warnings.
  Result<std::string> mesh_and_write() {
    auto outcome = mesh();
    if (!outcome) return error_of(outcome);
    auto done = write(*outcome);
    // A sink that stops for a signal looks like a failed write.
    if (!done && context_->cancelled()) {
      return fail(ErrorCode::kCancelled, "cancelled while writing; no output was left");
    }
    if (!done) return error_of(done);
    return warnings_to_json(outcome->statistics.warnings).dump();
  }

  Result<void> prepare() {
    const Result<MeshOptions> options = arguments_.flags.options();
    if (!options) return error_of(options);
    options_ = *options;
    const Result<WriteOptions> writing = write_options(arguments_);
    if (!writing) return error_of(writing);
    write_options_ = *writing;
    const std::array paths{arguments_.cell, arguments_.full, arguments_.stats};
    if (std::ranges::count(paths, std::string("-")) > 1) {
      return fail(ErrorCode::kBadOption, "only one output can go to standard output");
    }
    for (const auto& [part, path] : {std::pair{MeshPart::kCell, arguments_.cell},
                                     std::pair{MeshPart::kFull, arguments_.full}}) {
      if (path.empty()) continue;
      const Result<MeshFormat> format = output_format(path, arguments_.format);
      if (!format) return error_of(format);
      Result<AtomicOutput> file = AtomicOutput::open(path);
      if (!file) return error_of(file);
      meshes_.push_back({part, *format, std::move(*file)});
    }
    const bool deck = std::ranges::any_of(
        meshes_, [](const MeshOutput& output) { return takes_deck_options(output.format); });
    if (!deck && !arguments_.deck.empty()) {
      return fail(ErrorCode::kBadOption,
                  "--" + arguments_.deck.front().first +
                      " is for a deck: give --cell or --full as .inp, .bdf or .cdb");
    }
    for (const MeshOutput& output : meshes_) {
      SYMCELL_TRY(check_write_options(output.format, options_of(output.format)));
    }
    // With no output asked for, the figures are what one wants to see.
    const bool nothing = meshes_.empty() && arguments_.stats.empty();
    if (!nothing && arguments_.stats.empty()) return {};
    Result<AtomicOutput> file = AtomicOutput::open(nothing ? "-" : arguments_.stats);
    if (!file) return error_of(file);
    statistics_.emplace(std::move(*file));
    return {};
  }

  // What of the command line is for this format.
  [[nodiscard]] WriteOptions options_of(MeshFormat format) const {
    WriteOptions options = write_options_;
    if (!takes_deck_options(format)) options.deck = {};
    return options;
  }

  Result<MeshOutcome> mesh() {
    context_->set_time_limit(options_.time_limit_s);
    context_->set_max_elements(options_.max_elements);
    Stopwatch watch;
    const Result<Model> model = read_model_file(arguments_.model);
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
      SYMCELL_TRY(
          check_mesh_output(outcome->mesh, output.part, output.format, options_of(output.format)));
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
      auto written =
          write_mesh(outcome.mesh, output.part, output.format, options_of(output.format), sink);
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

  Result<void> commit() {
    for (MeshOutput& output : meshes_) {
      SYMCELL_TRY(output.file.commit());
    }
    return statistics_ ? statistics_->commit() : Result<void>{};
  }

  const MeshArguments& arguments_;
  Stopwatch total_;
  MeshOptions options_;
  ModelKind kind_ = ModelKind::kPslg;  // of the model, once it is read
  WriteOptions write_options_;
  std::vector<MeshOutput> meshes_;
  std::optional<AtomicOutput> statistics_;
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
  const auto add = [&](const char* name, std::string& target, const std::string& help,
                       const char* value) {
    command->add_option(name, target, help)->type_name(value)->group("Output");
  };
  add("--cell", arguments->cell, "the symmetry cell; - : standard output", "FILE");
  add("--full", arguments->full, "the full mesh, all n sectors", "FILE");
  add("--stats", arguments->stats, "the statistics, JSON; the default if no output is named",
      "FILE");
  add("--format", arguments->format, "of both meshes, whatever the endings: " + mesh_format_list(),
      "NAME");
  add("--encoding,--vtu-encoding", arguments->encoding,
      "of VTU and VTP files [raw]; of STL ascii or not", "raw|zlib|ascii");
  add("--packed", arguments->packed,
      "of JSON files: arrays in base64, coordinates in 32 bits (true) or 64 (exact) [false]",
      "true|exact|false");
  for (const DeckOptionInfo& info : deck_option_table()) {
    const std::string name(info.name);
    std::string help(info.help);
    if (!info.standard.empty()) help += " [" + std::string(info.standard) + "]";
    command
        ->add_option_function<std::string>(
            "--" + name,
            [deck = &arguments->deck, name](const std::string& value) {
              deck->emplace_back(name, value);
            },
            help)
        ->type_name(std::string(info.metavar))
        ->multi_option_policy(CLI::MultiOptionPolicy::Throw)
        ->group("Decks");
  }
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
