#include "core/base/child_process.hpp"

#include <errno.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <string>

#include "core/base/sanitized.hpp"

namespace symcell {
namespace {

// Exit statuses that foreign code does not use: the child says itself how it ended.
constexpr int kExitDone = 87;
constexpr int kExitRefused = 88;

// The parent looks at child and context with pauses that grow between these.
constexpr long kFirstPauseNs = 200'000;
constexpr long kLongestPauseNs = 10'000'000;

// An anonymous file in memory that parent and child share.
class SharedFile {
 public:
  SharedFile() : descriptor_(memfd_create("child_result", MFD_CLOEXEC)) {}
  ~SharedFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  SharedFile(const SharedFile&) = delete;
  SharedFile& operator=(const SharedFile&) = delete;
  [[nodiscard]] int descriptor() const { return descriptor_; }

  // All bytes written so far.
  [[nodiscard]] bool read(std::vector<std::byte>& bytes) const {
    const off_t size = ::lseek(descriptor_, 0, SEEK_END);
    if (size < 0) return false;
    bytes.resize(static_cast<std::size_t>(size));
    std::size_t done = 0;
    while (done < bytes.size()) {
      const ssize_t got =
          ::pread(descriptor_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(done));
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) return false;
      done += static_cast<std::size_t>(got);
    }
    return true;
  }

 private:
  int descriptor_;
};

void limit(int resource, rlim_t most) {
  rlimit r{};
  if (getrlimit(static_cast<__rlimit_resource>(resource), &r) != 0) return;
  r.rlim_cur = r.rlim_max == RLIM_INFINITY ? most : std::min(most, r.rlim_max);
  r.rlim_max = r.rlim_cur;
  setrlimit(static_cast<__rlimit_resource>(resource), &r);
}

// Address space of this process in bytes; 0 if it is not known.
rlim_t address_space() {
  std::FILE* file = std::fopen("/proc/self/statm", "r");
  if (file == nullptr) return 0;
  std::array<char, 32> text{};  // the first number of the line is asked for
  const bool read = std::fgets(text.data(), static_cast<int>(text.size()), file) != nullptr;
  std::fclose(file);
  const unsigned long pages = read ? std::strtoul(text.data(), nullptr, 10) : 0;
  return static_cast<rlim_t>(pages) * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
}

// What the parent has not yet flushed is in this process's buffers too: it must go nowhere, even if
// the foreign code calls exit().
void silence() {
  if (std::FILE* null = std::fopen("/dev/null", "w"); null != nullptr) {
    dup2(fileno(null), STDOUT_FILENO);
    dup2(fileno(null), STDERR_FILENO);
  } else {
    ::close(STDOUT_FILENO);
    ::close(STDERR_FILENO);
  }
}

[[noreturn]] void run_child(const std::function<bool(ChildOutput&)>& body,
                            const ChildLimits& limits,
                            int descriptor,
                            pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  // The parent may be gone already: then no signal will come.
  if (getppid() != parent) _exit(kExitRefused);
  prctl(PR_SET_DUMPABLE, 0);
  // Handlers are the parent's: a crash here is to end this process at once, and an allocation that
  // fails is an exception.
  for (const int s : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTERM, SIGINT, SIGXCPU}) {
    signal(s, SIG_DFL);
  }
  std::set_new_handler(nullptr);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, std::max<rlim_t>(1, limits.cpu_seconds));
  if (!kSanitized && limits.memory_bytes > 0) {
    limit(RLIMIT_AS, address_space() + limits.memory_bytes);
  }
  silence();
  int status = kExitRefused;
  try {
    ChildOutput output(descriptor);
    if (body(output) && output.good()) status = kExitDone;
  } catch (...) {
    // TetGen throws ints, the library bad_alloc.
  }
  _exit(status);
}

// The child's end; kills it if it is still there when the scope is left.
class Child {
 public:
  explicit Child(pid_t pid) : pid_(pid) {}
  ~Child() {
    if (ended_) return;
    kill(pid_, SIGKILL);
    while (waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  [[nodiscard]] bool ended() {
    if (ended_) return true;
    const pid_t got = waitpid(pid_, &status_, WNOHANG);
    if (got == pid_) ended_ = true;
    // Somebody else reaped it: how it ended is not known.
    if (got < 0 && errno == ECHILD) {
      status_ = -1;
      ended_ = true;
    }
    return ended_;
  }
  [[nodiscard]] ChildFailure failure() const {
    if (status_ != -1 && WIFEXITED(status_)) {
      if (WEXITSTATUS(status_) == kExitDone) return ChildFailure::kNone;
      if (WEXITSTATUS(status_) == kExitRefused) return ChildFailure::kRefused;
    }
    const bool cpu = status_ != -1 && WIFSIGNALED(status_) &&
                     (WTERMSIG(status_) == SIGXCPU || WTERMSIG(status_) == SIGKILL);
    return cpu ? ChildFailure::kCpuLimit : ChildFailure::kCrashed;
  }

 private:
  pid_t pid_;
  int status_ = -1;
  bool ended_ = false;
};

}  // namespace

void ChildOutput::write(std::span<const std::byte> bytes) {
  while (good_ && !bytes.empty()) {
    const ssize_t put = ::write(descriptor_, bytes.data(), bytes.size());
    if (put < 0 && errno == EINTR) continue;
    good_ = put > 0;
    if (good_) bytes = bytes.subspan(static_cast<std::size_t>(put));
  }
}

Result<ChildResult> run_in_child(const std::function<bool(ChildOutput&)>& body,
                                 const ChildLimits& limits,
                                 ExecutionContext& context) {
  SYMCELL_TRY(context.check());
  const SharedFile file;
  if (file.descriptor() < 0) {
    return fail(ErrorCode::kInternal, "no memory for the result of a child process");
  }
  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid < 0) return fail(ErrorCode::kInternal, "a child process could not be started");
  if (pid == 0) run_child(body, limits, file.descriptor(), parent);

  Child child(pid);
  timespec pause{0, kFirstPauseNs};
  while (!child.ended()) {
    SYMCELL_TRY(context.check());
    nanosleep(&pause, nullptr);
    pause.tv_nsec = std::min(kLongestPauseNs, pause.tv_nsec + pause.tv_nsec / 4);
  }
  ChildResult result;
  result.failure = child.failure();
  if (result.failure == ChildFailure::kNone && !file.read(result.bytes)) {
    return fail(ErrorCode::kInternal, "the result of a child process could not be read");
  }
  return result;
}

}  // namespace symcell
