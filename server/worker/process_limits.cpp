#include "server/worker/process_limits.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <new>
#include <string>

#include "core/base/sanitized.hpp"

namespace symcell::server {
namespace {

pid_t worker_pid = 0;

void refuse_memory() {
  if (::getpid() == worker_pid) ::_exit(kMemoryExitStatus);
  throw std::bad_alloc();
}

// Async-signal-safe.
extern "C" void on_parent_death(int) {
  ::kill(0, SIGKILL);
  ::_exit(kOrphanExitStatus);
}

// One of this process's limits. What the user or the system set before stays the most there is.
class SoftLimit {
 public:
  explicit SoftLimit(decltype(RLIMIT_DATA) resource) : resource_(resource) {
    if (::getrlimit(resource, &initial_) != 0) initial_ = {RLIM_INFINITY, RLIM_INFINITY};
  }
  void set(rlim_t value) const {
    // The hard limit stays: it could not be raised again for the next request.
    const rlimit limit{std::min(value, initial_.rlim_cur), initial_.rlim_max};
    ::setrlimit(resource_, &limit);
  }

 private:
  decltype(RLIMIT_DATA) resource_;
  rlimit initial_{};
};

std::uint64_t cpu_seconds_used() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec);
}

}  // namespace

void prepare_worker_process() {
  worker_pid = ::getpid();
  std::set_new_handler(refuse_memory);
  // 1, not 0: where core files go to a program, the kernel ignores a 0 but takes a 1 for "none".
  const rlimit no_core{1, 1};
  ::setrlimit(RLIMIT_CORE, &no_core);
}

void die_with_parent(pid_t parent) {
  struct sigaction action {};
  action.sa_handler = on_parent_death;
  sigemptyset(&action.sa_mask);
  ::sigaction(SIGTERM, &action, nullptr);
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  // It may have died before that call.
  if (::getppid() != parent) ::_exit(kOrphanExitStatus);
}

void end_process_group() {
  if (::getpgrp() == ::getpid()) ::kill(0, SIGKILL);
  ::_exit(kOrphanExitStatus);
}

void apply_limits(const WorkerLimits& limits) {
  if (kSanitized) return;
  static const SoftLimit kMemory(RLIMIT_DATA);
  static const SoftLimit kProcessor(RLIMIT_CPU);
  static const SoftLimit kFile(RLIMIT_FSIZE);
  kFile.set(limits.file_bytes == 0 ? RLIM_INFINITY : limits.file_bytes);
  kMemory.set(limits.memory_bytes == 0 ? RLIM_INFINITY : limits.memory_bytes);
  // The kernel counts from the start of the process, and not finer than seconds.
  kProcessor.set(limits.cpu_seconds == 0 ? RLIM_INFINITY
                                         : cpu_seconds_used() + limits.cpu_seconds + 1);
}

void reset_peak_memory() {
  const int file = ::open("/proc/self/clear_refs", O_WRONLY | O_CLOEXEC);
  if (file < 0) return;
  // "5" resets the peak (proc(5)). A kernel without it leaves the peak of the whole process.
  [[maybe_unused]] const ssize_t written = ::write(file, "5", 1);
  ::close(file);
}

std::uint64_t peak_resident_bytes() {
  std::ifstream status("/proc/self/status");
  std::string word;
  while (status >> word) {
    if (word != "VmHWM:") continue;
    std::uint64_t kilobytes = 0;
    status >> kilobytes;
    return kilobytes * 1024;
  }
  return 0;
}

}  // namespace symcell::server
