#include "server/worker/process_rights.hpp"

#include <sched.h>
#include <seccomp.h>
#include <sys/prctl.h>
#include <sys/resource.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <memory>

#include "core/base/sanitized.hpp"

namespace symcell::server {
namespace {

// Standard streams, the connection, an event, a model, two results, pipes to a child of TetGen's.
constexpr rlim_t kMostFiles = 64;

// By name, for numbers differ between processors; those that one of them lacks are left out there.
constexpr std::array kAllowed{
    // files
    "read", "write", "readv", "writev", "pread64", "pwrite64", "lseek", "_llseek", "open", "openat",
    "close", "close_range", "fstat", "fstat64", "stat", "stat64", "lstat", "lstat64", "newfstatat",
    "fstatat64", "statx", "access", "faccessat", "faccessat2", "readlink", "readlinkat", "getcwd",
    "getdents64", "unlink", "unlinkat", "rename", "renameat", "renameat2", "ftruncate",
    "ftruncate64", "fsync", "fdatasync", "fcntl", "fcntl64", "fadvise64", "ioctl", "dup", "dup2",
    "dup3", "pipe", "pipe2", "eventfd2", "poll", "ppoll", "select", "pselect6", "_newselect",
    // the connection, which is there already
    "sendto", "recvfrom", "sendmsg", "recvmsg", "send", "recv", "shutdown", "getsockopt",
    // memory
    "memfd_create", "brk", "mmap", "mmap2", "munmap", "mprotect", "mremap", "madvise", "mincore",
    "membarrier",
    // threads, children and their ends
    "fork", "vfork", "wait4", "waitid", "exit", "exit_group", "kill", "tgkill", "tkill", "futex",
    "futex_time64", "set_robust_list", "get_robust_list", "set_tid_address", "rseq", "sched_yield",
    "sched_getaffinity", "setpgid", "rt_sigaction", "rt_sigprocmask", "rt_sigreturn",
    "rt_sigtimedwait", "sigreturn", "sigaltstack", "restart_syscall", "prctl", "arch_prctl",
    // what is asked about oneself and the clock
    "getpid", "gettid", "getppid", "getpgrp", "getpgid", "getuid", "geteuid", "getgid", "getegid",
    "getrlimit", "ugetrlimit", "setrlimit", "prlimit64", "getrusage", "times", "sysinfo", "uname",
    "getrandom", "clock_gettime", "clock_gettime64", "clock_getres", "clock_nanosleep",
    "clock_nanosleep_time64", "nanosleep", "gettimeofday", "time"};

// Flags of clone that make a namespace: a way to rights that this process has not.
constexpr std::uint64_t kNamespaceFlags = CLONE_NEWUSER | CLONE_NEWNS | CLONE_NEWPID |
                                          CLONE_NEWNET | CLONE_NEWIPC | CLONE_NEWUTS |
                                          CLONE_NEWCGROUP;

bool filter_system_calls() {
  const std::unique_ptr<void, void (*)(scmp_filter_ctx)> filter(seccomp_init(SCMP_ACT_ERRNO(EPERM)),
                                                                seccomp_release);
  if (!filter) return false;
  for (const char* name : kAllowed) {
    const int number = seccomp_syscall_resolve_name(name);
    if (number == __NR_SCMP_ERROR || number < 0) continue;
    if (seccomp_rule_add(filter.get(), SCMP_ACT_ALLOW, number, 0) != 0) return false;
  }
  // Its flags lie in memory, where no filter looks: the C library then takes clone.
  if (seccomp_rule_add(filter.get(), SCMP_ACT_ERRNO(ENOSYS), SCMP_SYS(clone3), 0) != 0)
    return false;
  if (seccomp_rule_add(filter.get(), SCMP_ACT_ALLOW, SCMP_SYS(clone), 1,
                       SCMP_A0(SCMP_CMP_MASKED_EQ, kNamespaceFlags, 0)) != 0) {
    return false;
  }
  return seccomp_load(filter.get()) == 0;
}

}  // namespace

bool give_up_rights() {
  const rlimit files{kMostFiles, kMostFiles};
  ::setrlimit(RLIMIT_NOFILE, &files);
  // A file that grows beyond its limit is an error of the write, not the end of the process.
  std::signal(SIGXFSZ, SIG_IGN);
  if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return false;
  return kSanitized || filter_system_calls();
}

}  // namespace symcell::server
