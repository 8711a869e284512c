#include "server/cli/distinct_files.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <map>
#include <system_error>
#include <utility>

namespace symcell::cli {
namespace {

// Equal for two names of one file; empty where nothing can be lost.
std::string identity_of(const std::string& path, int standard_stream) {
  struct stat status {};
  const bool streams = path == "-";
  const bool exists =
      streams ? fstat(standard_stream, &status) == 0 : stat(path.c_str(), &status) == 0;
  if (exists) {
    if (!S_ISREG(status.st_mode) && !S_ISFIFO(status.st_mode)) return {};
    return std::to_string(status.st_dev) + ":" + std::to_string(status.st_ino);
  }
  if (streams) return {};
  // Relative to nothing where not even the first folder exists, unless made absolute before.
  std::error_code failed;
  const auto whole =
      std::filesystem::weakly_canonical(std::filesystem::absolute(path, failed), failed);
  return failed ? path : whole.lexically_normal().string();
}

}  // namespace

Result<void> check_distinct(const std::vector<NamedFile>& inputs,
                            const std::vector<NamedFile>& outputs) {
  std::map<std::string, const NamedFile*> known;
  for (const NamedFile& input : inputs) {
    if (input.path.empty()) continue;
    const std::string identity = identity_of(input.path, STDIN_FILENO);
    if (!identity.empty()) known.emplace(identity, &input);
  }
  bool streams = false;
  for (const NamedFile& output : outputs) {
    if (output.path.empty()) continue;
    if (output.path == "-" && std::exchange(streams, true)) {
      return fail(ErrorCode::kBadOption, "only one output can go to standard output");
    }
    const std::string identity = identity_of(output.path, STDOUT_FILENO);
    if (identity.empty()) continue;
    const auto [other, is_new] = known.emplace(identity, &output);
    if (is_new) continue;
    return fail(ErrorCode::kBadOption,
                output.role + " and " + other->second->role + " are the same file, " +
                    (output.path == "-" ? other->second->path : output.path) +
                    "; one would take the other's place");
  }
  return {};
}

}  // namespace symcell::cli
