// Runs the work of a command in a child process, so that a crash of the mesher ends in an error
// like any other, with outputs cleaned up, and that a loop that hears no Ctrl-C ends all the same.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/model/mesh_options.hpp"

namespace symcell::cli {

struct SupervisedSettings {
  double time_limit_s = kInfinity;
  std::uint64_t memory_bytes = 0;  // 0: no limit
  bool progress_bar = false;
};

// `work` runs in a fork of this process: it may write to files and standard output, all else that
// it changes stays there, but for the text that it returns. SIGINT and SIGTERM cancel its context, and kill
// it if it does not end within a second. Requires: this process has one thread. Errors: those of `work`;
// kWorkerCrashed, kMemoryLimit, kTimeLimit, kCancelled if it had to be ended or ended by itself.
using SupervisedWork = std::function<Result<std::string>(ExecutionContext&)>;
[[nodiscard]] Result<std::string> run_supervised(const SupervisedWork& work,
                                                 const SupervisedSettings& settings);

}  // namespace symcell::cli
