#include "api/formats/decks/deck_groups.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <iterator>
#include <set>

#include "api/formats/text_numbers.hpp"
#include "api/printable.hpp"

namespace symcell::internal {
namespace {

bool is_alpha(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0;
}

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

std::string plain(std::string_view name, std::size_t longest) {
  std::string result;
  for (const char c : name) {
    const bool fits = std::isalnum(static_cast<unsigned char>(c)) != 0;
    result += fits ? c : '_';
  }
  if (result.empty() || !is_alpha(result.front())) result = "g_" + result;
  return result.substr(0, longest);
}

class Names {
 public:
  Names(std::size_t longest, std::span<const std::string_view> reserved) : longest_(longest) {
    for (const std::string_view name : reserved) taken_.insert(lower(std::string(name)));
  }

  std::string take(std::string_view wanted) {
    std::string name = plain(wanted, longest_);
    for (int i = 2; !free(name); ++i) {
      const std::string ending = "_" + std::to_string(i);
      name = plain(wanted, longest_ - ending.size()) + ending;
    }
    taken_.insert(lower(name));
    taken_.insert(lower(name + kSupportEnding));
    return name;
  }

 private:
  [[nodiscard]] bool free(const std::string& name) const {
    return !taken_.contains(lower(name)) && !taken_.contains(lower(name + kSupportEnding));
  }

