#include "api/formats/decks/nastran.hpp"

#include <algorithm>
#include <string>

#include "api/formats/decks/deck_numbers.hpp"

namespace symcell::internal {
namespace {

constexpr std::int64_t kMostIds = 99'999'999;
constexpr std::size_t kSmallField = 8;
constexpr std::size_t kLargeField = 16;
constexpr int kFieldsPerLine = 8;
constexpr std::int32_t kCylindrical = 1;  // coordinate systems of a cell
constexpr std::int32_t kRectangular = 2;

// Fields of fixed width, continued from line to line.
class Card {
 public:
  Card(ByteWriter& out, std::string_view name, bool large = false)
      : out_(&out),
        width_(large ? kLargeField : kSmallField),
        fields_(large ? 4 : kFieldsPerLine),
        large_(large) {
    text(name, kSmallField);
  }
  ~Card() { out_->character('\n'); }
  Card(const Card&) = delete;
  Card& operator=(const Card&) = delete;

  Card& integer(std::int64_t value) { return field(std::to_string(value)); }
  Card& real(double value) { return field(nastran_number(value, width_)); }
  Card& blank() { return field(""); }
  Card& word(std::string_view value) { return field(value); }

 private:
  Card& field(std::string_view value) {
    if (on_line_ == fields_) {
      out_->character('\n');
      text(large_ ? "*" : "+", kSmallField);
      on_line_ = 0;
    }
    ++on_line_;
    text(value, width_);
    return *this;
  }

  void text(std::string_view value, std::size_t width) {
    out_->text(value);
    for (std::size_t i = value.size(); i < width; ++i) out_->character(' ');
  }

