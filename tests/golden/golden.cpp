#include "tests/golden/golden.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/support/test_files.hpp"

namespace symcell::test {

void expect_golden(std::string_view name, std::string_view text) {
  const auto path =
      std::filesystem::path(SYMCELL_SOURCE_DIR) / "tests" / "golden" / "expected" / name;
  if (std::getenv("UPDATE_GOLDEN") != nullptr) {
    write_file(path, text);
    return;
  }
  ASSERT_TRUE(std::filesystem::exists(path)) << name << ": make it with UPDATE_GOLDEN=1";
  EXPECT_EQ(read_file(path), text) << name << ": if the change is meant, run with UPDATE_GOLDEN=1";
}

}  // namespace symcell::test
