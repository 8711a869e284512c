// A case in a process of its own: one that breaks an invariant, which ends the process, is one that
// fails, and a run over thousands goes on.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace symcell {

// What `judge` returns, one line each; if its process ends otherwise, one line that says so.
[[nodiscard]] std::vector<std::string> judged_in_child(
    const std::function<std::vector<std::string>()>& judge);

}  // namespace symcell
