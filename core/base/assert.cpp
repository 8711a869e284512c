#include "core/base/assert.hpp"

#include <cstdio>
#include <cstdlib>

namespace symcell::internal {

void assertion_failed(const char* expression, const char* file, int line) noexcept {
  std::fprintf(stderr, "symcell: bug: %s does not hold (%s:%d)\n", expression, file, line);
  std::abort();
}

}  // namespace symcell::internal
