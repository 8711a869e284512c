#include "server/jobs/change_signal.hpp"

#include <gtest/gtest.h>

#include <chrono>

namespace symcell::server::test {
namespace {

using Clock = ChangeSignal::Clock;

TEST(ChangeSignalTest, AWatchHearsOfItsJobAlone) {
  ChangeSignal signal;
  int heard = 0;
  auto watch = signal.watch("a", [&] { ++heard; });
  signal.notify("b");
  EXPECT_EQ(heard, 0);
  signal.notify("a");
  EXPECT_EQ(heard, 1);
  signal.notify_all();
  EXPECT_EQ(heard, 2);
  watch.reset();
  signal.notify("a");
  EXPECT_EQ(heard, 2);
}

TEST(ChangeSignalTest, ACallbackMayWatchAndCeaseTo) {
  ChangeSignal signal;
  int heard = 0;
  ChangeSignal::Watch second;
  ChangeSignal::Watch first;
  first = signal.watch("a", [&] {
    second = signal.watch("a", [&] { ++heard; });
    first.reset();
  });
  signal.notify("a");
  signal.notify("a");
  EXPECT_EQ(heard, 1);
}

TEST(ChangeSignalTest, AnyChangeIsAVersion) {
  ChangeSignal signal;
  const auto seen = signal.version();
  signal.notify("a");
  signal.wait_beyond(seen, Clock::now() + std::chrono::seconds(10));
  EXPECT_NE(signal.version(), seen);
}

}  // namespace
}  // namespace symcell::server::test
