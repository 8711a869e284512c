// `symcell batch`: every model of a folder, several at once, each in a process of its own.
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "api/formats/model_format.hpp"
#include "api/problem.hpp"
#include "server/cli/atomic_output.hpp"
#include "server/cli/commands.hpp"
#include "server/cli/distinct_files.hpp"
#include "server/cli/mesh_report.hpp"
#include "server/cli/option_flags.hpp"
#include "server/cli/report_error.hpp"

namespace symcell::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kExamples =
    R"(Meshes every model of FOLDER, by its ending (gzip'd ones too), in name order, N at once. Of each, OUT gets
NAME.FORMAT, with --full NAME.full.FORMAT, and NAME.report.json with status, error, warnings, gates and
statistics. The table on standard output has a line a model.

Examples:
  symcell batch parts --out meshes
  symcell batch parts --out meshes --format msh --full --workers 4 --max-edge 2 --summary all.json
  symcell batch parts --out meshes --fail-on 'cell.min_dihedral_deg<15' --junit mesh.xml

Exit status: 0 all models have an acceptable mesh, 1 some have not, 2 wrong usage.
)";

struct BatchArguments {
  std::string folder;
  std::string out;
  std::string format = "vtu";
  std::string summary;
  std::string junit;
  unsigned workers = 0;
  bool full = false;
  bool recursive = false;
  bool json_errors = false;
  OptionFlags flags;
};

struct Task {
  fs::path model;
  std::string name;  // of the outputs
  MeshReport report;
};

