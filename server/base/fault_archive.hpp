// What an internal error happened on, kept to be looked into: the model, the options, the error.
//
//   <folder>/<name>/model          as it was given
//   <folder>/<name>/request.json   {"version", "options", "error": a problem document}
//
// Bounded in number and bytes: the oldest cases go first, a model that is too large by itself is
// not kept. Keeping is an aid, never a duty: where the disk refuses, nothing is kept and nothing
// fails.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/error.hpp"

namespace symcell::server {

// $XDG_STATE_HOME/symcell or ~/.local/state/symcell; empty if neither variable is set.
[[nodiscard]] std::filesystem::path default_state_directory();

// Whether the error is ours and not the user's.
[[nodiscard]] bool is_fault(ErrorCode code);

class FaultArchive {
 public:
  static constexpr std::size_t kMostCases = 50;
  static constexpr std::uintmax_t kMostBytes = std::uintmax_t{256} << 20U;

  explicit FaultArchive(std::filesystem::path folder,
                        std::size_t most_cases = kMostCases,
                        std::uintmax_t most_bytes = kMostBytes)
      : folder_(std::move(folder)), most_cases_(most_cases), most_bytes_(most_bytes) {}

  // The case's folder; nullopt: not kept. `options`: a JSON object. A case of the same name is
  // replaced.
  [[nodiscard]] std::optional<std::filesystem::path> keep(std::string_view name,
                                                          const std::filesystem::path& model,
                                                          std::string_view options,
                                                          const Error& error) const noexcept;
  void remove(std::string_view name) const noexcept;

 private:
  void make_room(std::uintmax_t bytes) const;

  std::filesystem::path folder_;
  std::size_t most_cases_;
  std::uintmax_t most_bytes_;
};

}  // namespace symcell::server
