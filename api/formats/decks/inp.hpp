// Decks for CalculiX, and for Abaqus as far as its keywords are the same.
#pragma once

#include "api/formats/byte_writer.hpp"
#include "api/formats/decks/deck_plan.hpp"

namespace symcell::internal {

// Nodes, elements by region, node sets and element surfaces by marker, the bounds, and, if asked for,
// materials and a step. How the bounds are expressed:
// - for modes, one *TIE and one *CYCLIC SYMMETRY MODEL per group of nodes that are distinct in (r, z),
//   since CalculiX looks for images there alone;
// - for static loads that repeat with the sectors, an *EQUATION per node and direction;
// - of planar meshes by equations only: neither program has cyclic symmetry for plane elements.
class InpDeck {
 public:
  // `options` and `mesh` must outlive the deck.  Errors: as plan_deck, and kUnsupportedModel where
  // the program cannot express the bounds.
  [[nodiscard]] static Result<InpDeck> plan(MeshStream& mesh, const DeckOptions& options);

  void write(ByteWriter& out);

 private:
  InpDeck(MeshStream& mesh, const DeckOptions& options, DeckPlan plan)
      : mesh_(&mesh), options_(&options), plan_(std::move(plan)) {}

  [[nodiscard]] bool equations() const;
  [[nodiscard]] Result<void> choose_ties();
  void write_head(ByteWriter& out) const;
  void write_nodes(ByteWriter& out) const;
  void write_elements(ByteWriter& out);
  void write_groups(ByteWriter& out);
  void write_supports(ByteWriter& out);
  void write_materials(ByteWriter& out) const;
  void write_ties(ByteWriter& out) const;
  void write_equations(ByteWriter& out) const;
  void write_axis_equations(ByteWriter& out) const;
  void write_steps(ByteWriter& out) const;
  void write_modal_step(ByteWriter& out, std::int32_t from, std::int32_t to) const;
  [[nodiscard]] std::int64_t modes() const;

  MeshStream* mesh_;
  const DeckOptions* options_;
  DeckPlan plan_;
  std::vector<std::vector<NodePair>> ties_;
  bool tied_axis_ = false;  // a tie has nodes on the axis
};

}  // namespace symcell::internal
