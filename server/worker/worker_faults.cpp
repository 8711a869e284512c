#include "server/worker/worker_faults.hpp"

#include <sched.h>
#include <sys/ptrace.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace symcell::server {
namespace {

std::string_view fault_for(std::uint64_t seed) {
  const char* variable = std::getenv("SYMCELL_WORKER_FAULTS");
  if (variable == nullptr) return {};
  const std::string wanted = "=" + std::to_string(seed);
  std::string_view rest = variable;
  while (!rest.empty()) {
    const std::string_view entry = rest.substr(0, rest.find(','));
    rest.remove_prefix(std::min(rest.size(), entry.size() + 1));
    if (entry.ends_with(wanted)) return entry.substr(0, entry.size() - wanted.size());
  }
  return {};
}

void take_all_memory() {
  constexpr std::size_t kPiece = std::size_t{16} << 20U;
  std::vector<std::unique_ptr<char[]>> taken;
  while (true) {
    taken.push_back(std::make_unique<char[]>(kPiece));
  }
}

// What no mesher needs; ends the process if it can be done.
void use_rights() {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  const pid_t child = ::fork();
  if (child == 0) {
    std::string program = "/bin/true";
    char* const arguments[] = {program.data(), nullptr};
    ::execv(program.c_str(), arguments);
    ::_exit(1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  const bool ran = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  const bool traced = ::ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) == 0;
  const bool unshared = ::unshare(CLONE_NEWUSER) == 0;
  if (socket >= 0 || ran || traced || unshared) std::abort();
}

}  // namespace

void fault_on_purpose(std::uint64_t seed) {
  const std::string_view fault = fault_for(seed);
  if (fault.empty()) return;
  if (fault == "crash") ::raise(SIGSEGV);
  if (fault == "abort") std::abort();
  if (fault == "exit") ::_exit(3);
  if (fault == "memory") take_all_memory();
  if (fault == "rights") use_rights();
  if (fault == "hang") {
    volatile bool forever = true;
    while (forever) {
    }
  }
}

}  // namespace symcell::server
