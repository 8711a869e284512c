// A progress bar on standard error while a call runs, drawn by a thread that reads the context's
// progress. Draws nothing unless standard error is a terminal.
#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>

#include "core/base/execution_context.hpp"

namespace symcell::cli {

class ProgressBar {
 public:
  // `context` must outlive the bar.
  ProgressBar(const ExecutionContext& context, bool wanted);
  ~ProgressBar() { stop(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  // Clears the line; errors and results may be printed after it.
  void stop();

 private:
  void draw() const;

  const ExecutionContext& context_;
  std::mutex mutex_;  // guards nothing but the wait: the thread is woken to end
  std::condition_variable_any wake_;
  std::jthread thread_;
};

}  // namespace symcell::cli
