// A folder held open. What is done through it happens in that folder, whatever becomes of its name
// meanwhile, and follows no symbolic link: a link is an entry like any other, moved or removed
// itself.
//
// Failures of the disk throw std::system_error, as in server/base/files.hpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace symcell::server {

class Directory {
 public:
  // Links in the path itself are followed: it is the operator's.
  explicit Directory(const std::filesystem::path& path);
  ~Directory();
  Directory(Directory&& other) noexcept;
  Directory& operator=(Directory&&) = delete;
  Directory(const Directory&) = delete;
  Directory& operator=(const Directory&) = delete;

  enum class Kind : std::uint8_t { kFile, kFolder, kLink, kOther };
  struct Entry {
    std::string name;
    Kind kind = Kind::kOther;
    std::uint64_t bytes = 0;  // of a file
  };
  // Sorted by name; without "." and "..".
  [[nodiscard]] std::vector<Entry> entries() const;
  [[nodiscard]] bool has(const std::string& name) const;

  // The folder of that name, created for its owner alone if it is missing. Throws where the name is
  // taken by a link or by anything but a folder.
  [[nodiscard]] Directory folder(const std::string& name) const;
  // Opens a file of that name, which must be a file; -1 if there is none.
  [[nodiscard]] int open_file(const std::string& name) const;
  // Opens the file, created for its owner alone if it is missing. `created`: whether it was.
  [[nodiscard]] int open_or_create_file(const std::string& name, bool& created) const;
  // A file with this text, durable, in place of what was there.
  void write_file(const std::string& name, std::string_view text) const;

  // A file or a link; no error if it is gone.
  void remove_file(const std::string& name) const;
  // Any entry, in one step, within a file system.
  void move(const std::string& name, const Directory& to, const std::string& new_name) const;
  void sync() const;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  Directory(int descriptor, std::filesystem::path path);

  int descriptor_ = -1;
  std::filesystem::path path_;  // for messages
};

}  // namespace symcell::server
