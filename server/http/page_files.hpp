// The bundle of the pages, compiled into the program: see server/page.
#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace symcell::server {

struct PageFile {
  std::string_view path;  // of its address, "/assets/index-1a2b.js"
  std::string_view media_type;
  std::string_view gzip;  // its bytes, packed
};

// Empty where the program was built without them.
[[nodiscard]] std::span<const PageFile> page_files();

}  // namespace symcell::server
