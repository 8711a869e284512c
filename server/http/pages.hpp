// Texts compiled into the program: the description and the pages.
#pragma once

#include <string_view>

namespace symcell::server {

[[nodiscard]] std::string_view openapi_yaml();
[[nodiscard]] std::string_view index_page();
[[nodiscard]] std::string_view docs_page();

}  // namespace symcell::server
