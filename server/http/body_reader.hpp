// Request bodies, streamed to files in pieces and counted: httplib's own limit does not see chunked
// bodies, and it would keep whole bodies in memory.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "server/base/files.hpp"

namespace symcell::server {

struct Call;

// A file that goes with its owner.
class ArrivedFile {
 public:
  explicit ArrivedFile(std::filesystem::path path) : path_(std::move(path)) {}
  ~ArrivedFile() { remove(); }
  ArrivedFile(ArrivedFile&& other) noexcept : path_(std::move(other.path_)) { other.path_.clear(); }
  ArrivedFile& operator=(ArrivedFile&& other) noexcept {
    if (this != &other) {
      remove();
      path_ = std::move(other.path_);
      other.path_.clear();
    }
    return *this;
  }

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  // Whoever accepts the file moves it away; then there is nothing left to remove.
  void remove() noexcept;

  std::filesystem::path path_;
};

// A body to be looked at: in memory if it is small, for files that soon go again cost a file system much.
class ArrivedBytes {
 public:
  explicit ArrivedBytes(std::string held) : held_(std::move(held)) {}
  explicit ArrivedBytes(ArrivedFile file)
      : file_(std::move(file)), map_(std::in_place, file_->path(), Links::kRefuse) {}

  [[nodiscard]] std::string_view bytes() const { return map_ ? map_->bytes() : held_; }
  // Where there is one.
  [[nodiscard]] std::optional<ArrivedFile>& file() { return file_; }

 private:
  std::string held_;
  std::optional<ArrivedFile> file_;
  std::optional<MappedFile> map_;
};

struct ArrivedForm {
  ArrivedFile model;
  std::string model_name;
  std::string model_media_type;
  std::optional<std::string> options;
};

// All answer the call themselves and return nullopt where the body is not acceptable.

// The body as a file, inflated if it came gzipped.  At most `max_bytes` either way.
[[nodiscard]] std::optional<ArrivedFile> receive_body(Call& call,
                                                      const std::filesystem::path& destination,
                                                      std::size_t max_bytes);

// The same of JSON, for whoever takes it apart; what no model may be is refused before all has come.
// `destination`: where it goes if it is not small.
[[nodiscard]] std::optional<ArrivedBytes> receive_bytes(Call& call,
                                                        const std::filesystem::path& destination,
                                                        std::size_t max_bytes);

// For calls that take no body. False: one is announced, the call is answered; it is not read.
[[nodiscard]] bool receive_nothing(Call& call);

// A multipart/form-data body with a file `model` and a text `options`.
[[nodiscard]] std::optional<ArrivedForm> receive_form(Call& call,
                                                      const std::filesystem::path& destination,
                                                      std::size_t max_bytes);

}  // namespace symcell::server
