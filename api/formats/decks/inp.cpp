#include "api/formats/decks/inp.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <string>

#include "api/formats/decks/deck_numbers.hpp"
#include "api/formats/turn_map.hpp"
#include "core/base/index.hpp"

namespace symcell::internal {
namespace {

// CalculiX reads no more of a number.
constexpr std::size_t kFieldBytes = 20;
// Of a set's name CalculiX and Abaqus read 80 bytes; "_support" is put behind some.
constexpr std::size_t kLongestName = 64;
// Position tolerances that nodes of one tie are apart at least: none is in reach of another's image.
constexpr double kApart = 4;
// Ties with cyclic symmetry that CalculiX takes.
constexpr std::size_t kMostTies = 99;
// Entries of rotations and of unit vectors below this are what rounding leaves of 0.
constexpr double kRoundingOfZero = 1e-15;
constexpr int kEntriesPerLine = 10;         // of a set; 16 are allowed
constexpr std::int64_t kModes = 10;         // of a nodal diameter
constexpr std::int64_t kFullModes = 20;     // of a full mesh, where most come in pairs
constexpr std::int64_t kLeastFreedoms = 5;  // per mode: CalculiX's subspace is so large

constexpr std::array<std::string_view, 5> kReserved{"NALL", "EALL", "SUPPORT", "LOWER_BOUND",
                                                    "HIGHER_BOUND"};

std::string number(double value) {
  return fitting_number(value, kFieldBytes);
}

void put(ByteWriter& out, std::initializer_list<std::string_view> pieces) {
  for (const std::string_view piece : pieces) out.text(piece);
}

// Entries of a set, several a line.
class SetLines {
 public:
  explicit SetLines(ByteWriter& out) : out_(&out) {}
  ~SetLines() {
    if (on_line_ > 0) out_->character('\n');
  }
  SetLines(const SetLines&) = delete;
  SetLines& operator=(const SetLines&) = delete;

  void put(std::int64_t id) {
    if (on_line_ == kEntriesPerLine) {
      out_->text(",\n");
      on_line_ = 0;
    }
    if (on_line_++ > 0) out_->text(", ");
    out_->integer(id);
  }

