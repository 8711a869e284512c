#include "api/formats/decks/ansys.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <string>

#include "api/formats/decks/deck_numbers.hpp"

namespace symcell::internal {
namespace {

constexpr std::int64_t kMostIds = 999'999'999;  // of 9 bytes
constexpr std::size_t kIdBytes = 9;
constexpr std::size_t kComponentBytes = 10;
constexpr std::size_t kRealBytes = 21;
constexpr std::size_t kNodesPerLine = 8;  // of an element
constexpr int kMembersPerLine = 8;        // of a component
constexpr std::int32_t kSystem = 11;      // the cylindrical one about the axis

// Of the nodes of an element those that ANSYS wants in their places: corners twice where a brick or a
// quadrilateral is collapsed.
constexpr std::array<std::size_t, 8> kSolid185{0, 1, 2, 2, 3, 3, 3, 3};
constexpr std::array<std::size_t, 10> kSolid187{0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
constexpr std::array<std::size_t, 4> kPlane182{0, 1, 2, 2};
constexpr std::array<std::size_t, 8> kPlane183{0, 1, 2, 2, 3, 4, 2, 5};

struct ElementForm {
  int number;
  std::span<const std::size_t> places;
};

ElementForm element_form(const SymmetryCellMesh& cell) {
  if (cell.dimension == 3) {
    return cell.order == 1 ? ElementForm{185, kSolid185} : ElementForm{187, kSolid187};
  }
  return cell.order == 1 ? ElementForm{182, kPlane182} : ElementForm{183, kPlane183};
}

void put(ByteWriter& out, std::string_view text, std::size_t width) {
  for (std::size_t i = text.size(); i < width; ++i) out.character(' ');
  out.text(text);
}

void put(ByteWriter& out, std::int64_t value, std::size_t width = kIdBytes) {
  put(out, std::to_string(value), width);
}

// With an exponent of three digits, as the block's format says.
std::string block_real(double value) {
  constexpr int kDigits = 13;
  std::array<char, 40> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value,
                                 std::chars_format::scientific, kDigits)
                       .ptr;
  std::string result(text.data(), end);
  const std::size_t e = result.find('e');
  result[e] = 'E';
  const std::size_t digits = e + 2;
  result.insert(digits, 3 - std::min<std::size_t>(3, result.size() - digits), '0');
  return result;
}

void write_nodes(MeshStream& mesh, const DeckPlan& plan, ByteWriter& out) {
  const std::string count = std::to_string(mesh.node_count());
  out.text("NBLOCK,6,SOLID," + count + "," + count + "\n(3i9,6e21.13e3)\n");
  std::int64_t id = 0;
  mesh.each_node([&](const Point3& p, std::int32_t) {
    const Point3 clean = without_rounding(p, plan.size);
    put(out, ++id);
    put(out, 0);
    put(out, 0);
    for (const double c : {clean.x, clean.y, clean.z}) put(out, block_real(c), kRealBytes);
    out.character('\n');
  });
  out.text("N,R5.3,LOC,       -1,\n");
}

void write_elements(MeshStream& mesh,
                    DeckPlan& plan,
                    const std::vector<std::int32_t>& materials,
                    ByteWriter& out) {
  const SymmetryCellMesh& cell = mesh.cell();
  const auto per_sector = static_cast<std::int64_t>(cell.element_count());
  const ElementForm form = element_form(cell);
  const std::string count = std::to_string(mesh.element_count());
  out.text("EBLOCK,19,SOLID," + count + "," + count + "\n(19i9)\n");
  for (std::size_t g = 0; g < materials.size(); ++g) {
    plan.groups.each_element(
        g, [&](std::span<const std::int64_t> nodes, std::size_t e, std::int32_t s) {
          // Material, type, real constant, section, coordinate system, birth, solid, shape, number
          // of nodes, unused, number.
          for (const std::int64_t value :
               {std::int64_t{materials[g]}, std::int64_t{1}, std::int64_t{1}, std::int64_t{1},
                std::int64_t{0}, std::int64_t{0}, std::int64_t{0}, std::int64_t{0},
                static_cast<std::int64_t>(form.places.size()), std::int64_t{0}}) {
            put(out, value);
          }
          put(out, s * per_sector + static_cast<std::int64_t>(e) + 1);
          for (std::size_t i = 0; i < form.places.size(); ++i) {
            if (i == kNodesPerLine) out.character('\n');
            put(out, nodes[form.places[i]] + 1);
          }
          out.character('\n');
        });
  }
  out.text("       -1\n");
}

// The ids must be counted before they are written: `each` is called twice.
void write_component(ByteWriter& out,
                     const std::string& name,
                     std::string_view kind,
                     const std::function<void(const std::function<void(std::int64_t)>&)>& each) {
  std::int64_t count = 0;
  each([&](std::int64_t) { ++count; });
  out.text("CMBLOCK," + name + ",");
  out.text(kind);
  out.text("," + std::to_string(count) + "\n(8i10)\n");
  int on_line = 0;
  each([&](std::int64_t id) {
    if (on_line == kMembersPerLine) {
      out.character('\n');
      on_line = 0;
    }
    ++on_line;
    put(out, id, kComponentBytes);
  });
  out.character('\n');
}

void write_components(MeshStream& mesh, DeckPlan& plan, ByteWriter& out) {
  const auto per_sector = static_cast<std::int64_t>(mesh.cell().element_count());
  for (std::size_t g = 0; g < plan.names.markers.size(); ++g) {
    write_component(out, plan.names.markers[g], "NODE", [&](const auto& put_id) {
      each_marker_node(mesh, plan.groups, g, [&](std::int64_t node) { put_id(node + 1); });
    });
  }
  for (std::size_t g = 0; g < plan.names.regions.size(); ++g) {
    write_component(out, plan.names.regions[g], "ELEM", [&](const auto& put_id) {
      plan.groups.each_element(g,
                               [&](std::span<const std::int64_t>, std::size_t e, std::int32_t s) {
                                 put_id(s * per_sector + static_cast<std::int64_t>(e) + 1);
                               });
    });
  }
}

void write_bounds(const SymmetryCellMesh& cell, const DeckPlan& plan, ByteWriter& out) {
  const BoundNodes& bounds = plan.bounds;
  if (bounds.empty()) return;
  std::vector<std::pair<std::int64_t, std::int64_t>> pairs;
  for (const NodeCopy& copy : bounds.copies)
    pairs.emplace_back(copy.dependent + 1, copy.independent + 1);
  for (const std::int32_t node : bounds.axis) pairs.emplace_back(node + 1, node + 1);
  for (const bool low : {true, false}) {
    write_component(out, low ? "CYCLIC_M01L" : "CYCLIC_M01H", "NODE", [&](const auto& put_id) {
      std::vector<std::int64_t> ids;
      ids.reserve(pairs.size());
      for (const auto& pair : pairs) ids.push_back(low ? pair.first : pair.second);
      std::ranges::sort(ids);
      for (const std::int64_t id : ids) put_id(id);
    });
  }
  out.text("*DIM,SYMCELL_PAIRS,ARRAY," + std::to_string(pairs.size()) + ",2\n");
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const std::string row = std::to_string(i + 1);
    out.text("SYMCELL_PAIRS(" + row + ",1)=" + std::to_string(pairs[i].first) + "\n");
    out.text("SYMCELL_PAIRS(" + row + ",2)=" + std::to_string(pairs[i].second) + "\n");
  }
  // Turned about z, then about x, so that z lies along the axis.
  const Point3& d = cell.axis_direction;
  constexpr double kDegrees = 180 / std::numbers::pi;
  const double about_x = std::acos(std::clamp(d.z, -1.0, 1.0)) * kDegrees;
  const double about_z = d.x == 0 && d.y == 0 ? 0 : std::atan2(d.x, -d.y) * kDegrees;
  const Point3& o = cell.axis_origin;
  out.text("LOCAL," + std::to_string(kSystem) + ",1");
  for (const double value : {o.x, o.y, o.z, about_z, about_x}) {
    out.text("," + fitting_number(value, kRealBytes));
  }
  const std::string start = "CYCLIC," + std::to_string(cell.fold) + "," +
                            fitting_number(360.0 / cell.fold, kRealBytes) + "," +
                            std::to_string(kSystem);
  out.text("\nCSYS,0\n! The pairs, the low node first: " + start + ",,0,SYMCELL_PAIRS\n" +
           "! or by components: " + start + ",CYCLIC,1\n");
}

}  // namespace