// SIGINT, SIGTERM and word of children, held back while this lives and taken one by one: none can come between a
// look at what there is and the wait for more.
class HeldSignals {
 public:
  HeldSignals() {
    sigemptyset(&held_);
    for (const int signal : {SIGINT, SIGTERM, SIGCHLD}) sigaddset(&held_, signal);
    // Whoever ignores it has no word of children, and this process may have been made to.
    std::signal(SIGCHLD, SIG_DFL);
    ::pthread_sigmask(SIG_BLOCK, &held_, &before_);
  }
  ~HeldSignals() {
    // Some send two at once; the second must not end the program before it has told what was done.
    const timespec at_once{};
    while (::sigtimedwait(&held_, nullptr, &at_once) > 0) {
    }
    ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  HeldSignals(const HeldSignals&) = delete;
  HeldSignals& operator=(const HeldSignals&) = delete;

  // Waits for one of them; true: the batch is to stop.
  [[nodiscard]] bool wait() const {
    const int signal = ::sigwaitinfo(&held_, nullptr);
    return signal == SIGINT || signal == SIGTERM;
  }
  // For a child, which has them as the program had.
  void release() const { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

 private:
  sigset_t held_{};
  sigset_t before_{};
};

class Batch {
 public:
  explicit Batch(const BatchArguments& arguments) : arguments_(arguments) {}

  // Whether all models have an acceptable mesh.
  Result<bool> run() {
    SYMCELL_TRY(arguments_.flags.options());
    SYMCELL_TRY(find_models());
    SYMCELL_TRY(check_files());
    std::error_code error;
    fs::create_directories(arguments_.out, error);
    if (error) {
      return fail(ErrorCode::kWriteFailed,
                  "cannot make the folder " + arguments_.out + ": " + error.message());
    }
    print_head();
    run_all();
    SYMCELL_TRY(write_summaries());
    const auto bad =
        std::ranges::count_if(tasks_, [](const Task& t) { return t.report.error.has_value(); });
    std::printf("%zu models, %td without an acceptable mesh\n", tasks_.size(), bad);
    if (stopped_) return fail(ErrorCode::kCancelled, "stopped by a signal");
    return bad == 0;
  }

 private:
  Result<void> find_models() {
    std::error_code error;
    if (fs::equivalent(arguments_.folder, arguments_.out, error)) {
      return fail(ErrorCode::kBadOption,
                  "--out must be another folder than that of the models: reports and meshes would "
                  "be taken for models the next time");
    }
    const auto add = [this](const fs::directory_entry& entry) {
      if (!entry.is_regular_file() || !model_format_from_name(entry.path().string())) return;
      tasks_.push_back({entry.path(), {}, {}});
    };
    if (arguments_.recursive) {
      for (fs::recursive_directory_iterator it(arguments_.folder, error), end; !error && it != end;
           it.increment(error)) {
        // What earlier batches have left there.
        std::error_code not_there;
        if (it->is_directory(not_there) && fs::equivalent(it->path(), arguments_.out, not_there)) {
          it.disable_recursion_pending();
        }
        add(*it);
      }
    } else {
      for (fs::directory_iterator it(arguments_.folder, error), end; !error && it != end;
           it.increment(error)) {
        add(*it);
      }
    }
    if (error) {
      return fail(ErrorCode::kUnreadable,
                  "cannot read the folder " + arguments_.folder + ": " + error.message());
    }
    if (tasks_.empty()) {
      return fail(ErrorCode::kUnreadable,
                  "no model in " + arguments_.folder +
                      ": none of its files has the ending of a format that is read" +
                      (arguments_.recursive ? "" : "; --recursive looks into folders within"));
    }
    std::ranges::sort(tasks_, {}, &Task::model);
    std::map<std::string, int> uses;
    for (Task& t : tasks_) {
      const std::string path = fs::relative(t.model, arguments_.folder).generic_string();
      t.report.model = path;
      for (const char c : path) t.name += c == '/' ? '_' : c;
      const int use = ++uses[t.name];
      if (use > 1) t.name += "-" + std::to_string(use);
    }
    return {};
  }

  // Models may be links to what lies in OUT, and a summary may be named like a model.
  [[nodiscard]] Result<void> check_files() const {
    std::vector<NamedFile> models;
    std::vector<NamedFile> outputs;
    for (const Task& t : tasks_) {
      models.push_back({"the model " + t.report.model, t.model.string()});
      std::vector<std::string> endings{"." + arguments_.format, ".report.json"};
      if (arguments_.full) endings.push_back(".full." + arguments_.format);
      for (const std::string& ending : endings) {
        outputs.push_back({"an output of " + t.report.model, output(t, ending)});
      }
    }
    outputs.push_back({"--summary", arguments_.summary});
    outputs.push_back({"--junit", arguments_.junit});
    return check_distinct(models, outputs);
  }

  [[nodiscard]] std::string output(const Task& task, const std::string& ending) const {
    return (fs::path(arguments_.out) / (task.name + ending)).string();
  }

  // Returns the process; -1: none could be had.
  [[nodiscard]] pid_t start(const Task& task, const HeldSignals& signals) const {
    std::vector<std::string> words{"symcell",
                                   "mesh",
                                   fs::absolute(task.model).string(),
                                   "--quiet",
                                   "--format",
                                   arguments_.format,
                                   "--cell",
                                   output(task, "." + arguments_.format),
                                   "--report",
                                   output(task, ".report.json")};
    if (arguments_.full) {
      words.emplace_back("--full");
      words.push_back(output(task, ".full." + arguments_.format));
    }
    for (const auto& [name, value] : arguments_.flags.given()) {
      std::string flag = "--" + name;
      std::ranges::replace(flag, '_', '-');
      if (!value.empty()) flag.append("=").append(value);
      words.push_back(std::move(flag));
    }
    std::vector<char*> argv;
    argv.reserve(words.size() + 1);
    for (std::string& w : words) argv.push_back(w.data());
    argv.push_back(nullptr);
    std::fflush(nullptr);
    const pid_t child = ::fork();
    if (child != 0) return child;
    signals.release();
    const int null = ::open("/dev/null", O_RDWR);
    // What it has to say stands in its report.
    ::dup2(null, STDOUT_FILENO);
    ::dup2(null, STDERR_FILENO);
    ::execv("/proc/self/exe", argv.data());
    ::_exit(127);
  }

  // Ctrl-C ends the batch: the children get it, too, and no more are started.
  void run_all() {
    const HeldSignals signals;
    const std::size_t workers = arguments_.workers > 0
                                    ? arguments_.workers
                                    : std::max(1U, std::thread::hardware_concurrency());
    begin_.resize(tasks_.size());
    std::map<pid_t, std::size_t> running;
    std::size_t next = 0;
    while (true) {
      reap(running);
      while (!stopped_ && next < tasks_.size() && running.size() < workers) {
        begin(next++, signals, running);
      }
      if (running.empty()) break;
      if (!signals.wait()) continue;
      stopped_ = true;
      for (const auto& [child, task] : running) ::kill(child, SIGTERM);
    }
    for (; next < tasks_.size(); ++next) {
      tasks_[next].report.error = Error{ErrorCode::kCancelled, "not begun", {}, {}};
    }
  }

  void begin(std::size_t task, const HeldSignals& signals, std::map<pid_t, std::size_t>& running) {
    begin_[task] = std::chrono::steady_clock::now();
    // Of an earlier run.
    std::error_code ignored;
    fs::remove(output(tasks_[task], ".report.json"), ignored);
    const pid_t child = start(tasks_[task], signals);
    if (child >= 0) {
      running[child] = task;
      return;
    }
    tasks_[task].report.error =
        Error{ErrorCode::kInternal, "a process could not be started", {}, {}};
    print(tasks_[task]);
  }

  // Takes in what those have to tell that have ended; one word may stand for several.
  void reap(std::map<pid_t, std::size_t>& running) {
    int status = 0;
    for (pid_t ended = 0; (ended = ::waitpid(-1, &status, WNOHANG)) > 0;) {
      const auto found = running.find(ended);
      if (found == running.end()) continue;
      Task& task = tasks_[found->second];
      read_report(task);
      const auto took = std::chrono::steady_clock::now() - begin_[found->second];
      task.report.seconds = std::chrono::duration<double>(took).count();
      print(task);
      running.erase(found);
    }
  }

  void read_report(Task& task) const {
    std::ifstream file(output(task, ".report.json"));
    const Json json = Json::parse(file, nullptr, false);
    if (!json.is_object()) {
      task.report.error = Error{ErrorCode::kWorkerCrashed, "the process left no report", {}, {}};
      return;
    }
    task.report.warnings = json.value("warnings", Json::array());
    task.report.statistics = json.value("statistics", Json());
    for (const Json& g : json.value("gates", Json::array())) {
      task.report.gates.push_back(
          {g.value("gate", ""), !g.value("passed", false), g.value("detail", "")});
    }
    const Json error = json.value("error", Json());
    if (!error.is_object()) return;
    const std::string code = error.value("code", "internal");
    const auto row = std::ranges::find_if(problem_table(), [&](const ProblemRow& known) {
      return error_code_name(known.code) == code;
    });
    task.report.error = Error{row != problem_table().end() ? row->code : ErrorCode::kInternal,
                              error.value("detail", ""),
                              {},
                              {}};
  }

  static void print_head() {
    std::printf("%-36s %-7s %5s %9s %10s %6s %9s %7s\n", "model", "status", "fold", "elements",
                "of full", "least", "warnings", "seconds");
  }

  // The smallest angle is that of triangles, of tetrahedra the dihedral one.
  static void print(const Task& task) {
    const MeshReport& r = task.report;
    const std::string status = report_status(r);
    std::printf("%-36s %-7s", r.model.c_str(), status.c_str());
    if (r.statistics.is_object()) {
      const Json& cell = r.statistics["cell"];
      const bool planar = cell.contains("area");
      std::printf(" %5d %9llu %10llu %6.1f %9zu", r.statistics["symmetry"].value("fold", 0),
                  static_cast<unsigned long long>(cell.value("elements", 0ULL)),
                  static_cast<unsigned long long>(r.statistics["full"].value("elements", 0ULL)),
                  cell.value(planar ? "min_angle_deg" : "min_dihedral_deg", 0.0),
                  r.warnings.size());
    } else {
      std::printf(" %5s %9s %10s %6s %9s", "-", "-", "-", "-", "-");
    }
    std::printf(" %7.1f", r.seconds);
    if (r.error) std::printf("  %s", r.error->message.substr(0, 120).c_str());
    std::printf("\n");
    std::fflush(stdout);
  }

  static Result<void> write_text(const std::string& path, const std::string& text) {
    Result<AtomicOutput> file = AtomicOutput::open(path);
    if (!file) return error_of(file);
    if (!file->sink()(text)) {
      return fail(ErrorCode::kWriteFailed,
                  "cannot write " + path + ": " + std::generic_category().message(errno));
    }
    return file->commit();
  }

  [[nodiscard]] Result<void> write_summaries() const {
    if (!arguments_.summary.empty()) {
      Json all = Json::array();
      for (const Task& t : tasks_) all.push_back(report_to_json(t.report));
      constexpr auto kReplace = Json::error_handler_t::replace;
      SYMCELL_TRY(write_text(arguments_.summary, all.dump(2, ' ', false, kReplace) + "\n"));
    }
    if (arguments_.junit.empty()) return {};
    std::vector<MeshReport> reports;
    for (const Task& t : tasks_) reports.push_back(t.report);
    return write_text(arguments_.junit, reports_to_junit(reports));
  }

  const BatchArguments& arguments_;
  std::vector<Task> tasks_;
  std::vector<std::chrono::steady_clock::time_point> begin_;  // of each task
  bool stopped_ = false;
};

}  // namespace

void add_batch_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("batch", "Mesh every model of a folder, several at once; a summary table");
  const auto arguments = std::make_shared<BatchArguments>();
  command->add_option("FOLDER", arguments->folder, "the folder with the models")
      ->required()
      ->option_text(" ");
  const auto add = [&](const char* name, auto& target, const char* help, const char* value) {
    return command->add_option(name, target, help)->type_name(value)->group("Output");
  };
  add("--out", arguments->out, "the folder for meshes and reports; it is made", "FOLDER")
      ->required();
  add("--format", arguments->format, "of the meshes [vtu]", "NAME");
  command->add_flag("--full", arguments->full, "the full meshes, too")->group("Output");
  add("--summary", arguments->summary, "all reports in one JSON list", "FILE");
  add("--junit", arguments->junit, "JUnit XML: a test suite a model, with the gates of --fail-on",
      "FILE");
  command->add_option("--workers", arguments->workers, "models at once [processors]")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
  command->add_flag("-r,--recursive", arguments->recursive, "look into folders within, too");
  arguments->flags.add_to(*command);
  command->add_flag("--json-errors", arguments->json_errors,
                    "errors as problem documents on standard error");
  command->footer(kExamples);
  command->callback([arguments, &exit_code] {
    const Result<bool> good = Batch(*arguments).run();
    exit_code = good ? (*good ? 0 : 1) : report_error(good.error(), arguments->json_errors);
  });
}

}  // namespace symcell::cli
