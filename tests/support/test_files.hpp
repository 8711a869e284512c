// Files for tests: reading, temporary folders, the corpus beside the source tree if it is there.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace symcell::test {

[[nodiscard]] std::string read_file(const std::filesystem::path& path);
void write_file(const std::filesystem::path& path, std::string_view bytes);

// A file under tests/data.
[[nodiscard]] std::filesystem::path data_file(std::string_view name);

// The folder `shared` beside the source tree, with the model corpus and the independent mesh
// checker; nullopt where it is absent.
[[nodiscard]] std::optional<std::filesystem::path> shared_folder();

// A fresh folder, removed at the end of the object's life.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] std::filesystem::path operator/(std::string_view name) const {
    return path_ / name;
  }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace symcell::test
