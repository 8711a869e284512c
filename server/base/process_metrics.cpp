#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

#include "server/base/metrics.hpp"

namespace symcell::server {
namespace {

double seconds(const timeval& time) {
  constexpr double kMicro = 1e-6;
  return static_cast<double>(time.tv_sec) + kMicro * static_cast<double>(time.tv_usec);
}

// Fields of /proc/self/stat after the name, which may hold anything.
std::istringstream process_fields() {
  std::ifstream file("/proc/self/stat");
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const std::size_t end = text.rfind(')');
  return std::istringstream(end == std::string::npos ? std::string() : text.substr(end + 1));
}

double boot_time_s() {
  std::ifstream file("/proc/stat");
  std::string word;
  double value = 0;
  while (file >> word) {
    if (word == "btime" && file >> value) return value;
  }
  return 0;
}

double open_descriptors() {
  std::error_code ignored;
  double count = 0;
  for (std::filesystem::directory_iterator it("/proc/self/fd", ignored), end; it != end;
       it.increment(ignored)) {
    ++count;
  }
  return count;
}

}  // namespace

void declare_process_metrics(Metrics& metrics) {
  metrics.declare_counter("process_cpu_seconds_total", "Processor time of the server's process.");
  metrics.declare_gauge("process_resident_memory_bytes", "Memory of the server's process.");
  metrics.declare_gauge("process_virtual_memory_bytes", "Addresses of the server's process.");
  metrics.declare_gauge("process_open_fds", "Files and sockets that are open.");
  metrics.declare_gauge("process_max_fds", "Files and sockets that may be open.");
  metrics.declare_gauge("process_threads", "Threads of the server's process.");
  metrics.declare_gauge("process_start_time_seconds", "When the process started, since 1970.");
}

void report_process_metrics(Metrics& metrics) {
  rusage usage{};
  if (::getrusage(RUSAGE_SELF, &usage) == 0) {
    metrics.count_up_to("process_cpu_seconds_total", {},
                        seconds(usage.ru_utime) + seconds(usage.ru_stime));
  }
  rlimit files{};
  if (::getrlimit(RLIMIT_NOFILE, &files) == 0) {
    metrics.set("process_max_fds", {}, static_cast<double>(files.rlim_cur));
  }
  metrics.set("process_open_fds", {}, open_descriptors());
  // After the name: state, and from the second field on what proc(5) numbers 4 and up.
  constexpr int kThreads = 20;
  constexpr int kStart = 22;
  constexpr int kVirtual = 23;
  constexpr int kResident = 24;
  auto fields = process_fields();
  std::string word;
  fields >> word;
  for (int number = 4; number <= kResident && fields >> word; ++number) {
    const double value = std::strtod(word.c_str(), nullptr);
    if (number == kThreads) metrics.set("process_threads", {}, value);
    if (number == kStart) {
      metrics.set("process_start_time_seconds", {},
                  boot_time_s() + value / static_cast<double>(::sysconf(_SC_CLK_TCK)));
    }
    if (number == kVirtual) metrics.set("process_virtual_memory_bytes", {}, value);
    if (number == kResident) {
      metrics.set("process_resident_memory_bytes", {},
                  value * static_cast<double>(::sysconf(_SC_PAGESIZE)));
    }
  }
}

}  // namespace symcell::server
