// What a deck of one mesh will say beside nodes and elements, checked before a byte is written: which
// group is held, which material a region has, whether the bounds can be expressed.
#pragma once

#include <vector>

#include "api/formats/decks/bound_nodes.hpp"
#include "api/formats/decks/deck_groups.hpp"
#include "api/formats/decks/deck_options.hpp"

namespace symcell::internal {

struct DeckPlan {
  explicit DeckPlan(MeshStream& mesh) : groups(mesh) {}

  MeshGroups groups;
  DeckNames names;
  BoundNodes bounds;  // of the cell; empty for a full mesh
  std::vector<ElementSide> sides;
  std::vector<const Material*> materials;  // per region group; empty: none given
  std::vector<std::size_t> support;        // marker groups
  std::vector<std::uint8_t> held;          // per node of the cell: a copy of it is in `support`
  std::int64_t held_nodes = 0;             // of the file; no fewer than there are
  std::vector<std::pair<std::size_t, double>> loads;  // marker group, pressure
  double size = 0;                                    // diagonal of the cell's nodes
  double position_tolerance = 0;  // within which a copy lies where it should, input units
};

// `longest`: bytes of a name.  `options` must outlive the plan.
// Errors: kBadOption (a group or region that is not there, a region without a material, options that
// the analysis does not go with), kUnsupportedModel (what is held, loaded or made of differs between
// sectors and the cell stands for all).
[[nodiscard]] Result<DeckPlan> plan_deck(MeshStream& mesh,
                                         const DeckOptions& options,
                                         std::size_t longest,
                                         std::span<const std::string_view> reserved);

// The materials in use, each once, in the order of the regions, with names of their own.
struct NamedMaterial {
  std::string name;
  const Material* material = nullptr;
};
[[nodiscard]] std::vector<NamedMaterial> named_materials(const DeckPlan& plan);
// The position of a region group's material in that list.
[[nodiscard]] std::size_t material_index(const std::vector<NamedMaterial>& materials,
                                         const Material* material);

}  // namespace symcell::internal
