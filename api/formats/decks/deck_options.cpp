#include "api/formats/decks/deck_options.hpp"

#include <algorithm>
#include <array>

#include "api/formats/text_numbers.hpp"
#include "api/printable.hpp"

namespace symcell {
namespace {

constexpr std::array<DeckOptionInfo, 5> kTable{{
    {"analysis", "modal|static|none", "none",
     "what the deck computes; none: mesh, sets and bounds"},
    {"material", "M|R=M,...", "",
     "of all regions or of one: steel, aluminium, titanium (mm, t, s), steel_si ... (m, kg, s) or "
     "E/nu/density"},
    {"support", "GROUP,...", "", "groups whose nodes are held, by name or marker"},
    {"load", "GROUP=P,...", "", "pressure on groups, for analysis static"},
    {"plane", "stress|strain", "stress", "of planar decks"},
}};

// Of structural grades as handbooks give them, in mm, t, s and so N and MPa.
struct KnownMaterial {
  std::string_view name;
  double modulus_mpa;
  double poisson_ratio;
  double density_t_mm3;
};

constexpr std::array<KnownMaterial, 3> kMaterials{{
    {"steel", 210e3, 0.3, 7.85e-9},
    {"aluminium", 70e3, 0.33, 2.7e-9},
    {"titanium", 114e3, 0.34, 4.43e-9},
}};

constexpr double kPascal = 1e6;      // MPa to Pa
constexpr double kDensitySi = 1e12;  // t/mm^3 to kg/m^3

std::string quoted(std::string_view text) {
  return "\"" + printable(text) + "\"";
}

std::optional<double> number(std::string_view text) {
  const ParsedNumber parsed = parse_number(text);
  if (parsed.kind != NumberKind::kFinite) return std::nullopt;
  return parsed.value;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

std::optional<Material> known_material(std::string_view name) {
  const bool si = name.ends_with("_si");
  const std::string_view base = si ? name.substr(0, name.size() - 3) : name;
  const auto* found =
      std::ranges::find(kMaterials, base == "aluminum" ? "aluminium" : base, &KnownMaterial::name);
  if (found == kMaterials.end()) return std::nullopt;
  return Material{std::string(name), si ? "m, kg, s, N, Pa" : "mm, t, s, N, MPa",
                  found->modulus_mpa * (si ? kPascal : 1), found->poisson_ratio,
                  found->density_t_mm3 * (si ? kDensitySi : 1)};
}

Result<Material> parse_material(std::string_view text) {
  if (const auto known = known_material(text)) return *known;
  const auto parts = split(text, '/');
  if (parts.size() != 3) {
    return fail(ErrorCode::kBadOption,
                "material must be steel, aluminium, titanium, one of these with _si, or "
                "E/nu/density; got " +
                    quoted(text));
  }
  const auto modulus = number(parts[0]);
  const auto ratio = number(parts[1]);
  const auto density = number(parts[2]);
  const bool fits =
      modulus && ratio && density && *modulus > 0 && *ratio > -1 && *ratio < 0.5 && *density > 0;
  if (!fits) {
    return fail(ErrorCode::kBadOption,
                "material E/nu/density must have E and density above 0 and nu between -1 and 0.5; "
                "got " +
                    quoted(text));
  }
  return Material{"material", "those of the numbers given", *modulus, *ratio, *density};
}

Result<void> set_materials(DeckOptions& options, std::string_view text) {
  for (const std::string_view part : split(text, ',')) {
    const std::size_t equals = part.find('=');
    RegionMaterial entry;
    if (equals != std::string_view::npos) {
      const std::string_view region = part.substr(0, equals);
      const auto attribute = parse_integer(region);
      if (attribute) entry.region = whole_int32(static_cast<double>(*attribute));
      if (!entry.region) {
        return fail(
            ErrorCode::kBadOption,
            "material names regions by their attribute, a whole number; got " + quoted(region));
      }
    }
    auto material =
        parse_material(equals == std::string_view::npos ? part : part.substr(equals + 1));
    if (!material) return error_of(material);
    entry.material = std::move(*material);
    const bool twice = std::ranges::any_of(options.materials, [&](const RegionMaterial& other) {
      return other.region == entry.region;
    });
    if (twice) {
      return fail(ErrorCode::kBadOption,
                  "material is given twice for the same region: " + quoted(text));
    }
    options.materials.push_back(std::move(entry));
  }
  return {};
}

Result<void> set_support(DeckOptions& options, std::string_view text) {
  for (const std::string_view part : split(text, ',')) {
    if (part.empty()) {
      return fail(ErrorCode::kBadOption,
                  "support must be groups, by name or marker; got " + quoted(text));
    }
    options.support.emplace_back(part);
  }
  return {};
}

Result<void> set_loads(DeckOptions& options, std::string_view text) {
  for (const std::string_view part : split(text, ',')) {
    const std::size_t equals = part.rfind('=');
    const auto pressure =
        equals == std::string_view::npos ? std::nullopt : number(part.substr(equals + 1));
    if (!pressure || equals == 0) {
      return fail(ErrorCode::kBadOption,
                  "load must be GROUP=PRESSURE, as in bore=2.5; got " + quoted(part));
    }
    options.loads.push_back({std::string(part.substr(0, equals)), *pressure});
  }
  return {};
}

}  // namespace

std::span<const DeckOptionInfo> deck_option_table() {
  return kTable;
}

Result<void> set_deck_option(DeckOptions& options, std::string_view name, std::string_view text) {
  if (name == "material") return set_materials(options, text);
  if (name == "support") return set_support(options, text);
  if (name == "load") return set_loads(options, text);
  if (name == "analysis") {
    if (text == "none") options.analysis = Analysis::kNone;
    if (text == "modal") options.analysis = Analysis::kModal;
    if (text == "static") options.analysis = Analysis::kStatic;
    if (text == "none" || text == "modal" || text == "static") return {};
    return fail(ErrorCode::kBadOption,
                "analysis must be modal, static or none; got " + quoted(text));
  }
  if (name == "plane") {
    options.plane_strain = text == "strain";
    if (text == "strain" || text == "stress") return {};
    return fail(ErrorCode::kBadOption, "plane must be stress or strain; got " + quoted(text));
  }
  return fail(ErrorCode::kBadOption, quoted(name) + " is no option of decks");
}

}  // namespace symcell
