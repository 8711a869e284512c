#include "server/cli/interrupt.hpp"

#include <atomic>
#include <csignal>

namespace symcell::cli {
namespace {

// A signal handler has no other way to its object.
std::atomic<ExecutionContext*> running{nullptr};
static_assert(std::atomic<ExecutionContext*>::is_always_lock_free);

extern "C" void cancel_running(int) {
  if (ExecutionContext* context = running.load()) context->cancel();
}

void set_handlers(void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  sigemptyset(&action.sa_mask);
  // Not reset: some send two signals at once, and the second would leave open outputs behind. What is
  // cancelled ends within a second, by force if need be.
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

}  // namespace

InterruptCancels::InterruptCancels(ExecutionContext& context) {
  running.store(&context);
  set_handlers(cancel_running);
}

InterruptCancels::~InterruptCancels() {
  set_handlers(SIG_DFL);
  running.store(nullptr);
}

}  // namespace symcell::cli
