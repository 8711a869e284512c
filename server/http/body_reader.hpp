// Request bodies, streamed to files in pieces and counted: httplib's own limit does not see chunked
// bodies, and it would keep whole bodies in memory.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

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

// A multipart/form-data body with a file `model` and a text `options`.
[[nodiscard]] std::optional<ArrivedForm> receive_form(Call& call,
                                                      const std::filesystem::path& destination,
                                                      std::size_t max_bytes);

}  // namespace symcell::server
