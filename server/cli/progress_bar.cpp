#include "server/cli/progress_bar.hpp"

#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <string>

namespace symcell::cli {

ProgressBar::ProgressBar(const ExecutionContext& context, bool wanted) : context_(context) {
  if (!wanted || isatty(STDERR_FILENO) == 0) return;
  thread_ = std::jthread([this](const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    // The first sign of life comes after a moment: short runs draw nothing.
    while (!wake_.wait_for(lock, stop, std::chrono::milliseconds(150),
                           [&] { return stop.stop_requested(); })) {
      draw();
    }
  });
}

void ProgressBar::draw() const {
  constexpr int kWidth = 30;
  const Progress p = context_.progress();
  const int done = static_cast<int>(p.fraction * kWidth);
  const std::string bar = std::string(static_cast<std::size_t>(done), '#') +
                          std::string(static_cast<std::size_t>(kWidth - done), '.');
  std::fprintf(stderr, "\r\033[K[%s] %3d %% %-9s %llu elements, quality %.1f %%", bar.c_str(),
               static_cast<int>(100 * p.fraction), std::string(phase_name(p.phase)).c_str(),
               static_cast<unsigned long long>(p.elements), 100 * p.quality_reached);
  std::fflush(stderr);
}

void ProgressBar::stop() {
  if (!thread_.joinable()) return;
  thread_.request_stop();
  thread_.join();
  std::fprintf(stderr, "\r\033[K");
  std::fflush(stderr);
}

}  // namespace symcell::cli
