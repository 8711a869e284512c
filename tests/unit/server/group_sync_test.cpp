#include "server/jobs/group_sync.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/unit/server/http_fixture.hpp"

namespace symcell::server::test {
namespace {

// Whether a thread of this process waits for something, by what the kernel says of it.
bool sleeps(const std::atomic<pid_t>& thread) {
  if (thread == 0) return false;
  std::ifstream file("/proc/self/task/" + std::to_string(thread) + "/stat");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::size_t name = text.rfind(") ");
  return name != std::string::npos && text.substr(name + 2, 1) == "S";
}

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
  others.reserve(kOthers);
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
    const bool first = ++begun == 1;
    while (!open) std::this_thread::yield();
    if (first) throw std::runtime_error("no");
  });
  sync.committed();
  std::atomic<int> told{0};
  std::vector<std::thread> threads;
  std::array<std::atomic<pid_t>, 3> waiting{};
  const auto wait = [&] {
    try {
      sync.reach();
    } catch (const std::runtime_error&) {
      ++told;
    }
  };
  threads.emplace_back(wait);
  ASSERT_TRUE(eventually([&] { return begun == 1; }));
  for (std::atomic<pid_t>& id : waiting) {
    threads.emplace_back([&] {
      id = ::gettid();
      wait();
    });
  }
  // There is nothing else that they may sleep for.
  ASSERT_TRUE(eventually([&] { return std::ranges::all_of(waiting, sleeps); }));
  open = true;
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(begun, 1) << "somebody tried again what had failed for all";
  EXPECT_EQ(told, 4);
}

}  // namespace
}  // namespace symcell::server::test
