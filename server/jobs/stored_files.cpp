#include "server/jobs/stored_files.hpp"

#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>
#include <utility>

#include "api/formats/cell_archive.hpp"
#include "server/base/files.hpp"
#include "server/base/identifiers.hpp"

namespace symcell::server {
namespace {

[[noreturn]] void throw_damaged(const Job& job, std::string_view file, std::string_view what) {
  throw StoredFileDamaged("the stored " + std::string(file) + " of job " + job.id + " " +
                          std::string(what));
}

// A file that cannot be read is as good as a damaged one.
template <class Work>
auto reading(const Job& job, std::string_view file, const Work& work) {
  try {
    return work();
  } catch (const std::system_error& error) {
    throw_damaged(job, file, std::string("cannot be read: ") + error.code().message());
  }
}

}  // namespace

std::string read_statistics(const Job& job, const JobFiles& files) {
  std::string text = reading(job, "statistics", [&] {
    return std::string(MappedFile(files.statistics(job), Links::kRefuse).bytes());
  });
  if (job.statistics_sha256.empty()) {
    if (!nlohmann::json::accept(text)) throw_damaged(job, "statistics", "are damaged");
    return text;
  }
  Sha256 digest;
  digest.append(text);
  if (digest.finish() != job.statistics_sha256) throw_damaged(job, "statistics", "are damaged");
  return text;
}

SymmetryCellMesh read_cell(const Job& job, const JobFiles& files) {
  return reading(job, "cell", [&] {
    auto cell = read_cell_archive(MappedFile(files.cell(job), Links::kRefuse).bytes());
    if (!cell) throw_damaged(job, "cell", "is damaged: " + cell.error().message);
    return std::move(*cell);
  });
}

std::int32_t read_cell_dimension(const Job& job, const JobFiles& files) {
  return reading(job, "cell", [&] {
    const auto dimension =
        cell_archive_dimension(MappedFile(files.cell(job), Links::kRefuse).bytes());
    if (!dimension) throw_damaged(job, "cell", "is damaged: " + dimension.error().message);
    return *dimension;
  });
}

void check_model(const Job& job, const JobFiles& files) {
  reading(job, "model", [&] {
    const auto path = files.model(job.id);
    if (static_cast<std::int64_t>(std::filesystem::file_size(path)) != job.model_bytes) {
      throw_damaged(job, "model", "has another length than it had");
    }
    if (!job.model_sha256.empty() && sha256_of_file(path) != job.model_sha256) {
      throw_damaged(job, "model", "is damaged");
    }
  });
}

}  // namespace symcell::server
