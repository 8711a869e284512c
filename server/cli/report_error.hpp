// How the commands report errors and warnings: on standard error, the first line says what, where
// and how to mend; or the problem document of the HTTP interface.
#pragma once

#include <string>

#include "core/base/error.hpp"

namespace symcell::cli {

// Returns the exit code: 1 meshing failed, 2 wrong usage, 3 the model is not acceptable, 4 a limit.
[[nodiscard]] int report_error(const Error& error, bool as_json);

// `warnings`: a JSON array as of warnings_to_json, as text; says nothing if it is empty.
void report_warnings(const std::string& warnings, bool as_json);

}  // namespace symcell::cli