  std::size_t longest_;
  std::set<std::string> taken_;
};

// Corners of the sides, in Abaqus's order of sides.
constexpr std::array<std::array<std::size_t, 2>, 3> kEdges{{{0, 1}, {1, 2}, {2, 0}}};
constexpr std::array<std::array<std::size_t, 3>, 4> kFaces{
    {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}};

using Corners = std::array<std::int32_t, 3>;  // ascending; of an edge the first is -1

Corners key_of(std::int32_t a, std::int32_t b, std::int32_t c) {
  Corners corners{a, b, c};
  std::ranges::sort(corners);
  return corners;
}

Corners key_of_side(const SymmetryCellMesh& cell, const std::int32_t* nodes, std::size_t side) {
  if (cell.dimension == 2) return key_of(-1, nodes[kEdges[side][0]], nodes[kEdges[side][1]]);
  const auto& face = kFaces[side];
  return key_of(nodes[face[0]], nodes[face[1]], nodes[face[2]]);
}

struct KeyedSide {
  Corners corners;
  ElementSide side;
};

}  // namespace

DeckNames deck_names(const SymmetryCellMesh& cell,
                     const MeshGroups& groups,
                     std::size_t longest,
                     std::span<const std::string_view> reserved) {
  Names names(longest, reserved);
  DeckNames result;
  for (const std::int32_t marker : groups.markers()) {
    result.markers.push_back(names.take(marker_name(cell, marker)));
  }
  for (const std::int32_t attribute : groups.regions()) {
    result.regions.push_back(names.take(region_name(attribute)));
  }
  return result;
}

std::vector<std::int32_t> positive_numbers(const std::vector<std::int32_t>& labels) {
  std::set<std::int32_t> taken;
  for (const std::int32_t label : labels) {
    if (label > 0) taken.insert(label);
  }
  std::vector<std::int32_t> numbers = labels;
  std::int32_t next = 1;
  for (std::int32_t& number : numbers) {
    if (number > 0) continue;
    while (!taken.insert(next).second) ++next;
    number = next;
  }
  return numbers;
}

Result<std::size_t> find_marker_group(const SymmetryCellMesh& cell,
                                      const MeshGroups& groups,
                                      const DeckNames& names,
                                      std::string_view group) {
  const std::vector<std::int32_t>& markers = groups.markers();
  for (std::size_t g = 0; g < markers.size(); ++g) {
    if (group == marker_name(cell, markers[g])) return g;
  }
  for (std::size_t g = 0; g < markers.size(); ++g) {
    if (lower(std::string(group)) == lower(names.markers[g])) return g;
  }
  const auto number = parse_integer(group);
  for (std::size_t g = 0; g < markers.size(); ++g) {
    if (number && *number == markers[g]) return g;
  }
  std::string list;
  constexpr std::size_t kListed = 20;
  for (std::size_t g = 0; g < markers.size() && g < kListed; ++g) {
    if (!list.empty()) list += ", ";
    list += printable(marker_name(cell, markers[g]));
  }
  if (markers.size() > kListed) list += ", ...";
  return fail(ErrorCode::kBadOption, "the mesh has no group \"" + printable(group) + "\"; it has " +
                                         (list.empty() ? "none" : list));
}

void each_marker_node(MeshStream& mesh,
                      MeshGroups& groups,
                      std::size_t g,
                      const std::function<void(std::int64_t)>& f) {
  const SymmetryCellMesh& cell = mesh.cell();
  std::vector<std::int64_t> nodes;
  if (!mesh.full() || groups.varied_markers()) {
    groups.each_facet(g, [&](std::span<const std::int64_t> facet, std::size_t, std::int32_t) {
      nodes.insert(nodes.end(), facet.begin(), facet.end());
    });
    std::ranges::sort(nodes);
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    for (const std::int64_t node : nodes) f(node);
    return;
  }
  // One node an orbit, and from it all copies.
  const auto kf = mesh.nodes_per_facet();
  groups.each_cell_facet(g, [&](std::size_t b) {
    nodes.insert(nodes.end(), &cell.boundary[b * kf], &cell.boundary[b * kf] + kf);
  });
  const auto orbit = [&](std::int64_t i) { return cell.nodes[static_cast<std::size_t>(i)].orbit; };
  std::ranges::stable_sort(nodes, {}, orbit);
  const auto same = [&](std::int64_t a, std::int64_t b) { return orbit(a) == orbit(b); };
  nodes.erase(std::unique(nodes.begin(), nodes.end(), same), nodes.end());
  for (std::int32_t s = 0; s < mesh.sectors() && !mesh.stopped(); ++s) {
    for (const std::int64_t node : nodes) {
      const bool axis = cell.on_axis[static_cast<std::size_t>(orbit(node))] != 0 && cell.fold > 1;
      if (!axis || s == 0) f(mesh.view().node_id(static_cast<std::size_t>(node), s));
    }
  }
}

Result<std::vector<ElementSide>> facet_sides(const SymmetryCellMesh& cell) {
  const std::size_t sides = cell.dimension == 2 ? kEdges.size() : kFaces.size();
  const auto ke = static_cast<std::size_t>(cell.nodes_per_element);
  const auto kf = static_cast<std::size_t>(cell.nodes_per_facet);
  std::vector<KeyedSide> keyed;
  keyed.reserve(cell.element_count() * sides);
  for (std::size_t e = 0; e < cell.element_count(); ++e) {
    for (std::size_t s = 0; s < sides; ++s) {
      keyed.push_back({key_of_side(cell, &cell.elements[e * ke], s),
                       {static_cast<std::uint32_t>(e), static_cast<std::uint8_t>(s)}});
    }
  }
  std::ranges::stable_sort(keyed, {}, &KeyedSide::corners);
  const auto corners_of = [&](const std::int32_t* nodes) {
    return key_of(nodes[0], nodes[1], cell.dimension == 2 ? -1 : nodes[2]);
  };
  std::vector<Corners> bounds;
  for (const std::vector<std::int32_t>* facets : {&cell.lower_facets, &cell.higher_facets}) {
    for (std::size_t i = 0; i < facets->size(); i += kf)
      bounds.push_back(corners_of(&(*facets)[i]));
  }
  std::ranges::sort(bounds);
  std::vector<ElementSide> result;
  result.reserve(cell.facet_count());
  for (std::size_t b = 0; b < cell.facet_count(); ++b) {
    const Corners wanted = corners_of(&cell.boundary[b * kf]);
    const auto found = std::ranges::lower_bound(keyed, wanted, {}, &KeyedSide::corners);
    if (found == keyed.end() || found->corners != wanted) {
      return fail(ErrorCode::kInternal, "a facet of the boundary belongs to no element",
                  {static_cast<std::int64_t>(b)});
    }
    result.push_back(found->side);
    const auto other = std::next(found);
    result.back().inner = (other != keyed.end() && other->corners == wanted) ||
                          std::ranges::binary_search(bounds, wanted);
  }
  return result;
}

}  // namespace symcell::internal
