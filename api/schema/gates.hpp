// Conditions on the figures of a mesh that make it unacceptable: the option `fail_on`.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"

namespace symcell {

// "cell.min_dihedral_deg<20": true of a mesh that is not wanted.
struct Gate {
  std::string figure;      // a path of names and indices with dots between them
  std::string comparison;  // <, <=, >, >=, ==, !=
  double bound = 0;
};

// Nothing if the text is no comparison of a figure with a number.
[[nodiscard]] std::optional<Gate> parse_gate(std::string_view text);

struct GateResult {
  std::string text;  // of the gate
  bool failed = false;
  std::string detail;  // what the figure is, or that there is none
};

// `statistics`: the document. A figure that it has not, or that is no number, fails: a misspelt gate
// would let everything through. A list counts by its length.
[[nodiscard]] std::vector<GateResult> judge(const std::vector<std::string>& gates,
                                            const nlohmann::ordered_json& statistics);

// Errors: kGateFailed, which lists those that failed.
[[nodiscard]] Result<void> check_gates(const std::vector<GateResult>& results);

}  // namespace symcell
