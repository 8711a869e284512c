// The program itself: time and peak memory of `symcell mesh` with a full mesh of ten million
// triangles streamed to a file.
#include <benchmark/benchmark.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "api/formats/pslg_json.hpp"
#include "tests/bench/bench_models.hpp"

extern char** environ;

namespace symcell::bench {
namespace {

constexpr std::int32_t kFold = 48;
constexpr double kTriangles = 1e7;

class Folder {
 public:
  Folder() : path_(std::filesystem::temp_directory_path() / "symcell_bench") {
    path_ += std::to_string(getpid());
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  [[nodiscard]] std::string operator/(const char* name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

struct Child {
  int status = -1;
  rusage usage{};
};

Child run(std::vector<std::string> words) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  Child child;
  pid_t id = 0;
  if (posix_spawn(&id, arguments[0], nullptr, nullptr, arguments.data(), environ) == 0) {
    wait4(id, &child.status, 0, &child.usage);
  }
  return child;
}

void full_file(benchmark::State& state) {
  const bool plain = state.range(0) != 0;
  const Folder folder;
  const Pslg model = flange_of(kFold);
  const MeshOptions options = sized_options(model, kFold, kTriangles, plain);
  std::ofstream(folder / "model.json") << write_pslg_json(model);
  std::vector<std::string> words{SYMCELL_PROGRAM,
                                 "mesh",
                                 folder / "model.json",
                                 "--fold",
                                 std::to_string(kFold),
                                 "--max-area",
                                 std::to_string(options.max_area),
                                 "--full",
                                 folder / "full.vtu",
                                 "--stats",
                                 folder / "stats.json",
                                 "--quiet"};
  if (plain) words.emplace_back("--plain");
  Child child;
  for (auto _ : state) {
    child = run(words);
    if (child.status != 0) {
      state.SkipWithError("symcell failed");
      return;
    }
  }
  std::ifstream stats(folder / "stats.json");
  state.counters["full"] = nlohmann::json::parse(stats)["full"]["elements"].get<double>();
  state.counters["peak_mib"] = static_cast<double>(child.usage.ru_maxrss) / 1024;
  state.counters["file_mib"] =
      static_cast<double>(std::filesystem::file_size(folder / "full.vtu")) / (1 << 20);
}
BENCHMARK(full_file)->ArgName("plain")->Arg(1)->Arg(0)->Iterations(1)->UseRealTime()->Unit(
    benchmark::kMillisecond);

}  // namespace
}  // namespace symcell::bench
