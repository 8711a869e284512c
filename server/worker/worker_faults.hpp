// Faults on purpose, for tests; see worker_main.hpp.
#pragma once

#include <cstdint>

namespace symcell::server {

// Does what SYMCELL_WORKER_FAULTS says for this seed, if anything.
void fault_on_purpose(std::uint64_t seed);

}  // namespace symcell::server
