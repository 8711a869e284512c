// Files whose contents survive a crash, and files as memory.
//
// Failures of the disk (full, read-only, gone) throw std::system_error: no request can cause or
// mend them, and the wrapper round every handler and job turns them into internal errors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace symcell::server {

// What becomes of a symbolic link in the place of a file. A user's files may be links; in the
// server's own folders nothing is one that it put there.
enum class Links : std::uint8_t { kFollow, kRefuse };

// A new file, written from the front. Closed and, unless committed, deleted by the destructor.
class FileWriter {
 public:
  // Fails if `path` exists.
  explicit FileWriter(std::filesystem::path path);
  ~FileWriter();
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;

  void write(std::string_view bytes);
  [[nodiscard]] std::size_t size() const { return size_; }
  // Empties the file again.
  void truncate();

  // Makes the contents durable under `destination`, replacing what was there at once and as a
  // whole.
  void commit_as(const std::filesystem::path& destination);
  // Leaves the file under its own name; not synchronised.
  void keep();

 private:
  void close();

  std::filesystem::path path_;
  int descriptor_ = -1;
  std::size_t size_ = 0;
};

// A file read from the front in pieces: unlike a mapped one it takes no memory however large it is.
class FileReader {
 public:
  explicit FileReader(const std::filesystem::path& path, Links links = Links::kFollow);
  ~FileReader();
  FileReader(const FileReader&) = delete;
  FileReader& operator=(const FileReader&) = delete;

  // The next piece, valid until the next call; empty at the end.
  [[nodiscard]] std::string_view next();

 private:
  int descriptor_ = -1;
  std::string buffer_;
};

// The bytes of a file, read-only. The file must not be truncated meanwhile.
class MappedFile {
 public:
  explicit MappedFile(const std::filesystem::path& path, Links links = Links::kFollow);
  ~MappedFile();
  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&&) = delete;
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  [[nodiscard]] std::string_view bytes() const {
    return {static_cast<const char*>(address_), size_};
  }

 private:
  void* address_ = nullptr;
  std::size_t size_ = 0;
};

// Makes a finished file durable under a new name in the same file system.
void rename_durably(const std::filesystem::path& from, const std::filesystem::path& to);
// Makes the contents of a file durable, which is no link.
void sync_file(const std::filesystem::path& file);
// Makes names created in or removed from a folder durable.
void sync_directory(const std::filesystem::path& directory);

}  // namespace symcell::server
