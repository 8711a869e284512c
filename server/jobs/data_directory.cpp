#include "server/jobs/data_directory.hpp"

#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "server/base/clock.hpp"
#include "server/base/identifiers.hpp"
#include "server/jobs/sqlite_schema.hpp"

namespace symcell::server {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMarker = "symcell-data";
constexpr const char* kMarkerPart = "symcell-data.part";
constexpr std::string_view kMarkerBegin = "symcell-data 1 ";
constexpr std::size_t kMarkerBytes = 200;  // most that is read of it
constexpr const char* kLock = "lock";
constexpr const char* kDatabase = "jobs.sqlite";
constexpr std::array kDatabaseFiles{"jobs.sqlite", "jobs.sqlite-wal", "jobs.sqlite-shm",
                                    "jobs.sqlite-journal"};
// What may lie in a directory that is taken for a new one: what a first start that was cut short
// leaves, what `symcell mesh` keeps of internal errors, what a fresh file system holds.
constexpr std::array kInNewDirectory{kMarkerPart, kLock, "faults", "lost+found"};
// Each line of the log names one entry; beyond this many, a last line tells how many there were.
constexpr std::size_t kMostLinesOfQuarantine = 20;

// Creates the folder, for its owner alone; links in the path are resolved, once.
fs::path make_root(const fs::path& path) {
  if (!fs::exists(path)) {
    if (path.has_parent_path()) fs::create_directories(path.parent_path());
    fs::create_directory(path);
    fs::permissions(path, fs::perms::owner_all);
  }
  return fs::canonical(path);
}

// nullopt: there is no marker.
std::optional<std::string> read_marker(const Directory& root) {
  const int file = root.open_file(kMarker);
  if (file < 0) return std::nullopt;
  std::array<char, kMarkerBytes> text{};
  const ssize_t got = ::read(file, text.data(), text.size());
  ::close(file);
  std::string_view line(text.data(), got > 0 ? static_cast<std::size_t>(got) : 0);
  line = line.substr(0, line.find('\n'));
  const std::string_view id =
      line.starts_with(kMarkerBegin) ? line.substr(kMarkerBegin.size()) : std::string_view();
  if (id.empty() || !std::ranges::all_of(id, [](unsigned char c) { return std::isxdigit(c) != 0; }))
    throw std::runtime_error((root.path() / kMarker).string() +
                             " is damaged; remove it if the directory is symcell's");
  return std::string(id);
}

void refuse_if_foreign(const Directory& root) {
  std::string found;
  for (const Directory::Entry& entry : root.entries()) {
    if (std::ranges::find(kInNewDirectory, entry.name) == kInNewDirectory.end()) {
      found = entry.name;
      break;
    }
  }
  if (found.empty()) return;
  throw std::runtime_error(root.path().string() + " holds \"" + found +
                           "\" and no job database of symcell's: it is left as it is. Give an "
                           "empty or new folder by --data-dir");
}

// Names that JobFiles::incoming gives.
bool is_name_of_a_body(const Directory::Entry& entry) {
  constexpr std::size_t kHexDigits = 16;
  return entry.kind == Directory::Kind::kFile && entry.name.size() == kHexDigits &&
         std::ranges::all_of(entry.name, [](unsigned char c) { return std::isxdigit(c) != 0; });
}

}  // namespace

DataDirectory::DataDirectory(const fs::path& path, Logger& logger, bool shared)
    : logger_(logger), root_(std::make_unique<Directory>(make_root(path))) {
  if (shared) {
    settle_shared_identity();
    return;
  }
  // Looked at before anything is created: a folder that is not ours stays as it is.
  if (!read_marker(*root_) && !root_->has(kDatabase)) refuse_if_foreign(*root_);
  lock();
  try {
    settle_identity();
  } catch (...) {
    if (lock_is_new_) root_->remove_file(kLock);
    ::close(lock_descriptor_);
    throw;
  }
}

DataDirectory::~DataDirectory() {
  if (lock_descriptor_ >= 0) ::close(lock_descriptor_);
}

// Two servers on one directory would run every job twice. The lock dies with its process.
void DataDirectory::lock() {
  lock_descriptor_ = root_->open_or_create_file(kLock, lock_is_new_);
  if (::flock(lock_descriptor_, LOCK_EX | LOCK_NB) != 0) {
    ::close(lock_descriptor_);
    throw DirectoryInUse("another server uses " + root_->path().string() +
                         "; choose another --data-dir");
  }
}

