// The folder that a server keeps its jobs in: whose it is, that one server alone uses it, and what
// becomes of things in it that nobody knows.
//
//   symcell-data                 the marker: an id that the database repeats
//   lock                         held while a server uses the directory
//   quarantine/<time>-<random>/  what a start found and did not know, under the names it had
// The rest is in server/jobs/job_files.hpp.
//
// Nothing is deleted because the database does not know it: a lost, emptied, damaged or older
// database costs no result, and a folder of somebody else's is refused untouched. No symbolic link
// below the directory is followed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

#include "server/base/directory.hpp"
#include "server/base/log.hpp"

namespace symcell::server {

// Another server has the directory.
class DirectoryInUse : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class DataDirectory {
 public:
  // Creates the directory, or takes it: one with our marker, one without that holds a job database
  // of ours (an earlier version wrote no marker), or an empty one. A damaged database goes to the
  // quarantine. Throws std::runtime_error: anything else, another server's lock, a database with
  // another id.
  // `shared`: by servers of one PostgreSQL database. Then nothing is locked, no database is looked at
  // here, and nothing of what lies there is put away.
  DataDirectory(const std::filesystem::path& path, Logger& logger, bool shared = false);
  ~DataDirectory();
  DataDirectory(const DataDirectory&) = delete;
  DataDirectory& operator=(const DataDirectory&) = delete;

  // Without symbolic links.
  [[nodiscard]] const std::filesystem::path& path() const { return root_->path(); }
  // What the marker and the database have in common.
  [[nodiscard]] const std::string& id() const { return id_; }

  // Removes bodies that a dead server was receiving; what has no name of ours is put in quarantine.
  void empty_incoming();

  enum class Fate : std::uint8_t { kKeep, kRemove, kUnknown };
  // Asks for the fate of every folder in jobs/. Anything there that is no folder is unknown.
  // `remove` takes away one folder.
  void sweep_jobs(const std::function<Fate(const std::string& id)>& fate,
                  const std::function<void(const std::string& id)>& remove);

 private:
  void lock();
  void settle_identity();
  void settle_shared_identity();
  void write_marker() const;
  // Puts an entry of `from`, which is the root's folder `folder` ("": the root), in quarantine.
  void put_away(const Directory& from,
                std::string_view folder,
                const std::string& name,
                std::string_view reason);
  void put_database_away(std::string_view reason);
  void tell_of_quarantine();

  Logger& logger_;
  std::unique_ptr<Directory> root_;
  std::string id_;
  int lock_descriptor_ = -1;
  bool lock_is_new_ = false;
  std::string quarantine_;  // this start's folder; empty: not needed so far
  std::size_t put_away_ = 0;
};

}  // namespace symcell::server
