#include "server/jobs/job_files.hpp"

#include <string>
#include <system_error>
#include <utility>

#include "server/base/directory.hpp"
#include "server/base/files.hpp"
#include "server/base/identifiers.hpp"
#include "server/jobs/staged_model.hpp"

namespace symcell::server {
namespace fs = std::filesystem;

JobFiles::JobFiles(fs::path data_directory, bool shared)
    : root_(std::move(data_directory)), shared_(shared) {
  const Directory root(root_);
  // Each throws where the name is taken by a link.
  static_cast<void>(root.folder("jobs"));
  static_cast<void>(root.folder("incoming"));
}

fs::path JobFiles::incoming() const {
  return root_ / "incoming" / make_random_hex();
}

void JobFiles::adopt_model(const fs::path& arrived, std::string_view id) const {
  const fs::path staged = staged_folder(*this, id);
  fs::create_directory(staged);
  rename_durably(arrived, staged / "model");
  sync_directory(root_ / "jobs");
}

fs::path JobFiles::cell(const Job& job) const {
  if (!shared_) return cell(job.id);
  return cell(job.id) += "." + std::to_string(job.attempt);
}

fs::path JobFiles::statistics(const Job& job) const {
  if (!shared_) return statistics(job.id);
  return JobFiles::job(job.id) / ("statistics." + std::to_string(job.attempt) + ".json");
}

void JobFiles::remove_model(std::string_view id) const noexcept {
  std::error_code ignored;
  fs::remove(model(id), ignored);
}

void JobFiles::remove(std::string_view id) const noexcept {
  try {
    std::error_code ignored;
    fs::remove_all(job(id), ignored);
  } catch (...) {
    // Out of memory for a path: the sweep at the next start removes the folder.
  }
}

}  // namespace symcell::server
