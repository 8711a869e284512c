// Runs a fuzz target over the files and folders named on the command line, or, without a fuzzer,
// over random bytes:
//   generated_solid_fuzz tests/fuzz/corpus/generated_solid
//   generated_solid_fuzz --random 1000 [--seed 1] [--size 64]
// There every input has a process of its own; those that fail are left in files failing_SEED.
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <string_view>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

void run(const std::string& bytes) {
  (void)LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
}

int run_random(std::uint64_t count, std::uint64_t first, std::uint64_t size) {
  std::uint64_t failed = 0;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    std::mt19937_64 engine(seed);
    std::string bytes(1 + engine() % size, '\0');
    // Some inputs are mostly 0: plain models with a few features.
    const std::uint64_t zeros = engine() % 4;
    for (char& c : bytes) c = engine() % 4 < zeros ? '\0' : static_cast<char>(engine() % 256);
    const pid_t child = fork();
    if (child == 0) {
      if (std::getenv("SYMCELL_FUZZ_TELL") != nullptr) {
        std::fprintf(stderr, "seed %llu\n", static_cast<unsigned long long>(seed));
      }
      run(bytes);
      std::_Exit(0);
    }
    int status = 1;
    if (child > 0 && waitpid(child, &status, 0) == child && status == 0) continue;
    ++failed;
    const std::string file = "failing_" + std::to_string(seed);
    std::ofstream(file, std::ios::binary) << bytes;
    std::fprintf(stderr, "%s: status %d\n", file.c_str(), status);
  }
  std::fprintf(stderr, "%llu random inputs, %llu failed\n", static_cast<unsigned long long>(count),
               static_cast<unsigned long long>(failed));
  return count == 0 || failed > 0 ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::filesystem::path> files;
  std::uint64_t count = 0, seed = 0, size = 64;
  bool random = false;
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (argument.starts_with("--") && i + 1 < argc) {
      const std::uint64_t value = std::strtoull(argv[++i], nullptr, 10);
      if (argument == "--random") count = value, random = true;
      if (argument == "--seed") seed = value;
      if (argument == "--size") size = std::max<std::uint64_t>(value, 1);
    } else if (std::filesystem::is_directory(argv[i])) {
      for (const auto& entry : std::filesystem::directory_iterator(argv[i])) {
        files.push_back(entry.path());
      }
    } else {
      files.emplace_back(argv[i]);
    }
  }
  if (random) return run_random(count, seed, size);
  std::ranges::sort(files);
  for (const auto& file : files) {
    std::ifstream in(file, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    std::fprintf(stderr, "%s (%zu bytes)\n", file.c_str(), bytes.size());
    run(bytes);
  }
  std::fprintf(stderr, "%zu inputs replayed\n", files.size());
  return files.empty() ? 1 : 0;
}