Result<void> check_ansys(const MeshStream& mesh, const DeckPlan& plan) {
  if (plan.bounds.beyond_pairs >= 0) {
    return fail(ErrorCode::kUnsupportedModel,
                "the cell has copies of node " + std::to_string(plan.bounds.beyond_pairs + 1) +
                    " that are not just its neighbours', which pairs for CYCLIC cannot express: "
                    "take the full mesh",
                {plan.bounds.beyond_pairs});
  }
  if (mesh.node_count() <= kMostIds && mesh.element_count() <= kMostIds) return {};
  return fail(ErrorCode::kTooLarge, "an ANSYS archive numbers up to " + std::to_string(kMostIds) +
                                        " nodes and elements; take vtu or msh");
}

void write_ansys(MeshStream& mesh, DeckPlan& plan, bool plane_strain, ByteWriter& out) {
  const SymmetryCellMesh& cell = mesh.cell();
  const std::vector<std::int32_t> numbers = positive_numbers(plan.groups.regions());
  out.text("! Symcell: ");
  out.text(mesh.full() ? "the full mesh" : "a symmetry cell");
  out.text(" of a model of fold " + std::to_string(cell.fold) + "\n/PREP7\nET,1," +
           std::to_string(element_form(cell).number) + "\n");
  if (cell.dimension == 2 && plane_strain) out.text("KEYOPT,1,3,2\n");
  for (std::size_t g = 0; g < plan.materials.size(); ++g) {
    const Material& m = *plan.materials[g];
    const std::string number = std::to_string(numbers[g]);
    out.text("! " + m.name + ": units are " + m.units + "\n");
    out.text("MP,EX," + number + "," + fitting_number(m.modulus, kRealBytes) + "\n");
    out.text("MP,PRXY," + number + "," + fitting_number(m.poisson_ratio, kRealBytes) + "\n");
    out.text("MP,DENS," + number + "," + fitting_number(m.density, kRealBytes) + "\n");
  }
  write_nodes(mesh, plan, out);
  write_elements(mesh, plan, numbers, out);
  write_components(mesh, plan, out);
  write_bounds(cell, plan, out);
  out.text("FINISH\n");
}

}  // namespace symcell::internal
