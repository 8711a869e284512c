#include "server/worker/heap.hpp"

#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

#include "core/base/sanitized.hpp"

namespace symcell::server {
namespace {

constexpr std::size_t kHugePageBytes = std::size_t{2}
                                       << 20;  // of x86-64 and of arm64 with 4 kB pages
// Addresses that are set aside count as used, for the process's limit and for what the system may
// promise in all: at most these shares of them.
constexpr std::uint64_t kShareOfLimit = 2;
constexpr std::uint64_t kShareOfMachine = 4;

std::uint64_t machine_bytes() {
  const long pages = ::sysconf(_SC_PHYS_PAGES), size = ::sysconf(_SC_PAGESIZE);
  return pages > 0 && size > 0
             ? static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(size)
             : 0;
}

}  // namespace

void prepare_heap() {
  if (kSanitized) return;
  // NOLINTBEGIN(concurrency-mt-unsafe): there is one thread yet.
  ::mallopt(M_ARENA_MAX, 1);
  ::mallopt(M_MMAP_MAX, 0);
  ::mallopt(M_TRIM_THRESHOLD, -1);  // never by itself (mallopt(3))
  // NOLINTEND(concurrency-mt-unsafe)
}

void reserve_heap(std::uint64_t limit_bytes) {
  if (kSanitized) return;
  std::uint64_t bytes = machine_bytes() / kShareOfMachine;
  if (limit_bytes > 0) bytes = std::min(bytes, limit_bytes / kShareOfLimit);
  if (bytes < 2 * kHugePageBytes) return;
  void* block = std::malloc(bytes);
  if (block == nullptr) return;
  const std::size_t before = reinterpret_cast<std::uintptr_t>(block) % kHugePageBytes;
  const std::size_t skipped = before == 0 ? 0 : kHugePageBytes - before;
  const std::size_t whole = (bytes - skipped) / kHugePageBytes * kHugePageBytes;
  // Where the system has no huge pages this fails, and the heap is one of small pages.
  ::madvise(static_cast<char*>(block) + skipped, whole, MADV_HUGEPAGE);
  std::free(block);
}

void release_heap() {
  ::malloc_trim(0);
}

}  // namespace symcell::server
