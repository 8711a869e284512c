// Calls that wait for a job, and event streams, without a thread: what is left of each is an object that is
// looked at whenever its job changes, and at times of its own.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <thread>
#include <utility>

#include "server/http/crew.hpp"

namespace symcell::server {

struct Call;
class Connection;

// One of them. All is called by one thread at a time.
class SuspendedCall {
 public:
  using Clock = std::chrono::steady_clock;

  virtual ~SuspendedCall() = default;
  // From now on `wake` is called, by any thread, when there may be news; until the result goes.
  [[nodiscard]] virtual std::shared_ptr<void> watch(std::function<void()> wake) = 0;
  // Looks for news, without waiting for anything. True: the call is over, as it is if this throws.
  [[nodiscard]] virtual bool look(Connection& connection) = 0;
  // When to look again though there are no news.
  [[nodiscard]] virtual Clock::time_point look_again_at() const = 0;
  // Fills the answer of a call that is over and has sent nothing by itself.
  virtual void answer(Call& call) = 0;
};

class SuspendedCalls {
 public:
  using Finish = std::function<void()>;

  // `threads`: that look, and finish.
  explicit SuspendedCalls(std::size_t threads);
  ~SuspendedCalls();
  SuspendedCalls(const SuspendedCalls&) = delete;
  SuspendedCalls& operator=(const SuspendedCalls&) = delete;

  // `finish`: called once when the call is over, by a thread that may wait for the client a while.
  void add(std::shared_ptr<SuspendedCall> call,
           std::shared_ptr<Connection> connection,
           Finish finish);
  // Drops those that are left.
  void shutdown();

 private:
  using Clock = SuspendedCall::Clock;
  struct Entry {
    std::shared_ptr<SuspendedCall> call;
    std::shared_ptr<Connection> connection;
    Finish finish;
    std::shared_ptr<void> watch;
    std::atomic<bool> woken{false};  // and not looked at since
    std::mutex mutex;                // guards the next two, and the call
    bool over = false;
    Clock::time_point due{};
  };
  using Held = std::shared_ptr<Entry>;

  void wake(const std::weak_ptr<Entry>& entry);
  void look(const Held& entry);
  void keep_time(const std::stop_token& stop);

  Crew crew_;
  std::mutex mutex_;  // guards entries_ and due_
  std::condition_variable_any changed_;
  std::set<Held> entries_;
  std::set<std::pair<Clock::time_point, Held>> due_;
  std::jthread timer_;  // last: it uses all of the above
};

}  // namespace symcell::server
