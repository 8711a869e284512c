#include "server/worker/heap.hpp"

#include <fcntl.h>
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
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
// What an idle process may keep: a small job takes less, and would take as long to get its pages anew as to
// mesh.
constexpr std::uint64_t kKeptBytes = std::uint64_t{24} << 20U;

bool is_reserved = false;
std::uint64_t reserved_for = 0;  // the limit that it was reserved for

// 0: not known.
std::uint64_t resident_bytes() {
  const int file = ::open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  if (file < 0) return 0;
  std::array<char, 128> text{};
  const ssize_t got = ::read(file, text.data(), text.size() - 1);
  ::close(file);
  if (got <= 0) return 0;
  char* rest = nullptr;
  std::strtoull(text.data(), &rest, 10);  // all addresses
  return std::strtoull(rest, nullptr, 10) * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

void give_back() {
  ::malloc_trim(0);
  is_reserved = false;
}

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
  if (is_reserved && reserved_for == limit_bytes) return;
  // Addresses that are set aside already are beyond what a lower limit can refuse.
  if (is_reserved) give_back();
  is_reserved = true;
  reserved_for = limit_bytes;
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
  const std::uint64_t resident = resident_bytes();
  if (resident == 0 || resident > kKeptBytes) give_back();
}

}  // namespace symcell::server
