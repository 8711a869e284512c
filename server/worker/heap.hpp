// How a process that meshes gets its memory from the system: one heap on huge pages. A mesher grows
// large arrays and gives them back again and again; with the allocator's defaults each goes through
// the kernel, a page of 4 kB at a time, which took up to half of a job's processor time.
#pragma once

#include <cstdint>

namespace symcell::server {

// For the whole process, before it has more threads: all threads allocate from one heap, large blocks
// too, and what is freed stays with the process until release_heap.
void prepare_heap();

// Sets aside addresses (no memory) for the heap to grow into on huge pages, where the system has them.
// `limit_bytes`: what the process may use (apply_limits), 0: no limit. Call it before work begins, and
// again before each request: a heap that was kept is reserved anew only for another limit.
void reserve_heap(std::uint64_t limit_bytes);

// Between requests: gives what is free back to the system if the process has grown.
void release_heap();

}  // namespace symcell::server
