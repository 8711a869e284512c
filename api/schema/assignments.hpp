// Lists of what gets which number, as options have them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/model/mesh_options.hpp"

namespace symcell::internal {

// Of a list "marker:3=0.5,vertex:17=0.02,region:2=1,point:0/1.5/2=0.1,bore=0.2".
struct Assignment {
  SizeRequest::Kind kind = SizeRequest::Kind::kMarker;
  std::int64_t id = 0;
  double value = 0;
  std::string name;  // of a group
  Point3 point;
};

// Nothing if the text is no such list, or a value is not above 0 and finite.
[[nodiscard]] std::optional<std::vector<Assignment>> read_assignments(std::string_view text);

// As read_assignments reads them.
[[nodiscard]] std::string sizes_as_text(const std::vector<SizeRequest>& sizes);

}  // namespace symcell::internal