 private:
  ByteWriter* out_;
  int on_line_ = 0;
};

std::string_view element_type(const SymmetryCellMesh& cell, bool plane_strain) {
  if (cell.dimension == 3) return cell.order == 1 ? "C3D4" : "C3D10";
  if (plane_strain) return cell.order == 1 ? "CPE3" : "CPE6";
  return cell.order == 1 ? "CPS3" : "CPS6";
}

}  // namespace

Result<InpDeck> InpDeck::plan(MeshStream& mesh, const DeckOptions& options) {
  auto plan = plan_deck(mesh, options, kLongestName, kReserved);
  if (!plan) return error_of(plan);
  InpDeck deck(mesh, options, std::move(*plan));
  SYMCELL_TRY(deck.choose_ties());
  return deck;
}

bool InpDeck::equations() const {
  return options_->analysis == Analysis::kStatic && !plan_.bounds.empty();
}

Result<void> InpDeck::choose_ties() {
  const BoundNodes& bounds = plan_.bounds;
  const bool planar = mesh_->cell().dimension == 2;
  if (equations() && planar && !options_->plane_strain) {
    return fail(ErrorCode::kUnsupportedModel,
                "CalculiX gives plane stress elements a thickness of their own, which no equation "
                "ties across the bounds, and is then off by up to 0.5 %: take plane=strain, or the "
                "full mesh");
  }
  if (bounds.empty() || equations()) return {};
  if (planar) {
    if (options_->analysis == Analysis::kNone) return {};
    return fail(
        ErrorCode::kUnsupportedModel,
        "CalculiX and Abaqus have no cyclic symmetry for plane elements: take the full mesh "
        "for modes, or analysis=static with plane=strain");
  }
  if (bounds.beyond_pairs >= 0) {
    const std::string node = std::to_string(bounds.beyond_pairs + 1);
    return fail(ErrorCode::kUnsupportedModel,
                "the cell has copies of node " + node +
                    " that are not just its neighbours', which CalculiX's cyclic symmetry cannot "
                    "express: take the full mesh, or analysis=static",
                {bounds.beyond_pairs});
  }
  // Nodes on the axis that are held need no tie, and may have none.
  ties_ = distinct_groups(mesh_->cell(), bounds, plan_.held, kApart * plan_.position_tolerance);
  tied_axis_ = std::ranges::any_of(bounds.axis,
                                   [&](std::int32_t node) { return plan_.held[at(node)] == 0; });
  if (ties_.size() <= kMostTies) return {};
  return fail(ErrorCode::kUnsupportedModel,
              "up to " + std::to_string(ties_.size()) +
                  " nodes of a bound have the same distance from the axis and height, of which "
                  "CalculiX's cyclic symmetry tells " +
                  std::to_string(kMostTies) + " apart: take the full mesh, or analysis=static");
}

void InpDeck::write(ByteWriter& out) {
  write_head(out);
  write_nodes(out);
  write_elements(out);
  write_groups(out);
  write_materials(out);
  write_ties(out);
  if (equations()) write_equations(out);
  write_supports(out);
  write_steps(out);
}

void InpDeck::write_head(ByteWriter& out) const {
  const SymmetryCellMesh& cell = mesh_->cell();
  out.text("*HEADING\nSymcell\n");
  out.text(mesh_->full() ? "** Full mesh" : "** Symmetry cell");
  out.text(" of a model of fold " + std::to_string(cell.fold) + ".\n");
  out.text(
      "** Sets and surfaces have the names of the model's groups. Of a facet within the material\n"
      "** the surface has one side.\n");
  if (plan_.bounds.empty()) {
    if (!mesh_->full() && cell.fold > 1) {
      out.text("** The sectors do not touch: there is nothing to tie.\n");
    }
    return;
  }
  out.text(
      "** ..._support: the nodes of a group that depend on no others; constraints go on these.\n");
  if (cell.dimension == 2 && !equations()) {
    out.text(
        "** Neither CalculiX nor Abaqus has cyclic symmetry for plane elements: the bounds are\n"
        "** sets of nodes here, equations with analysis=static.\n");
  }
}

void InpDeck::write_nodes(ByteWriter& out) const {
  out.text("*NODE, NSET=NALL\n");
  std::int64_t id = 0;
  mesh_->each_node([&](const Point3& p, std::int32_t) {
    const Point3 clean = without_rounding(p, plan_.size);
    out.integer(++id);
    for (const double c : {clean.x, clean.y, clean.z}) {
      out.text(", ");
      out.text(number(c));
    }
    out.character('\n');
  });
}

void InpDeck::write_elements(ByteWriter& out) {
  const SymmetryCellMesh& cell = mesh_->cell();
  const auto per_sector = static_cast<std::int64_t>(cell.element_count());
  for (std::size_t g = 0; g < plan_.names.regions.size(); ++g) {
    out.text("*ELEMENT, TYPE=");
    out.text(element_type(cell, options_->plane_strain));
    out.text(", ELSET=" + plan_.names.regions[g] + "\n");
    plan_.groups.each_element(
        g, [&](std::span<const std::int64_t> nodes, std::size_t e, std::int32_t s) {
          out.integer(s * per_sector + static_cast<std::int64_t>(e) + 1);
          for (const std::int64_t node : nodes) {
            out.text(", ");
            out.integer(node + 1);
          }
          out.character('\n');
        });
  }
  out.text("*ELSET, ELSET=EALL\n");
  for (const std::string& name : plan_.names.regions) out.text(name + "\n");
}

void InpDeck::write_groups(ByteWriter& out) {
  const SymmetryCellMesh& cell = mesh_->cell();
  const auto per_sector = static_cast<std::int64_t>(cell.element_count());
  for (std::size_t g = 0; g < plan_.names.markers.size(); ++g) {
    const std::string& name = plan_.names.markers[g];
    out.text("*NSET, NSET=" + name + "\n");
    {
      SetLines lines(out);
      each_marker_node(*mesh_, plan_.groups, g, [&](std::int64_t node) { lines.put(node + 1); });
    }
    out.text("*SURFACE, NAME=" + name + ", TYPE=ELEMENT\n");
    plan_.groups.each_facet(g, [&](std::span<const std::int64_t>, std::size_t b, std::int32_t s) {
      const ElementSide side = plan_.sides[b];
      out.integer(s * per_sector + std::int64_t{side.element} + 1);
      out.text(", S");
      out.integer(side.side + 1);
      out.character('\n');
    });
  }
  if (plan_.bounds.empty()) return;
  for (const bool lower : {true, false}) {
    out.text(lower ? "*NSET, NSET=LOWER_BOUND\n" : "*NSET, NSET=HIGHER_BOUND\n");
    SetLines lines(out);
    for (const NodeCopy& copy : plan_.bounds.copies) {
      lines.put((lower ? copy.dependent : copy.independent) + 1);
    }
    for (const std::int32_t node : plan_.bounds.axis) lines.put(node + 1);
  }
  // Off the axis every orbit has one node that depends on no other.
  std::vector<std::int64_t> free_of_orbit(cell.orbit_points.size(), -1);
  for (std::size_t i = 0; i < cell.nodes.size(); ++i) {
    if (plan_.bounds.dependent[i] != 0) continue;
    free_of_orbit[at(cell.nodes[i].orbit)] = static_cast<std::int64_t>(i);
  }
  for (std::size_t g = 0; g < plan_.names.markers.size(); ++g) {
    std::vector<std::int64_t> nodes;
    each_marker_node(*mesh_, plan_.groups, g, [&](std::int64_t node) {
      const auto orbit = at(cell.nodes[static_cast<std::size_t>(node)].orbit);
      if (free_of_orbit[orbit] >= 0) nodes.push_back(free_of_orbit[orbit]);
    });
    if (nodes.empty()) continue;
    std::ranges::sort(nodes);
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    out.text("*NSET, NSET=" + plan_.names.markers[g] + kSupportEnding + "\n");
    SetLines lines(out);
    for (const std::int64_t node : nodes) lines.put(node + 1);
  }
}

// Held nodes: those that depend on others follow these. On the axis nothing is tied that is held.
void InpDeck::write_supports(ByteWriter& out) {
  if (plan_.support.empty()) return;
  const SymmetryCellMesh& cell = mesh_->cell();
  out.text("*NSET, NSET=SUPPORT\n");
  if (mesh_->full()) {
    for (const std::size_t g : plan_.support) out.text(plan_.names.markers[g] + "\n");
  } else {
    SetLines lines(out);
    for (std::size_t i = 0; i < cell.nodes.size(); ++i) {
      const bool axis = cell.on_axis[at(cell.nodes[i].orbit)] != 0;
      if (plan_.held[i] != 0 && (plan_.bounds.dependent[i] == 0 || axis)) {
        lines.put(static_cast<std::int64_t>(i) + 1);
      }
    }
  }
  out.text(cell.dimension == 2 ? "*BOUNDARY\nSUPPORT, 1, 2\n" : "*BOUNDARY\nSUPPORT, 1, 3\n");
}

void InpDeck::write_materials(ByteWriter& out) const {
  const std::vector<NamedMaterial> materials = named_materials(plan_);
  for (const NamedMaterial& m : materials) {
    out.text("** " + m.name + ": units are " + m.material->units +
             "; the model's lengths are taken to be in these.\n");
    out.text("*MATERIAL, NAME=" + m.name + "\n*ELASTIC\n" + number(m.material->modulus) + ", " +
             number(m.material->poisson_ratio) + "\n*DENSITY\n" + number(m.material->density) +
             "\n");
  }
  for (std::size_t g = 0; g < plan_.materials.size(); ++g) {
    out.text("*SOLID SECTION, ELSET=" + plan_.names.regions[g] +
             ", MATERIAL=" + materials[material_index(materials, plan_.materials[g])].name + "\n");
    // The thickness.
    if (mesh_->cell().dimension == 2) out.text("1.\n");
  }
}

void InpDeck::write_ties(ByteWriter& out) const {
  if (ties_.empty()) return;
  const SymmetryCellMesh& cell = mesh_->cell();
  out.text(
      "** CalculiX looks for a node's image by its distance from the axis and its height alone: "
      "in\n"
      "** each group these differ. Abaqus takes one tie, and no TIE= and ELSET= with the model.\n");
  const std::string tolerance = number(plan_.position_tolerance);
  for (std::size_t t = 0; t < ties_.size(); ++t) {
    const std::string ending = std::to_string(t);
    for (const bool lower : {true, false}) {
      out.text((lower ? "*SURFACE, NAME=LOWER" : "*SURFACE, NAME=HIGHER") + ending +
               ", TYPE=NODE\n");
      for (const NodePair& pair : ties_[t]) {
        out.integer((lower ? pair.lower : pair.higher) + 1);
        out.character('\n');
      }
    }
    put(out, {"*TIE, CYCLIC SYMMETRY, NAME=TIE", ending, ", POSITION TOLERANCE=", tolerance,
              "\nLOWER", ending, ", HIGHER", ending, "\n"});
  }
  const Point3& o = cell.axis_origin;
  const Point3 end = o + cell.axis_direction;
  for (std::size_t t = 0; t < ties_.size(); ++t) {
    out.text("*CYCLIC SYMMETRY MODEL, N=" + std::to_string(cell.fold) + ", TIE=TIE" +
             std::to_string(t) + ", ELSET=EALL\n");
    out.text(number(o.x) + ", " + number(o.y) + ", " + number(o.z) + ", " + number(end.x) + ", " +
             number(end.y) + ", " + number(end.z) + "\n");
  }
}

// u(dependent) = Q u(independent), in global axes.
void InpDeck::write_equations(ByteWriter& out) const {
  const SymmetryCellMesh& cell = mesh_->cell();
  const auto d = static_cast<std::size_t>(cell.dimension);
  out.text("** What repeats with the sectors: displacements turn with the nodes.\n");
  for (const NodeCopy& copy : plan_.bounds.copies) {
    const auto rotation = turn_map(mesh_->view(), copy.exponent).rotation;
    for (std::size_t i = 0; i < d; ++i) {
      std::string terms =
          std::to_string(copy.dependent + 1) + ", " + std::to_string(i + 1) + ", 1.";
      int count = 1;
      for (std::size_t j = 0; j < d; ++j) {
        if (std::abs(rotation[i][j]) < kRoundingOfZero) continue;
        terms += ", " + std::to_string(copy.independent + 1) + ", " + std::to_string(j + 1) + ", " +
                 number(-rotation[i][j]);
        ++count;
      }
      out.text("*EQUATION\n" + std::to_string(count) + "\n" + terms + "\n");
    }
  }
  write_axis_equations(out);
}

// On the axis what repeats lies along it.
void InpDeck::write_axis_equations(ByteWriter& out) const {
  const SymmetryCellMesh& cell = mesh_->cell();
  const std::array<double, 3> axis{cell.axis_direction.x, cell.axis_direction.y,
                                   cell.axis_direction.z};
  const auto d = static_cast<std::size_t>(cell.dimension);
  const auto along = static_cast<std::size_t>(
      std::ranges::max_element(axis, {}, [](double c) { return std::abs(c); }) - axis.begin());
  for (const std::int32_t node : plan_.bounds.axis) {
    if (plan_.held[at(node)] != 0) continue;
    const std::string id = std::to_string(node + 1);
    for (std::size_t i = 0; i < d; ++i) {
      if (i == along) continue;
      const std::string direction = std::to_string(i + 1);
      const double share = axis[i] / axis[along];
      if (std::abs(share) < kRoundingOfZero) {
        put(out, {"*BOUNDARY\n", id, ", ", direction, ", ", direction, "\n"});
      } else {
        put(out, {"*EQUATION\n2\n", id, ", ", direction, ", 1., ", id, ", ",
                  std::to_string(along + 1), ", ", number(-share), "\n"});
      }
    }
  }
}

std::int64_t InpDeck::modes() const {
  std::int64_t free = mesh_->node_count();
  for (const NodeCopy& copy : plan_.bounds.copies) {
    free -= plan_.held[at(copy.dependent)] != 0 ? 0 : 1;
  }
  free -= plan_.held_nodes + static_cast<std::int64_t>(plan_.bounds.axis.size());
  const std::int64_t most = mesh_->cell().dimension * free / kLeastFreedoms - 1;
  return std::clamp<std::int64_t>(most, 1, mesh_->full() ? kFullModes : kModes);
}

void InpDeck::write_modal_step(ByteWriter& out, std::int32_t from, std::int32_t to) const {
  out.text("*STEP\n*FREQUENCY\n" + std::to_string(modes()) + "\n");
  if (!ties_.empty()) {
    out.text("*SELECT CYCLIC SYMMETRY MODES, NMIN=" + std::to_string(from) +
             ", NMAX=" + std::to_string(to) + "\n");
  }
  out.text("*NODE FILE\nU\n*END STEP\n");
}

void InpDeck::write_steps(ByteWriter& out) const {
  if (options_->analysis == Analysis::kStatic) {
    out.text("*STEP\n*STATIC\n");
    for (const auto& [g, pressure] : plan_.loads) {
      out.text("*DSLOAD\n" + plan_.names.markers[g] + ", P, " + number(pressure) + "\n");
    }
    out.text("*NODE FILE\nU\n*EL FILE\nS\n*END STEP\n");
  }
  if (options_->analysis != Analysis::kModal) return;
  const std::int32_t last = mesh_->cell().fold / 2;
  if (!tied_axis_) return write_modal_step(out, 0, last);
  out.text(
      "** Nodes on the axis move along it at nodal diameter 0, across it at 1, and not at all from "
      "2\n"
      "** on: a step each. At 1 CalculiX 2.20 is off by 0.1 to 12 % where nodes lie on the axis; "
      "the\n"
      "** full mesh gives these modes.\n");
  write_modal_step(out, 0, 0);
  write_modal_step(out, 1, 1);
  if (last >= 2) write_modal_step(out, 2, last);
}

}  // namespace symcell::internal
