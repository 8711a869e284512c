#include "server/jobs/staged_model.hpp"

#include "server/base/identifiers.hpp"

namespace symcell::server {
namespace {
constexpr std::string_view kStaged = ".new";
}  // namespace

std::filesystem::path staged_folder(const JobFiles& files, std::string_view id) {
  return files.model(id).parent_path() += kStaged;
}

std::optional<std::string> staged_job(std::string_view folder_name) {
  if (!folder_name.ends_with(kStaged)) return std::nullopt;
  folder_name.remove_suffix(kStaged.size());
  if (!is_job_id(folder_name)) return std::nullopt;
  return std::string(folder_name);
}

void settle_model(const JobFiles& files, std::string_view id) {
  // Not synchronised: a start finds the folder by either name.
  std::error_code error;
  std::filesystem::rename(staged_folder(files, id), files.model(id).parent_path(), error);
  if (!error || std::filesystem::exists(files.model(id))) return;
  throw std::filesystem::filesystem_error("the model cannot be given its name",
                                          files.model(id).parent_path(), error);
}

void discard_staged(const JobFiles& files, std::string_view id) noexcept {
  files.remove(std::string(id) + std::string(kStaged));
}

}  // namespace symcell::server
