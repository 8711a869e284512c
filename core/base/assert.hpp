// SYMCELL_ASSERT guards invariants of our own code, in release builds too: a broken invariant means
// a bug, and a wrong mesh is worse than none.
#pragma once

namespace symcell::internal {
[[noreturn]] void assertion_failed(const char* expression, const char* file, int line) noexcept;
}

#define SYMCELL_ASSERT(expression) \
  (static_cast<bool>(expression)   \
       ? void(0)                   \
       : ::symcell::internal::assertion_failed(#expression, __FILE__, __LINE__))
