#include "api/formats/decks/deck_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/index.hpp"

namespace symcell::internal {
namespace {

// Images of nodes are exact to rounding; written with 14 digits they are off by this share of the
// largest coordinate, with room for the solver's own arithmetic.
constexpr double kWrittenRounding = 1e-12;
// The share of the shortest edge within which CalculiX was seen to find every image.
constexpr double kToleranceOfEdge = 1e-6;

class Planner {
 public:
  Planner(MeshStream& mesh, const DeckOptions& options)
      : mesh_(mesh), cell_(mesh.cell()), options_(options), plan_(mesh) {}

  Result<DeckPlan> run(std::size_t longest, std::span<const std::string_view> reserved) {
    plan_.names = deck_names(cell_, plan_.groups, longest, reserved);
    if (!mesh_.full()) plan_.bounds = bound_nodes(cell_);
    if (mesh_.full()) plan_.bounds.dependent.assign(cell_.nodes.size(), 0);
    SYMCELL_TRY(check_analysis());
    SYMCELL_TRY(choose_materials());
    SYMCELL_TRY(choose_groups());
    auto sides = facet_sides(cell_);
    if (!sides) return error_of(sides);
    plan_.sides = std::move(*sides);
    measure();
    return std::move(plan_);
  }

 private:
  // Sectors hang together by the bounds, and the one cell stands for all.
  [[nodiscard]] bool stands_for_all() const { return !plan_.bounds.empty(); }

  [[nodiscard]] Result<void> check_analysis() const {
    const Analysis analysis = options_.analysis;
    const auto refuse = [](const char* why) { return fail(ErrorCode::kBadOption, why); };
    if (analysis != Analysis::kNone && options_.materials.empty()) {
      return refuse("an analysis needs material=, as in material=steel");
    }
    if (analysis != Analysis::kStatic && !options_.loads.empty()) {
      return refuse("load= goes with analysis=static alone");
    }
    if (analysis == Analysis::kNone && !options_.support.empty()) {
      return refuse("support= goes with analysis=modal or static");
    }
    if (analysis == Analysis::kStatic && options_.support.empty()) {
      return refuse("analysis=static needs support=, groups to hold, or the part would float");
    }
    if (analysis == Analysis::kStatic && options_.loads.empty()) {
      return refuse("analysis=static needs load=, as in load=bore=2.5");
    }
    return {};
  }

  [[nodiscard]] const Material* material_of(std::int32_t attribute) const {
    const auto& all = options_.materials;
    const auto named = std::ranges::find(all, std::optional(attribute), &RegionMaterial::region);
    if (named != all.end()) return &named->material;
    const auto others =
        std::ranges::find(all, std::optional<std::int32_t>(), &RegionMaterial::region);
    return others == all.end() ? nullptr : &others->material;
  }

  Result<void> choose_materials() {
    if (options_.materials.empty()) return {};
    const std::vector<std::int32_t>& regions = plan_.groups.regions();
    for (const RegionMaterial& given : options_.materials) {
      if (!given.region || std::ranges::find(regions, *given.region) != regions.end()) continue;
      const bool elsewhere =
          std::ranges::find(cell_.sector_regions, *given.region) != cell_.sector_regions.end();
      if (elsewhere) continue;
      return fail(ErrorCode::kBadOption, "material names region " + std::to_string(*given.region) +
                                             ", which the mesh has not");
    }
    for (const std::int32_t attribute : regions) {
      const Material* material = material_of(attribute);
      if (material == nullptr) {
        return fail(ErrorCode::kBadOption, "region " + std::to_string(attribute) +
                                               " has no material; give one for it, or one without "
                                               "a region for all others");
      }
      plan_.materials.push_back(material);
    }
    if (!stands_for_all() || cell_.sector_regions.empty()) return {};
    for (std::size_t i = 0; i < cell_.sector_regions.size(); ++i) {
      const std::size_t element = i / at(cell_.fold);
      const Material* there = material_of(cell_.sector_regions[i]);
      if (there != nullptr && *there == *material_of(cell_.regions[element])) continue;
      return fail(ErrorCode::kUnsupportedModel,
                  "regions " + std::to_string(cell_.regions[element]) + " and " +
                      std::to_string(cell_.sector_regions[i]) +
                      " take each other's place in other sectors and have different materials: "
                      "take the full mesh",
                  {static_cast<std::int64_t>(element)});
    }
    return {};
  }

