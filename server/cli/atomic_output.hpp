// An output of a command: written beside its place and renamed when complete, so that no reader
// ever sees half a file and a failed run leaves the old one. "-" is standard output; what is no
// regular file (a pipe, /dev/null) is written in place.
#pragma once

#include <cstdio>
#include <string>

#include "api/sink.hpp"
#include "core/base/error.hpp"

namespace symcell::cli {

class AtomicOutput {
 public:
  AtomicOutput() = default;
  AtomicOutput(AtomicOutput&& other) noexcept;
  AtomicOutput& operator=(AtomicOutput&&) = delete;
  AtomicOutput(const AtomicOutput&) = delete;
  AtomicOutput& operator=(const AtomicOutput&) = delete;
  // Removes what was not committed.
  ~AtomicOutput();

  // Errors: kWriteFailed, with the system's words.
  [[nodiscard]] static Result<AtomicOutput> open(const std::string& path);

  // Lives as long as the object.
  [[nodiscard]] Sink sink();
  [[nodiscard]] Result<void> commit();

 private:
  [[nodiscard]] Failure failure() const;

  std::string path_;       // as the user gave it
  std::string target_;     // with links followed
  std::string temporary_;  // empty: written in place
  std::FILE* file_ = nullptr;
};

}  // namespace symcell::cli
