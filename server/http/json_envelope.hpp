// The request {"model": ..., "options": ...} cut into its members without building a tree: a model
// may be hundreds of megabytes, and its own parser is to see its bytes as they came.
#pragma once

#include <string_view>

#include "core/base/error.hpp"

namespace symcell::server {

struct EnvelopeParts {
  std::string_view model;    // JSON text; the whole body if it is a bare model
  std::string_view options;  // JSON text; empty: none given
  bool bare = false;         // the body is the model itself (it has "type" and no "model")
};

// The members' values are cut out, not checked: whoever parses them finds what is wrong inside.
// Errors: kEmptyFile, kJsonSyntax, kWrongType, kMissingField; pointers are complete ("/model").
[[nodiscard]] Result<EnvelopeParts> split_envelope(std::string_view body);

}  // namespace symcell::server
