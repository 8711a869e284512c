#include "server/cli/atomic_output.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <utility>

namespace symcell::cli {
namespace {

// mkstemp makes files for the owner only; outputs are files like any other.
void give_usual_permissions(int descriptor) {
  const mode_t mask = umask(0);
  umask(mask);
  (void)fchmod(descriptor, 0666 & ~mask);
}

}  // namespace

AtomicOutput::AtomicOutput(AtomicOutput&& other) noexcept
    : path_(std::move(other.path_)),
      target_(std::move(other.target_)),
      temporary_(std::exchange(other.temporary_, {})),
      file_(std::exchange(other.file_, nullptr)) {
}

AtomicOutput::~AtomicOutput() {
  if (file_ != nullptr && file_ != stdout) std::fclose(file_);
  if (!temporary_.empty()) (void)unlink(temporary_.c_str());
}

Failure AtomicOutput::failure() const {
  return fail(ErrorCode::kWriteFailed,
              "cannot write " + path_ + ": " + std::generic_category().message(errno));
}

Result<AtomicOutput> AtomicOutput::open(const std::string& path) {
  AtomicOutput output;
  output.path_ = path;
  if (path == "-") {
    output.path_ = "standard output";
    output.file_ = stdout;
    return output;
  }
  std::error_code none;
  const std::filesystem::path followed = std::filesystem::weakly_canonical(path, none);
  output.target_ = none ? path : followed.string();
  struct stat status {};
  const bool exists = stat(path.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) {
    errno = EISDIR;
    return output.failure();
  }
  if (exists && !S_ISREG(status.st_mode)) {
    output.file_ = std::fopen(path.c_str(), "wb");
    if (output.file_ == nullptr) return output.failure();
    return output;
  }
  std::string name = output.target_ + ".XXXXXX";
  const int descriptor = mkstemp(name.data());
  if (descriptor < 0) return output.failure();
  output.temporary_ = name;
  give_usual_permissions(descriptor);
  output.file_ = fdopen(descriptor, "wb");
  if (output.file_ == nullptr) {
    close(descriptor);
    return output.failure();
  }
  // Writers hand over large pieces: a second buffer would only copy them.
  std::setvbuf(output.file_, nullptr, _IONBF, 0);
  return output;
}

Sink AtomicOutput::sink() {
  return [file = file_](std::string_view piece) {
    return std::fwrite(piece.data(), 1, piece.size(), file) == piece.size();
  };
}

Result<void> AtomicOutput::commit() {
  if (std::fflush(file_) != 0) return failure();
  if (file_ == stdout) return {};
  const int closed = std::fclose(std::exchange(file_, nullptr));
  if (closed != 0) return failure();
  if (temporary_.empty()) return {};
  if (std::rename(temporary_.c_str(), target_.c_str()) != 0) return failure();
  temporary_.clear();
  return {};
}

}  // namespace symcell::cli
