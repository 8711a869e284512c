// For "did you mean": the name that is most like what somebody wrote.
#pragma once

#include <string_view>
#include <vector>

namespace symcell {

// Empty if none is like it: three letters at most may be wrong, missing or too many.  `names` and `given` are short.
[[nodiscard]] std::string_view nearest_name(std::string_view given,
                                            const std::vector<std::string_view>& names);

}  // namespace symcell
