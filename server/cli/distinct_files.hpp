// What a command reads and writes must be files apart: outputs are renamed into place when all is done, so of two
// with one name only the last would be left, and an output with the name of a model would be left in its stead.
#pragma once

#include <string>
#include <vector>

#include "core/base/error.hpp"

namespace symcell::cli {

struct NamedFile {
  std::string role;  // as users know it: "--cell", "the model"
  std::string path;  // "-": a standard stream; empty: not given
};

// By what the names lead to, through symbolic and hard links; of files that do not exist yet, by their paths.
// Devices may be given as often as one likes; inputs may be the same.  Errors: kBadOption.
[[nodiscard]] Result<void> check_distinct(const std::vector<NamedFile>& inputs,
                                          const std::vector<NamedFile>& outputs);

}  // namespace symcell::cli
