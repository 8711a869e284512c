// Comparison with a file under tests/golden/expected; UPDATE_GOLDEN=1 rewrites it instead.
#pragma once

#include <string_view>

namespace symcell::test {

void expect_golden(std::string_view name, std::string_view text);

}  // namespace symcell::test
