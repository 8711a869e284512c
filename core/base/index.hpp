// Numbers of things are signed in 32 bits, -1 for none, as in the files; containers want theirs unsigned.
#pragma once

#include <cstddef>
#include <cstdint>

namespace symcell {

// Of a number that is known not to be negative.
constexpr std::size_t at(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

}  // namespace symcell