void DataDirectory::settle_shared_identity() {
  if (root_->has(kDatabase)) {
    throw std::runtime_error(root_->path().string() +
                             " holds the job database of a single server; servers of a PostgreSQL "
                             "database need a folder of their own");
  }
  if (!read_marker(*root_)) {
    refuse_if_foreign(*root_);
    // Two servers may start at once: the lock makes one of them first.
    lock();
    if (!read_marker(*root_)) {
      id_ = make_random_hex() + make_random_hex();
      write_marker();
    }
    ::close(std::exchange(lock_descriptor_, -1));
  }
  id_ = *read_marker(*root_);
}

void DataDirectory::settle_identity() {
  const std::optional<std::string> marker = read_marker(*root_);
  const DatabaseFinding database = examine_job_database(root_->path() / kDatabase);
  switch (database.state) {
    case DatabaseState::kForeign:
      throw std::runtime_error((root_->path() / kDatabase).string() +
                               " is a database, but not one of symcell's jobs");
    case DatabaseState::kDamaged:
      // Without a marker nothing says that it ever was ours.
      if (!marker) {
        throw std::runtime_error(
            (root_->path() / kDatabase).string() + " is no job database: " + database.fault +
            ". If the directory is symcell's, move this file away and write \"" +
            std::string(kMarkerBegin) + make_random_hex() + "\" to " + kMarker);
      }
      put_database_away(database.fault);
      break;
    case DatabaseState::kMissing:
    case DatabaseState::kEmpty:
      if (!marker) refuse_if_foreign(*root_);
      // A log without its database would be read into the new one.
      if (database.state == DatabaseState::kMissing) put_database_away("its database is gone");
      break;
    case DatabaseState::kOurs: break;
  }
  id_ = marker ? *marker : database.directory_id;
  if (id_.empty()) id_ = make_random_hex() + make_random_hex();
  if (!database.directory_id.empty() && database.directory_id != id_) {
    throw std::runtime_error("the job database in " + root_->path().string() +
                             " belongs to another data directory (" + database.directory_id +
                             ", and here is " + id_ + "); nothing was changed");
  }
  if (!marker) {
    write_marker();
    if (database.state == DatabaseState::kOurs) logger_.info("data_directory_adopted");
  }
}

void DataDirectory::write_marker() const {
  root_->write_file(kMarker, std::string(kMarkerBegin) + id_ + "\n");
}

void DataDirectory::put_database_away(std::string_view reason) {
  for (const char* name : kDatabaseFiles) {
    if (root_->has(name)) put_away(*root_, "", name, reason);
  }
  tell_of_quarantine();
}

void DataDirectory::put_away(const Directory& from,
                             std::string_view folder,
                             const std::string& name,
                             std::string_view reason) {
  if (quarantine_.empty()) {
    std::string time = format_timestamp(now_ms()).substr(0, 19);
    std::erase(time, ':');
    quarantine_ = time + "-" + make_random_hex();
  }
  const Directory start = root_->folder("quarantine").folder(quarantine_);
  if (folder.empty()) {
    from.move(name, start, name);
  } else {
    from.move(name, start.folder(std::string(folder)), name);
  }
  if (++put_away_ > kMostLinesOfQuarantine) return;
  const std::string where = (root_->path() / folder / name).string();
  logger_.warning("quarantined",
                  {{"what", std::string_view(where)}, {"reason", reason}, {"in", quarantine_}});
}

void DataDirectory::tell_of_quarantine() {
  if (put_away_ == 0) return;
  const std::string where = (root_->path() / "quarantine" / quarantine_).string();
  logger_.error("quarantine_filled", {{"count", static_cast<std::int64_t>(put_away_)},
                                      {"folder", std::string_view(where)}});
  put_away_ = 0;
}

void DataDirectory::empty_incoming() {
  const Directory incoming = root_->folder("incoming");
  for (const Directory::Entry& entry : incoming.entries()) {
    if (is_name_of_a_body(entry)) {
      incoming.remove_file(entry.name);
    } else {
      put_away(incoming, "incoming", entry.name, "no body of a request");
    }
  }
  tell_of_quarantine();
}

void DataDirectory::sweep_jobs(const std::function<Fate(const std::string&)>& fate,
                               const std::function<void(const std::string&)>& remove) {
  const Directory jobs = root_->folder("jobs");
  for (const Directory::Entry& entry : jobs.entries()) {
    const bool is_folder = entry.kind == Directory::Kind::kFolder;
    const Fate answer = is_folder ? fate(entry.name) : Fate::kUnknown;
    if (answer == Fate::kRemove) remove(entry.name);
    if (answer != Fate::kUnknown) continue;
    put_away(jobs, "jobs", entry.name,
             is_folder ? "the database knows no such job" : "no folder of a job");
  }
  tell_of_quarantine();
}

}  // namespace symcell::server
