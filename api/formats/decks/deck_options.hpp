// What a solver's deck holds beside the mesh: options of the output, not of the mesh. They are
// texts on the command line and in the query alike.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"

namespace symcell {

enum class Analysis : std::uint8_t { kNone, kModal, kStatic };

struct Material {
  std::string name;    // "steel"; "material" for one given by numbers
  std::string units;   // what the numbers are in, for a comment
  double modulus = 0;  // Young's
  double poisson_ratio = 0;
  double density = 0;
  friend bool operator==(const Material&, const Material&) = default;
};

struct RegionMaterial {
  std::optional<std::int32_t> region;  // its attribute; none: of all regions not named
  Material material;
  friend bool operator==(const RegionMaterial&, const RegionMaterial&) = default;
};

struct GroupLoad {
  std::string group;  // marker, by name or number
  double pressure = 1;
  friend bool operator==(const GroupLoad&, const GroupLoad&) = default;
};

struct DeckOptions {
  Analysis analysis = Analysis::kNone;
  bool plane_strain = false;
  std::vector<RegionMaterial> materials;
  std::vector<std::string> support;  // groups whose nodes are held
  std::vector<GroupLoad> loads;
  friend bool operator==(const DeckOptions&, const DeckOptions&) = default;
};

struct DeckOptionInfo {
  std::string_view name;  // "analysis"
  std::string_view metavar;
  std::string_view standard;  // the default, as text; empty: none
  std::string_view help;
};

[[nodiscard]] std::span<const DeckOptionInfo> deck_option_table();

// Errors: kBadOption, naming what is acceptable.
[[nodiscard]] Result<void> set_deck_option(DeckOptions& options,
                                           std::string_view name,
                                           std::string_view text);

}  // namespace symcell