  // Whether the group is the same in every sector, or does not have to be.
  [[nodiscard]] Result<void> check_alike(std::size_t g) const {
    if (!stands_for_all() || cell_.sector_boundary_markers.empty()) return {};
    const std::int32_t marker = plan_.groups.markers()[g];
    for (std::size_t i = 0; i < cell_.sector_boundary_markers.size(); ++i) {
      const std::size_t facet = i / at(cell_.fold);
      const bool here = cell_.boundary_markers[facet] == marker;
      if (here == (cell_.sector_boundary_markers[i] == marker)) continue;
      return fail(ErrorCode::kUnsupportedModel,
                  "the group of marker " + std::to_string(marker) +
                      " differs between sectors, and the cell stands for all: take the full mesh",
                  {static_cast<std::int64_t>(facet)});
    }
    return {};
  }

  Result<void> choose_groups() {
    for (const std::string& name : options_.support) {
      const auto g = find_marker_group(cell_, plan_.groups, plan_.names, name);
      if (!g) return error_of(g);
      SYMCELL_TRY(check_alike(*g));
      plan_.support.push_back(*g);
    }
    for (const GroupLoad& load : options_.loads) {
      const auto g = find_marker_group(cell_, plan_.groups, plan_.names, load.group);
      if (!g) return error_of(g);
      SYMCELL_TRY(check_alike(*g));
      plan_.loads.emplace_back(*g, load.pressure);
    }
    hold();
    return {};
  }

  // A node of the cell is held if any of its copies is on a facet of the groups: that of the cell may lie on the
  // other side of a bound.
  void hold() {
    plan_.held.assign(cell_.nodes.size(), 0);
    std::vector<std::uint8_t> orbits(cell_.orbit_points.size(), 0);
    for (const std::size_t g : plan_.support) {
      each_marker_node(mesh_, plan_.groups, g, [&](std::int64_t node) {
        ++plan_.held_nodes;
        if (!mesh_.full()) orbits[at(cell_.nodes[static_cast<std::size_t>(node)].orbit)] = 1;
      });
    }
    if (mesh_.full()) return;
    for (std::size_t i = 0; i < cell_.nodes.size(); ++i) {
      plan_.held[i] = orbits[at(cell_.nodes[i].orbit)];
    }
    plan_.held_nodes = std::ranges::count(plan_.held, std::uint8_t{1});
  }

  void measure() {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Point3 low{kInfinity, kInfinity, kInfinity};
    Point3 high{-kInfinity, -kInfinity, -kInfinity};
    double largest = 0;
    for (std::size_t i = 0; i < cell_.nodes.size(); ++i) {
      const Point3 p = mesh_.view().cell_node_position(i);
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
      largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    }
    plan_.size = length(high - low);
    if (plan_.bounds.empty()) return;
    const auto k = at(cell_.nodes_per_element);
    const std::size_t corners = cell_.dimension == 2 ? 3 : 4;
    double shortest = kInfinity;
    for (std::size_t e = 0; e < cell_.elements.size(); e += k) {
      for (std::size_t i = 0; i < corners; ++i) {
        for (std::size_t j = 0; j < i; ++j) {
          const auto place = [&](std::size_t c) {
            return mesh_.view().cell_node_position(at(cell_.elements[e + c]));
          };
          shortest = std::min(shortest, length(place(i) - place(j)));
        }
      }
    }
    plan_.position_tolerance = std::max(kToleranceOfEdge * shortest, kWrittenRounding * largest);
  }

  MeshStream& mesh_;
  const SymmetryCellMesh& cell_;
  const DeckOptions& options_;
  DeckPlan plan_;
};

}  // namespace

Result<DeckPlan> plan_deck(MeshStream& mesh,
                           const DeckOptions& options,
                           std::size_t longest,
                           std::span<const std::string_view> reserved) {
  return Planner(mesh, options).run(longest, reserved);
}

std::vector<NamedMaterial> named_materials(const DeckPlan& plan) {
  std::vector<NamedMaterial> all;
  for (const Material* material : plan.materials) {
    if (std::ranges::find(all, material, &NamedMaterial::material) != all.end()) continue;
    const auto alike = std::ranges::count_if(
        all, [&](const NamedMaterial& m) { return m.material->name == material->name; });
    const std::string ending = alike == 0 ? "" : "_" + std::to_string(alike + 1);
    all.push_back({material->name + ending, material});
  }
  return all;
}

std::size_t material_index(const std::vector<NamedMaterial>& materials, const Material* material) {
  const auto found = std::ranges::find(materials, material, &NamedMaterial::material);
  return static_cast<std::size_t>(found - materials.begin());
}

}  // namespace symcell::internal
