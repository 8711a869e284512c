#include "server/jobs/group_sync.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

#include "tests/unit/server/http_fixture.hpp"

namespace symcell::server::test {
namespace {

TEST(GroupSyncTest, NothingIsDoneForWhoHasCommittedNothing) {
  int synchronised = 0;
  GroupSync sync([&] { ++synchronised; });
  sync.reach();
  EXPECT_EQ(synchronised, 0);
  sync.committed();
  sync.reach();
  sync.reach();
  EXPECT_EQ(synchronised, 1);
}

TEST(GroupSyncTest, WhoComesWhileTheDiskIsAtWorkWaitsForTheNextTimeAndAllOfThemForOne) {
  std::atomic<int> begun{0};
  std::atomic<bool> open{false};
  GroupSync sync([&] {
    ++begun;
    while (!open) std::this_thread::yield();
  });
  sync.committed();
  std::thread first([&] { sync.reach(); });
  ASSERT_TRUE(eventually([&] { return begun == 1; }));
  constexpr int kOthers = 20;
  std::atomic<int> here{0};
  std::atomic<int> back{0};
  std::vector<std::thread> others;
  for (int i = 0; i < kOthers; ++i) {
    others.emplace_back([&] {
      sync.committed();
      ++here;
      sync.reach();
      ++back;
    });
  }
  ASSERT_TRUE(eventually([&] { return here == kOthers; }));
  EXPECT_EQ(back, 0);
  open = true;
  first.join();
  for (std::thread& other : others) other.join();
  // Threads that had not come to wait yet may need one of their own.
  EXPECT_GE(begun, 2);
  EXPECT_LE(begun, kOthers / 2);
}

TEST(GroupSyncTest, AFailureIsToldAndWhatWasCommittedIsSynchronisedTheNextTime) {
  bool broken = true;
  int synchronised = 0;
  GroupSync sync([&] {
    if (broken) throw std::runtime_error("no");
    ++synchronised;
  });
  sync.committed();
  EXPECT_THROW(sync.reach(), std::runtime_error);
  EXPECT_THROW(sync.reach(), std::runtime_error);
  broken = false;
  sync.reach();
  EXPECT_EQ(synchronised, 1);
}

TEST(GroupSyncTest, AFailureIsToldToAllWhoWaitedForIt) {
  std::atomic<int> begun{0};
  std::atomic<bool> open{false};
  GroupSync sync([&] {
    ++begun;
    while (!open) std::this_thread::yield();
    throw std::runtime_error("no");
  });
  std::atomic<int> told{0};
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&] {
      sync.committed();
      EXPECT_THROW(sync.reach(), std::runtime_error);
      ++told;
    });
  }
  ASSERT_TRUE(eventually([&] { return begun == 1; }));
  open = true;
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(told, 4);
}

}  // namespace
}  // namespace symcell::server::test
