// The heap of a process that meshes, each time in a process of its own: mallopt(3) cannot be undone.
#include "server/worker/heap.hpp"

#include <gtest/gtest.h>
#include <malloc.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <string>

#include "core/base/sanitized.hpp"
#include "server/worker/process_limits.hpp"

namespace symcell::server::test {
namespace {

constexpr std::size_t kMiB = std::size_t{1} << 20;

// The exit status of a child that ends with what `work` returns; -1: it ended otherwise.
int status_of(const std::function<int()>& work) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(work());
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::size_t resident_bytes() {
  std::ifstream statm("/proc/self/statm");
  std::size_t total = 0, resident = 0;
  statm >> total >> resident;
  return resident * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

// Asks for that much and writes to all of it.
bool uses(std::size_t bytes) {
  void* block = std::malloc(bytes);
  if (block == nullptr) return false;
  std::memset(block, 1, bytes);
  asm volatile("" : : "r"(block) : "memory");  // not to be optimised away
  std::free(block);
  return true;
}

class Heap : public ::testing::Test {
 protected:
  void SetUp() override {
    if (kSanitized) GTEST_SKIP() << "the sanitizer has an allocator of its own";
  }
};

TEST_F(Heap, AddressesSetAsideTakeNoMemory) {
  EXPECT_EQ(status_of([] {
              prepare_heap();
              const std::size_t before = resident_bytes();
              reserve_heap(0);
              return resident_bytes() < before + 8 * kMiB ? 0 : 1;
            }),
            0);
}

TEST_F(Heap, WhatIsFreedComesWithoutThePagesTakenAnew) {
  EXPECT_EQ(status_of([] {
              prepare_heap();
              reserve_heap(0);
              if (!uses(64 * kMiB)) return 1;
              rusage before{}, after{};
              ::getrusage(RUSAGE_SELF, &before);
              if (!uses(64 * kMiB)) return 2;
              ::getrusage(RUSAGE_SELF, &after);
              return after.ru_minflt - before.ru_minflt < 100 ? 0 : 3;  // 16,384 small pages
            }),
            0);
}

TEST_F(Heap, IsGivenBackAndReservedAgain) {
  EXPECT_EQ(status_of([] {
              prepare_heap();
              for (int round = 0; round < 3; ++round) {
                const std::size_t before = resident_bytes();
                reserve_heap(0);
                if (!uses(64 * kMiB)) return 1;
                if (resident_bytes() < before + 60 * kMiB) return 2;
                release_heap();
                if (resident_bytes() > before + 8 * kMiB) return 3;
              }
              return 0;
            }),
            0);
}

// The limit is the request's, whatever was set aside: nearly all of it can be used, more cannot.
TEST_F(Heap, LimitsHoldAsBefore) {
  EXPECT_EQ(status_of([] {
              prepare_heap();
              apply_limits({256 * kMiB, 0});
              reserve_heap(256 * kMiB);
              if (!uses(200 * kMiB)) return 1;
              return uses(300 * kMiB) ? 2 : 0;
            }),
            0);
}

TEST_F(Heap, TinyLimitsAreNoError) {
  EXPECT_EQ(status_of([] {
              prepare_heap();
              reserve_heap(1);
              return uses(kMiB) ? 0 : 1;
            }),
            0);
}

}  // namespace
}  // namespace symcell::server::test
