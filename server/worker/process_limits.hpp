// What a process that meshes for another does to itself: limits, signals, ties to its parent. Each
// call changes the whole process.
#pragma once

#include <sys/types.h>

#include <cstdint>

namespace symcell::server {

// What a worker may use for one request. 0: no limit.
struct WorkerLimits {
  std::uint64_t memory_bytes = 0;
  std::uint64_t cpu_seconds = 0;
  std::uint64_t file_bytes = 0;  // of each file it writes
  friend bool operator==(const WorkerLimits&, const WorkerLimits&) = default;
};

// How a worker ends that was refused memory: at once, from inside the allocation, for libraries
// need not survive a failed one. The parent turns this status into kMemoryLimit.
inline constexpr int kMemoryExitStatus = 86;
// Started by a parent that had died already, or not by a server at all.
inline constexpr int kOrphanExitStatus = 87;

// Default signal handling, no core files, allocation failures end the process (in this process:
// children that it forks get std::bad_alloc).
void prepare_worker_process();

// From now on this process and its process group die with `parent`; exits if that is gone already.
// The kernel means the parent's thread that started this process.
void die_with_parent(pid_t parent);

// Kills the process group, this process included. Requires: the group is this process's own.
[[noreturn]] void end_process_group();

// For the request that begins now: memory (heap and private mappings, not mapped files) and
// processor time from now on, bytes of a file; 0: none. Not under sanitizers, whose shadow memory passes any limit.
void apply_limits(const WorkerLimits& limits);

// The peak of resident memory is counted from here on; see peak_resident_bytes.
void reset_peak_memory();
// Since reset_peak_memory, or the start where the kernel does not reset it.
[[nodiscard]] std::uint64_t peak_resident_bytes();

}  // namespace symcell::server
