#include "server/base/fault_archive.hpp"

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>
#include <vector>

#include "api/problem.hpp"
#include "api/version.hpp"
#include "server/base/files.hpp"

namespace symcell::server {
namespace fs = std::filesystem;

namespace {

std::uintmax_t bytes_of(const fs::path& folder) {
  std::uintmax_t sum = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_regular_file()) sum += entry.file_size();
  }
  return sum;
}

}  // namespace

fs::path default_state_directory() {
  const char* state = std::getenv("XDG_STATE_HOME");
  if (state != nullptr && *state == '/') return fs::path(state) / "symcell";
  const char* home = std::getenv("HOME");
  if (home != nullptr && *home != '\0') return fs::path(home) / ".local" / "state" / "symcell";
  return {};
}

bool is_fault(ErrorCode code) {
  return code == ErrorCode::kInternal || code == ErrorCode::kWorkerCrashed;
}

std::optional<fs::path> FaultArchive::keep(std::string_view name,
                                           const fs::path& model,
                                           std::string_view options,
                                           const Error& error) const noexcept {
  fs::path target;
  try {
    const std::uintmax_t size = fs::file_size(model);
    if (size > most_bytes_) return std::nullopt;
    target = folder_ / name;
    fs::create_directories(folder_);
    fs::permissions(folder_, fs::perms::owner_all);
    fs::remove_all(target);
    make_room(size);
    fs::create_directory(target);
    fs::copy_file(model, target / "model");
    using Json = nlohmann::ordered_json;
    const Json request = {{"version", version()},
                          {"options", Json::parse(options)},
                          {"error", problem_document(error, "", "/model")}};
    FileWriter file(target / "request.json");
    file.write(request.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    file.keep();
    return target;
  } catch (...) {
    // No halves.
    std::error_code ignored;
    if (!target.empty()) fs::remove_all(target, ignored);
    return std::nullopt;
  }
}

void FaultArchive::remove(std::string_view name) const noexcept {
  try {
    std::error_code ignored;
    fs::remove_all(folder_ / name, ignored);
  } catch (...) {
    // Out of memory for a path; the case goes when its turn comes.
  }
}

void FaultArchive::make_room(std::uintmax_t bytes) const {
  struct Case {
    fs::file_time_type time;
    fs::path path;
    std::uintmax_t bytes;
  };
  std::vector<Case> cases;
  for (const auto& entry : fs::directory_iterator(folder_)) {
    if (!entry.is_directory() || entry.is_symlink()) continue;
    cases.push_back({entry.last_write_time(), entry.path(), bytes_of(entry.path())});
    bytes += cases.back().bytes;
  }
  std::ranges::sort(cases, [](const Case& a, const Case& b) {
    return a.time != b.time ? a.time < b.time : a.path < b.path;
  });
  std::size_t left = cases.size();
  for (const Case& oldest : cases) {
    if (left < most_cases_ && bytes <= most_bytes_) return;
    fs::remove_all(oldest.path);
    bytes -= oldest.bytes;
    --left;
  }
}

}  // namespace symcell::server
