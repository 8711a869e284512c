#include "api/version.hpp"

namespace symcell {

std::string_view version() {
  return SYMCELL_VERSION;
}

}  // namespace symcell
