// Looks at a JSON body while it arrives, and finds what no model may be long before the body is whole: lists in
// lists without end, more vertices or segments than are taken. It does not check the grammar; whoever reads the
// document does.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "api/formats/json_walker.hpp"
#include "core/base/error.hpp"

namespace symcell::server {

class JsonGuard {
 public:
  // False: stop, error() says why. Errors: kJsonSyntax, kTooLarge.
  [[nodiscard]] bool pass(std::string_view piece);
  // After pass() has returned false.
  [[nodiscard]] const Error& error() const { return *error_; }

  // Those of the reader, and the object around the model.
  static constexpr std::size_t kMostDepth = internal::kMostJsonDepth + 1;

 private:
  struct Level {
    bool is_list = false;
    std::uint64_t limit = 0;  // of the list's members; 0: none
    std::uint64_t members = 0;
  };

  [[nodiscard]] bool open(bool is_list);
  [[nodiscard]] bool count_member();
  bool refuse(ErrorCode code, std::string message);

  std::array<Level, kMostDepth> levels_{};
  std::size_t depth_ = 0;
  bool in_string_ = false;
  bool escaped_ = false;
  std::string text_;  // of the last string, as far as a name of interest is long
  std::optional<Error> error_;
};

}  // namespace symcell::server
