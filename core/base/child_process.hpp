// Runs foreign code that may abort, loop or eat memory in a child process of its own and hands back
// the bytes that it wrote.
//
// The child is a fork without exec: `body` sees the caller's memory as it was, and nothing that it
// does there comes back but its bytes. It prints nowhere, leaves no core file, dies with its parent
// and by its limits; the parent kills it once the context is exhausted. `body` must not touch
// locks that other threads may hold; malloc and stdio are safe (glibc resets them in the child).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"

namespace symcell {

struct ChildLimits {
  std::uint64_t cpu_seconds = 60;
  std::uint64_t memory_bytes = 0;  // of address space beyond the parent's; 0: none
};

// Where the child puts its result, piece by piece.
class ChildOutput {
 public:
  explicit ChildOutput(int descriptor) : descriptor_(descriptor) {}
  void write(std::span<const std::byte> bytes);
  template <class T>
  void write_array(const std::vector<T>& items) {
    write(std::as_bytes(std::span(items)));
  }
  [[nodiscard]] bool good() const { return good_; }

 private:
  int descriptor_;
  bool good_ = true;
};

// How a child ended that did not end well.
enum class ChildFailure : std::uint8_t {
  kNone,
  kRefused,  // `body` returned false or threw
  kCrashed,  // a signal, or exit() by the foreign code
  kCpuLimit
};

struct ChildResult {
  ChildFailure failure = ChildFailure::kNone;
  std::vector<std::byte> bytes;  // empty on failure
};

// Errors: kInternal (no process or memory to be had), limits of the context.
[[nodiscard]] Result<ChildResult> run_in_child(const std::function<bool(ChildOutput&)>& body,
                                               const ChildLimits& limits,
                                               ExecutionContext& context);

}  // namespace symcell
