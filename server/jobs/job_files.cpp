#include "server/jobs/job_files.hpp"

#include <system_error>
#include <utility>

#include "server/base/files.hpp"
#include "server/base/identifiers.hpp"

namespace symcell::server {
namespace fs = std::filesystem;

JobFiles::JobFiles(fs::path data_directory) : root_(std::move(data_directory)) {
  fs::create_directories(root_ / "jobs");
  fs::create_directories(root_ / "incoming");
  for (const fs::path& folder : {root_ / "jobs", root_ / "incoming"}) {
    fs::permissions(folder, fs::perms::owner_all);
  }
}

void JobFiles::empty_incoming() const {
  for (const auto& entry : fs::directory_iterator(root_ / "incoming")) fs::remove(entry.path());
}

fs::path JobFiles::incoming() const {
  return root_ / "incoming" / make_random_hex();
}

void JobFiles::adopt_model(const fs::path& arrived, std::string_view id) const {
  fs::create_directory(job(id));
  rename_durably(arrived, model(id));
  sync_directory(root_ / "jobs");
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
