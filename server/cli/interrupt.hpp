// SIGINT and SIGTERM cancel the running call, however many come.
#pragma once

#include "core/base/execution_context.hpp"

namespace symcell::cli {

class InterruptCancels {
 public:
  // `context` must outlive the object; one object at a time.
  explicit InterruptCancels(ExecutionContext& context);
  ~InterruptCancels();
  InterruptCancels(const InterruptCancels&) = delete;
  InterruptCancels& operator=(const InterruptCancels&) = delete;
};

}  // namespace symcell::cli
