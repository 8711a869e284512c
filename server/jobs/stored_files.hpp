// A job's stored files as they are handed out: checked against what was noted when they were written.
#pragma once

#include <stdexcept>
#include <string>

#include "core/cell/symmetry_cell_mesh.hpp"
#include "server/jobs/job.hpp"
#include "server/jobs/job_files.hpp"

namespace symcell::server {

// A file of a job is cut off, changed or gone. Nothing of it may be handed out.
class StoredFileDamaged : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// All throw StoredFileDamaged.

// The statistics document, JSON.
[[nodiscard]] std::string read_statistics(const Job& job, const JobFiles& files);
[[nodiscard]] SymmetryCellMesh read_cell(const Job& job, const JobFiles& files);
// From the head of the archive alone.
[[nodiscard]] std::int32_t read_cell_dimension(const Job& job, const JobFiles& files);
void check_model(const Job& job, const JobFiles& files);

}  // namespace symcell::server
