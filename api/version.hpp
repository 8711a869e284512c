// The program's version, as `symcell --version` and the statistics report it.
#pragma once

#include <string_view>

namespace symcell {

[[nodiscard]] std::string_view version();

}  // namespace symcell
