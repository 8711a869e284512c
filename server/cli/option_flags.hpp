// The meshing options as command-line flags, from the table that JSON and query strings share.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/model/mesh_options.hpp"

namespace CLI {
class App;
}

namespace symcell::cli {

class OptionFlags {
 public:
  // Adds a flag an option; keeps a reference into this object, which must outlive the parsing.
  void add_to(CLI::App& command);
  // After parsing.  Errors: kBadOption, kBadFold, kBadAxis.
  [[nodiscard]] Result<MeshOptions> options() const;
  // Names and values as texts, in the order of the command line; of switches the value is empty.
  [[nodiscard]] const std::vector<std::pair<std::string, std::string>>& given() const {
    return given_;
  }

 private:
  std::vector<std::pair<std::string, std::string>> given_;
};

// The memory limit alone, of commands that mesh nothing.
void add_memory_limit(CLI::App& command, std::string& target);
// 0: none. Errors: kBadOption.
[[nodiscard]] Result<std::uint64_t> memory_limit_bytes(const std::string& given);

}  // namespace symcell::cli
