#include "server/http/task_queue.hpp"

#include <gtest/gtest.h>

#include <future>

#include "server/base/slots.hpp"

namespace symcell::server {
namespace {

TEST(BoundedTaskQueueTest, AFullQueueRunsTheTaskInTheCallerAsOverloaded) {
  BoundedTaskQueue queue(1, 1);
  std::promise<void> release;
  std::promise<void> started;
  auto released = release.get_future().share();
  queue.enqueue([&] {
    started.set_value();
    released.wait();
  });
  started.get_future().wait();
  std::atomic<int> served{0};
  queue.enqueue([&] { ++served; });
  EXPECT_EQ(queue.waiting(), 1U);
  bool overloaded = false;
  queue.enqueue([&] { overloaded = BoundedTaskQueue::overloaded(); });
  EXPECT_TRUE(overloaded);
  EXPECT_FALSE(BoundedTaskQueue::overloaded());
  release.set_value();
  queue.shutdown();
  EXPECT_EQ(served, 1);
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