  ByteWriter* out_;
  std::size_t width_;
  int fields_;
  bool large_;
  int on_line_ = 0;
};

void write_systems(const SymmetryCellMesh& cell, ByteWriter& out) {
  const Point3& o = cell.axis_origin;
  const auto& f = cell.frame;
  const Point3 on_axis = o + cell.axis_direction;
  const Point3 in_plane = o + Point3{f[0], f[3], f[6]};
  for (const auto& [name, id] : {std::pair{"CORD2C*", kCylindrical}, {"CORD2R*", kRectangular}}) {
    Card card(out, name, true);
    card.integer(id).blank();
    for (const Point3& p : {o, on_axis, in_plane}) card.real(p.x).real(p.y).real(p.z);
  }
}

void write_nodes(MeshStream& mesh, const DeckPlan& plan, ByteWriter& out) {
  const SymmetryCellMesh& cell = mesh.cell();
  const bool turned = !plan.bounds.empty();
  std::int64_t id = 0;
  mesh.each_node([&](const Point3& p, std::int32_t) {
    const Point3 clean = without_rounding(p, plan.size);
    Card card(out, "GRID*", true);
    card.integer(++id).blank().real(clean.x).real(clean.y).real(clean.z);
    if (!turned) return;
    const OrbitVertex v = cell.nodes[static_cast<std::size_t>(id - 1)];
    const bool axis = cell.on_axis[static_cast<std::size_t>(v.orbit)] != 0;
    card.integer(axis ? kRectangular : kCylindrical);
  });
}

void write_elements(MeshStream& mesh,
                    DeckPlan& plan,
                    const std::vector<std::int32_t>& properties,
                    ByteWriter& out) {
  const SymmetryCellMesh& cell = mesh.cell();
  const auto per_sector = static_cast<std::int64_t>(cell.element_count());
  const char* name = cell.dimension == 3 ? "CTETRA" : cell.order == 1 ? "CTRIA3" : "CTRIA6";
  for (std::size_t g = 0; g < properties.size(); ++g) {
    plan.groups.each_element(
        g, [&](std::span<const std::int64_t> nodes, std::size_t e, std::int32_t s) {
          Card card(out, name);
          card.integer(s * per_sector + static_cast<std::int64_t>(e) + 1).integer(properties[g]);
          for (const std::int64_t node : nodes) card.integer(node + 1);
        });
  }
}

void write_properties(MeshStream& mesh,
                      const DeckPlan& plan,
                      const std::vector<std::int32_t>& properties,
                      ByteWriter& out) {
  const std::vector<NamedMaterial> materials = named_materials(plan);
  for (std::size_t m = 0; m < materials.size(); ++m) {
    const Material& material = *materials[m].material;
    out.text("$ " + materials[m].name + ": units are " + material.units + "\n");
    Card card(out, "MAT1*", true);
    card.integer(static_cast<std::int64_t>(m) + 1).real(material.modulus).blank();
    card.real(material.poisson_ratio).real(material.density);
  }
  if (materials.empty()) out.text("$ No material was given: MAT1 of these numbers are missing.\n");
  for (std::size_t g = 0; g < properties.size(); ++g) {
    out.text("$ " + plan.names.regions[g] + "\n");
    const std::int64_t material =
        materials.empty()
            ? properties[g]
            : static_cast<std::int64_t>(material_index(materials, plan.materials[g])) + 1;
    Card card(out, mesh.cell().dimension == 3 ? "PSOLID" : "PSHELL");
    card.integer(properties[g]).integer(material);
    if (mesh.cell().dimension == 2) card.real(1);  // the thickness
  }
}

void write_sets(MeshStream& mesh, DeckPlan& plan, ByteWriter& out) {
  const std::vector<std::int32_t> numbers = positive_numbers(plan.groups.markers());
  for (std::size_t g = 0; g < numbers.size(); ++g) {
    out.text("$ nodes of " + plan.names.markers[g] + "\n");
    Card card(out, "SET1");
    card.integer(numbers[g]);
    each_marker_node(mesh, plan.groups, g, [&](std::int64_t node) { card.integer(node + 1); });
  }
}

void write_bounds(const SymmetryCellMesh& cell, const BoundNodes& bounds, ByteWriter& out) {
  if (bounds.empty()) return;
  out.text("$ Side 2 is side 1 turned by one sector, node by node.\n");
  {
    Card card(out, "CYSYM");
    card.integer(cell.fold).word("ROT");
  }
  for (const int side : {1, 2}) {
    if (bounds.copies.empty()) break;
    Card card(out, "CYJOIN");
    card.integer(side).blank();
    for (const NodeCopy& copy : bounds.copies) {
      card.integer((side == 1 ? copy.dependent : copy.independent) + 1);
    }
  }
  if (bounds.axis.empty()) return;
  Card card(out, "CYAX");
  for (const std::int32_t node : bounds.axis) card.integer(node + 1);
}

}  // namespace

Result<void> check_nastran(const MeshStream& mesh, const DeckPlan& plan) {
  if (plan.bounds.beyond_pairs >= 0) {
    return fail(ErrorCode::kUnsupportedModel,
                "the cell has copies of node " + std::to_string(plan.bounds.beyond_pairs + 1) +
                    " that are not just its neighbours', which Nastran's CYJOIN cannot express: "
                    "take the full mesh",
                {plan.bounds.beyond_pairs});
  }
  if (mesh.node_count() <= kMostIds && mesh.element_count() <= kMostIds) return {};
  return fail(ErrorCode::kTooLarge, "Nastran numbers up to " + std::to_string(kMostIds) +
                                        " nodes and elements; take vtu or msh");
}

void write_nastran(MeshStream& mesh, DeckPlan& plan, ByteWriter& out) {
  const SymmetryCellMesh& cell = mesh.cell();
  const std::vector<std::int32_t> properties = positive_numbers(plan.groups.regions());
  out.text("$ Symcell: bulk data of ");
  out.text(mesh.full() ? "the full mesh" : "a symmetry cell");
  out.text(" of a model of fold " + std::to_string(cell.fold) + "\nBEGIN BULK\n");
  if (!plan.bounds.empty()) write_systems(cell, out);
  write_nodes(mesh, plan, out);
  write_elements(mesh, plan, properties, out);
  write_properties(mesh, plan, properties, out);
  write_sets(mesh, plan, out);
  write_bounds(cell, plan.bounds, out);
  out.text("ENDDATA\n");
}

}  // namespace symcell::internal
