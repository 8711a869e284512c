#include "server/jobs/job_files.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
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

void JobFiles::adopt_model(const fs::path& arrived, std::string_view id, bool durable) const {
  const fs::path staged = staged_folder(*this, id);
  fs::create_directory(staged);
  if (!durable) {
    fs::rename(arrived, staged / "model");
    return;
  }
  rename_durably(arrived, staged / "model");
  sync_directory(root_ / "jobs");
}

// Of the whole file system: one call instead of three for every job.
void JobFiles::synchronise() const {
  const fs::path jobs = root_ / "jobs";
  const int folder = ::open(jobs.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  const bool done = folder >= 0 && ::syncfs(folder) == 0;
  const int error = errno;
  if (folder >= 0) ::close(folder);
  if (!done) throw std::system_error(error, std::generic_category(), jobs.string());
}

// The job's folder, too, which may have got its name since anything was synchronised.
void JobFiles::synchronise_results(const Job& job) const {
  sync_file(statistics(job));
  sync_file(cell(job));
  sync_directory(JobFiles::job(job.id));
  sync_directory(root_ / "jobs");
}

bool JobFiles::restore(const FileCopy& copy) const {
  const fs::path file = job(copy.job_id) / copy.name;
  const bool as_it_was = fs::is_regular_file(fs::symlink_status(file)) &&
                         MappedFile(file, Links::kRefuse).bytes() == copy.bytes;
  fs::create_directories(file.parent_path());
  const fs::path part = partial(file);
  fs::remove(part);
  FileWriter writer(part);
  writer.write(copy.bytes);
  writer.keep();
  fs::rename(part, file);
  return !as_it_was;
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
