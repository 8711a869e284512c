// A model between its arrival and its job's row.
//
// Until the row is written the job's folder is jobs/<id>.new. A death of the server leaves either no
// row, and the folder was promised to nobody; or a row, and the folder only lacks its name.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "server/jobs/job_files.hpp"

namespace symcell::server {

[[nodiscard]] std::filesystem::path staged_folder(const JobFiles& files, std::string_view id);
// The job whose staged folder has this name; nullopt: it is none.
[[nodiscard]] std::optional<std::string> staged_job(std::string_view folder_name);

// The row is written: gives the folder its name. Whoever accepts a job and whoever runs it may both do so: the
// one is not sure to come before the other.
void settle_model(const JobFiles& files, std::string_view id);
// There will be no row.
void discard_staged(const JobFiles& files, std::string_view id) noexcept;

}  // namespace symcell::server
