#include "server/http/crew.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <thread>

#include "server/base/slots.hpp"

namespace symcell::server {
namespace {

// Tasks that wait until they are let go.
class Gate {
 public:
  std::function<void()> task() {
    return [this, released = released_] {
      ++started_;
      released.wait();
    };
  }
  void open() { promise_.set_value(); }
  [[nodiscard]] int started() const { return started_; }

 private:
  std::promise<void> promise_;
  std::shared_future<void> released_ = promise_.get_future().share();
  std::atomic<int> started_{0};
};

TEST(CrewTest, ThreadsAreStartedAsTheyAreNeededAndAFullQueueRefuses) {
  Gate gate;
  Crew crew(2, 1);
  EXPECT_EQ(crew.threads(), 0U);
  EXPECT_TRUE(crew.try_enqueue(gate.task()));
  EXPECT_TRUE(crew.try_enqueue(gate.task()));
  while (gate.started() < 2) std::this_thread::yield();
  EXPECT_EQ(crew.threads(), 2U);
  std::atomic<int> served{0};
  EXPECT_TRUE(crew.try_enqueue([&] { ++served; }));
  EXPECT_FALSE(crew.try_enqueue([&] { ++served; }));
  gate.open();
  crew.shutdown();
  EXPECT_EQ(served, 1);
}

TEST(CrewTest, AnIdleThreadTakesTheNextTask) {
  Crew crew(8, 0);
  for (int i = 0; i < 50; ++i) {
    std::promise<void> done;
    while (!crew.try_enqueue([&] { done.set_value(); })) std::this_thread::yield();
    done.get_future().wait();
  }
  EXPECT_LE(crew.threads(), 8U);
}

TEST(SlotsTest, PlacesComeBackWhenTheyAreLetGo) {
  Slots slots(2);
  auto first = slots.try_take();
  auto second = slots.try_take();
  EXPECT_TRUE(first);
  EXPECT_TRUE(second);
  EXPECT_FALSE(slots.try_take());
  EXPECT_EQ(slots.taken(), 2U);
  first.reset();
  EXPECT_TRUE(slots.try_take());
}

}  // namespace
}  // namespace symcell::server
