// Which file of a job lies where under the data directory (server/jobs/data_directory.hpp).
//
//   jobs.sqlite                  the rows
//   faults/<id>/                 models of internal errors, see server/base/fault_archive.hpp
//   incoming/<random>            request bodies that are still arriving; emptied at start
//   jobs/<id>/model              as uploaded
//   jobs/<id>/cell               the compact symmetry cell (api/formats/cell_archive.hpp)
//   jobs/<id>/statistics.json
//   jobs/<id>/*.part             results that are being written
// Where servers share the folder: cell.<attempt> and statistics.<attempt>.json.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "server/jobs/job.hpp"
#include "server/jobs/job_store.hpp"

namespace symcell::server {

class JobFiles {
 public:
  // Creates the folders, readable by their owner only.
  explicit JobFiles(std::filesystem::path data_directory, bool shared = false);

  [[nodiscard]] std::filesystem::path database() const { return root_ / "jobs.sqlite"; }
  [[nodiscard]] std::filesystem::path faults() const { return root_ / "faults"; }
  // A fresh name.
  [[nodiscard]] std::filesystem::path incoming() const;
  [[nodiscard]] std::filesystem::path model(std::string_view id) const { return job(id) / "model"; }
  [[nodiscard]] std::filesystem::path cell(std::string_view id) const { return job(id) / "cell"; }
  [[nodiscard]] std::filesystem::path statistics(std::string_view id) const {
    return job(id) / "statistics.json";
  }
  // Of the job's last run. Where servers share the folder each run has files of its own: one that was
  // given up may still write.
  [[nodiscard]] std::filesystem::path cell(const Job& job) const;
  [[nodiscard]] std::filesystem::path statistics(const Job& job) const;
  [[nodiscard]] static std::filesystem::path partial(std::filesystem::path file) {
    return file += ".part";
  }

  // Moves an arrived body to a job to be, see server/jobs/staged_model.hpp. `durable`: it is on the disk when
  // this returns.
  void adopt_model(const std::filesystem::path& arrived, std::string_view id, bool durable) const;
  // All files of all jobs that were written before are on the disk when this returns.
  void synchronise() const;
  // The results of a job, which have their names, are on the disk when this returns.
  void synchronise_results(const Job& job) const;
  // Writes the file of a copy again; synchronise() makes it last. False: it is as it was, as far as one can see:
  // what the kernel could not write it still shows for a while.
  [[nodiscard]] bool restore(const FileCopy& copy) const;
  // Removes everything of a job; never throws: what cannot be removed now goes at the next start.
  void remove(std::string_view id) const noexcept;
  // The model alone.
  void remove_model(std::string_view id) const noexcept;

 private:
  [[nodiscard]] std::filesystem::path job(std::string_view id) const { return root_ / "jobs" / id; }

  std::filesystem::path root_;
  bool shared_;
};

}  // namespace symcell::server
