#include "api/schema/option_table.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "api/printable.hpp"
#include "api/schema/assignments.hpp"
#include "api/schema/gates.hpp"

namespace symcell::internal {
namespace {

using Kind = OptionValue::Kind;

constexpr double kMostCoordinate = 1e60;  // as for the vertices of a model
constexpr unsigned kMegabyteBits = 20;

Failure refuse(ErrorCode code,
               const OptionInfo& info,
               const OptionValue& value,
               const std::string& wanted) {
  std::string shown = printable(value.text);
  if (value.kind == Kind::kText && !value.from_text) {
    // "true" is not true.
    shown = '"' + shown + '"';
  } else if (shown.empty()) {
    shown = "nothing";
  }
  std::string name(info.name);
  return fail(code, name + " must be " + wanted + "; got " + shown, {}, "/options/" + name);
}

// A finite or infinite number; a text must be one as a whole.
std::optional<double> as_number(const OptionValue& value) {
  if (value.kind == Kind::kNumber) return value.number;
  if (!value.from_text) return std::nullopt;
  double number = 0;
  const char* end = value.text.data() + value.text.size();
  const char* begin = value.text.data();
  if (value.text.size() > 1 && *begin == '+') ++begin;
  const auto [stop, error] = std::from_chars(begin, end, number);
  if (error != std::errc{} || stop != end) return std::nullopt;
  return number;
}

// A whole number, exact: 2.0 and 1e6 count as whole, 2.5, -3 and 1e30 do not.
std::optional<std::uint64_t> as_whole(const OptionValue& value) {
  if (value.whole) return value.whole;
  if (value.from_text) {
    std::uint64_t whole = 0;
    const char* end = value.text.data() + value.text.size();
    const auto [stop, error] = std::from_chars(value.text.data(), end, whole);
    if (error == std::errc{} && stop == end) return whole;
  }
  const std::optional<double> number = as_number(value);
  if (!number || !(*number >= 0) || *number > 0x1p53 || std::floor(*number) != *number) {
    return std::nullopt;
  }
  return static_cast<std::uint64_t>(*number);
}

std::optional<bool> as_bool(const OptionValue& value) {
  if (value.kind == Kind::kBool) return value.boolean;
  if (!value.from_text) return std::nullopt;
  const std::string& t = value.text;
  if (t.empty() || t == "true" || t == "1" || t == "yes" || t == "on") return true;
  if (t == "false" || t == "0" || t == "no" || t == "off") return false;
  return std::nullopt;
}

std::optional<std::vector<double>> as_numbers(const OptionValue& value) {
  if (value.kind == Kind::kNumbers) return value.numbers;
  if (!value.from_text) return std::nullopt;
  std::vector<double> numbers;
  const char* at = value.text.data();
  const char* end = at + value.text.size();
  while (true) {
    while (at != end && (*at == ' ' || *at == '+')) ++at;
    double number = 0;
    const auto [stop, error] = std::from_chars(at, end, number);
    if (error != std::errc{} || numbers.size() > 3) return std::nullopt;
    numbers.push_back(number);
    at = stop;
    while (at != end && *at == ' ') ++at;
    if (at == end) return numbers;
    if (*at++ != ',') return std::nullopt;
  }
}

// A number in (low, high]; `low_included` closes the lower end.
Result<double> in_range(const OptionInfo& info,
                        const OptionValue& value,
                        double low,
                        bool low_included,
                        double high,
                        const char* wanted) {
  const std::optional<double> number = as_number(value);
  const bool inside = number && std::isfinite(*number) && *number <= high &&
                      (low_included ? *number >= low : *number > low);
  if (!inside) return refuse(ErrorCode::kBadOption, info, value, wanted);
  return *number;
}

Result<void> set_bound(const OptionInfo& info, const OptionValue& value, double& bound) {
  const Result<double> number = in_range(
      info, value, 0, false, 1e300, "a positive number, at most 1e300; leave it out for no bound");
  if (!number) return error_of(number);
  bound = *number;
  return {};
}

Result<void> set_fold(const OptionInfo& info, const OptionValue& value, MeshOptions& options) {
  options.largest_fold = value.kind == Kind::kText && value.text == "max";
  if (options.largest_fold || (value.kind == Kind::kText && value.text == "auto")) {
    options.fold.reset();
    return {};
  }
  const std::optional<std::uint64_t> fold = as_whole(value);
  if (!fold || *fold < 1 || *fold > static_cast<std::uint64_t>(kMaxFold)) {
    return refuse(
        ErrorCode::kBadFold, info, value,
        "\"auto\", \"max\" or a whole number from 1 (no symmetry) to " + std::to_string(kMaxFold));
  }
  options.fold = static_cast<std::int32_t>(*fold);
  return {};
}

bool all_in_range(const std::vector<double>& numbers) {
  return std::ranges::all_of(numbers, [](double c) { return std::abs(c) <= kMostCoordinate; });
}

Result<void> set_center(const OptionInfo& info, const OptionValue& value, MeshOptions& options) {
  const auto numbers = as_numbers(value);
  const bool planar =
      numbers && (numbers->size() == 2 || (numbers->size() == 3 && (*numbers)[2] == 0));
  if (!planar || !all_in_range(*numbers)) {
    return refuse(ErrorCode::kBadAxis, info, value, "two coordinates x,y of the plane, up to 1e60");
  }
  const Point2 center{(*numbers)[0], (*numbers)[1]};
  if (options.center && *options.center != center) {
    return refuse(ErrorCode::kBadAxis, info, value,
                  "the same point as the other of center and axis_origin; give one of them");
  }
  options.center = center;
  return {};
}

// Two coordinates are a planar model's centre.
Result<void> set_axis_origin(const OptionInfo& info,
                             const OptionValue& value,
                             MeshOptions& options) {
  const auto numbers = as_numbers(value);
  if (numbers && numbers->size() == 2) return set_center(info, value, options);
  if (!numbers || numbers->size() != 3 || !all_in_range(*numbers)) {
    return refuse(ErrorCode::kBadAxis, info, value,
                  "three coordinates x,y,z of a point of the axis, up to 1e60");
  }
  options.axis_origin = Point3{(*numbers)[0], (*numbers)[1], (*numbers)[2]};
  return {};
}

Result<void> set_axis_direction(const OptionInfo& info,
                                const OptionValue& value,
                                MeshOptions& options) {
  const auto numbers = as_numbers(value);
  const bool some =
      numbers && numbers->size() == 3 && all_in_range(*numbers) &&
      std::ranges::any_of(*numbers, [](double c) { return std::abs(c) >= 1 / kMostCoordinate; });
  if (!some) {
    return refuse(ErrorCode::kBadAxis, info, value,
                  "a vector x,y,z of three numbers up to 1e60 that are not all 0");
  }
  options.axis_direction = Point3{(*numbers)[0], (*numbers)[1], (*numbers)[2]};
  return {};
}

Result<void> set_symmetry_tolerance(const OptionInfo& info,
                                    const OptionValue& value,
                                    MeshOptions& options) {
  const Result<double> number =
      in_range(info, value, 0, false, 0.1,
               "a number above 0, at most 0.1 (a share of the model's diameter)");
  if (!number) return error_of(number);
  options.symmetry_tolerance_rel = *number;
  return {};
}

Result<void> set_min_angle(const OptionInfo& info, const OptionValue& value, MeshOptions& options) {
  const Result<double> number =
      in_range(info, value, 0, true, kMaxMinAngleDeg, "a number of degrees from 0 to 42");
  if (!number) return error_of(number);
  options.min_angle_deg = *number;
  return {};
}

Result<void> set_min_edge(const OptionInfo& info, const OptionValue& value, MeshOptions& options) {
  return set_bound(info, value, options.min_edge);
}

Result<void> set_radius_edge(const OptionInfo& info,
                             const OptionValue& value,
                             MeshOptions& options) {
  const Result<double> number =
      in_range(info, value, 1, true, 100, "a number from 1 to 100 (circumradius / shortest edge)");
  if (!number) return error_of(number);
  options.radius_edge = *number;
  return {};
}

Result<void> set_min_dihedral(const OptionInfo& info,
                              const OptionValue& value,
                              MeshOptions& options) {
  const Result<double> number =
      in_range(info, value, 0, true, 70, "a number of degrees from 0 to 70");
  if (!number) return error_of(number);
  options.min_dihedral_deg = *number;
  return {};
}

Result<void> set_sector(const OptionInfo& info, const OptionValue& value, MeshOptions& options) {
  const std::optional<std::uint64_t> sectors = as_whole(value);
  if (!sectors || *sectors < 2 || *sectors > static_cast<std::uint64_t>(kMaxFold)) {
    return refuse(ErrorCode::kBadFold, info, value,
                  "a whole number from 2 to " + std::to_string(kMaxFold) +
                      "; leave it out for a whole model");
  }
  options.sector = static_cast<std::int32_t>(*sectors);
  return {};
}

Result<void> set_chord_error(const OptionInfo& info,
                             const OptionValue& value,
                             MeshOptions& options) {
  const Result<double> number =
      in_range(info, value, 0, false, kMaxChordErrorRel,
               "a number above 0, at most 0.1 (a share of the arc's radius)");
  if (!number) return error_of(number);
  options.chord_error_rel = *number;
  options.chord_error_given = true;
  return {};
}

Result<void> set_feature_angle(const OptionInfo& info,
                               const OptionValue& value,
                               MeshOptions& options) {
  const Result<double> number = in_range(info, value, 0, true, kMostFeatureAngleDeg,
                                         "a number of degrees from 0 (no groups by angle) to 89");
  if (!number) return error_of(number);
  options.feature_angle_deg = *number;
  return {};
}

Result<void> set_flag(const OptionInfo& info, const OptionValue& value, bool& flag) {
  const std::optional<bool> given = as_bool(value);
  if (!given) return refuse(ErrorCode::kBadOption, info, value, "true or false");
  flag = *given;
  return {};
}

Result<void> set_order(const OptionInfo& info, const OptionValue& value, MeshOptions& options) {
  const std::optional<std::uint64_t> order = as_whole(value);
  if (!order || *order < 1 || *order > 2) {
    return refuse(ErrorCode::kBadOption, info, value, "1 (linear) or 2 (quadratic)");
  }
  options.order = static_cast<std::int32_t>(*order);
  return {};
}

Result<void> set_max_elements(const OptionInfo& info,
                              const OptionValue& value,
                              MeshOptions& options) {
  // Node and element ids of a cell are 32 bits wide.
  constexpr std::uint64_t kMost = 500'000'000;
  const std::optional<std::uint64_t> count = as_whole(value);
  if (!count || *count < 1 || *count > kMost) {
    return refuse(ErrorCode::kBadOption, info, value,
                  "a whole number from 1 to " + std::to_string(kMost));
  }
  options.max_elements = *count;
  return {};
}

Result<void> set_time_limit(const OptionInfo& info,
                            const OptionValue& value,
                            MeshOptions& options) {
  const Result<double> number =
      in_range(info, value, 0, false, 1e9,
               "a positive number of seconds, at most 1e9; leave it out for no limit");
  if (!number) return error_of(number);
  options.time_limit_s = *number;
  return {};
}

Result<void> set_memory_limit(const OptionInfo& info,
                              const OptionValue& value,
                              MeshOptions& options) {
  // Below, not even the program itself would fit.
  constexpr std::uint64_t kLeast = 64;
  constexpr std::uint64_t kMost = std::uint64_t{1} << 30U;
  const std::optional<std::uint64_t> megabytes = as_whole(value);
  if (!megabytes || *megabytes < kLeast || *megabytes > kMost) {
    return refuse(ErrorCode::kBadOption, info, value,
                  "a whole number of MB from " + std::to_string(kLeast) + " to " +
                      std::to_string(kMost) + "; leave it out for no limit");
  }
  options.memory_limit_bytes = *megabytes << kMegabyteBits;
  return {};
}

Result<void> set_seed(const OptionInfo& info, const OptionValue& value, MeshOptions& options) {
  const std::optional<std::uint64_t> seed = as_whole(value);
  if (!seed) {
    return refuse(ErrorCode::kBadOption, info, value, "a whole number from 0 to 2^64 - 1");
  }
  options.seed = *seed;
  return {};
}

constexpr std::array<std::pair<std::string_view, Repair>, 4> kRepairs = {{{"none", Repair::kNone},
                                                                          {"safe", Repair::kSafe},
                                                                          {"all", Repair::kAll},
                                                                          {"wrap", Repair::kWrap}}};

Result<void> set_repair(const OptionInfo& info, const OptionValue& value, MeshOptions& options) {
  if (value.kind == Kind::kText) {
    for (const auto& [name, repair] : kRepairs) {
      if (value.text != name) continue;
      options.repair = repair;
      return {};
    }
  }
  return refuse(ErrorCode::kBadOption, info, value, "none, safe, all or wrap");
}

Result<void> set_sizes(const OptionInfo& info, const OptionValue& value, MeshOptions& options) {
  const auto given = value.kind == Kind::kText ? read_assignments(value.text) : std::nullopt;
  if (!given) {
    return refuse(ErrorCode::kBadOption, info, value,
                  "largest edge lengths of groups, markers, vertices, regions and points, as "
                  "bore=0.2,marker:3=0.5,vertex:17=0.02,region:2=1,point:0/1.5/2=0.1 (a group with "
                  "a comma in its name by its number, marker:N)");
  }
  options.sizes.clear();
  for (const Assignment& a : *given) {
    options.sizes.push_back({a.kind, a.id, a.value, a.name, a.point});
  }
  return {};
}

Result<void> set_divisions(const OptionInfo& info, const OptionValue& value, MeshOptions& options) {
  const auto given = value.kind == Kind::kText ? read_assignments(value.text) : std::nullopt;
  const auto is_division = [](const Assignment& a) {
    return a.kind == SizeRequest::Kind::kMarker && a.value == std::floor(a.value) &&
           a.value <= kMostDivisions;
  };
  if (!given || !std::all_of(given->begin(), given->end(), is_division)) {
    return refuse(ErrorCode::kBadOption, info, value,
                  "whole numbers of parts, 1 to 1000000, for markers, as marker:3=8,marker:4=12");
  }
  options.divisions.clear();
  for (const Assignment& a : *given) {
    options.divisions.push_back({a.id, static_cast<std::int32_t>(a.value)});
  }
  return {};
}

constexpr std::array<std::pair<std::string_view, Preset>, 3> kPresets = {
    {{"coarse", Preset::kCoarse}, {"normal", Preset::kNormal}, {"fine", Preset::kFine}}};

Result<void> set_preset(const OptionInfo& info, const OptionValue& value, MeshOptions& options) {
  if (value.kind == Kind::kText) {
    for (const auto& [name, preset] : kPresets) {
      if (value.text != name) continue;
      options.preset = preset;
      return {};
    }
  }
  return refuse(ErrorCode::kBadOption, info, value, "coarse, normal or fine");
}

Result<void> set_elements(const OptionInfo& info, const OptionValue& value, MeshOptions& options) {
  constexpr std::uint64_t kMost = 100'000'000;
  const std::optional<std::uint64_t> count = as_whole(value);
  if (!count || *count < 1 || *count > kMost) {
    return refuse(ErrorCode::kBadOption, info, value,
                  "a whole number from 1 to " + std::to_string(kMost));
  }
  options.target_elements = *count;
  return {};
}

Result<void> set_fail_on(const OptionInfo& info, const OptionValue& value, MeshOptions& options) {
  std::vector<std::string> gates;
  std::string_view rest = value.kind == Kind::kText ? std::string_view(value.text) : "";
  while (true) {
    std::string_view one = rest.substr(0, rest.find(','));
    const bool last = one.size() == rest.size();
    rest.remove_prefix(std::min(rest.size(), one.size() + 1));
    if (!parse_gate(one)) {
      return refuse(ErrorCode::kBadOption, info, value,
                    "comparisons of figures of the statistics with numbers, such as "
                    "cell.min_dihedral_deg<20,cell.elements>1e6");
    }
    gates.emplace_back(one);
    if (last) break;
  }
  options.fail_on = std::move(gates);
  return {};
}

Result<void> set_gradation(const OptionInfo& info, const OptionValue& value, MeshOptions& options) {
  const auto factor = as_number(value);
  if (!factor || !(*factor >= kLeastGradation)) {
    return refuse(ErrorCode::kBadOption, info, value, "a number of at least 1.05");
  }
  options.gradation = *factor;
  return {};
}

using Json = nlohmann::ordered_json;

Json bound_to_json(double bound) {
  return std::isfinite(bound) ? Json(bound) : Json(nullptr);
}

Json point_to_json(const std::optional<Point3>& p) {
  return p ? Json::array({p->x, p->y, p->z}) : Json(nullptr);
}

Json get_center(const MeshOptions& o, ModelKind) {
  return o.center ? Json::array({o.center->x, o.center->y}) : Json(nullptr);
}

Json get_symmetry_tolerance(const MeshOptions& o, ModelKind kind) {
  return o.symmetry_tolerance_rel.value_or(
      kind == ModelKind::kSurface ? kSurfaceSymmetryToleranceRel : kExactSymmetryToleranceRel);
}

Json get_feature_angle(const MeshOptions& o, ModelKind kind) {
  if (kind != ModelKind::kSurface || !o.feature_angle_deg) return nullptr;
  return *o.feature_angle_deg;
}

Json get_repair(const MeshOptions& o, ModelKind kind) {
  if (kind == ModelKind::kPlc) return nullptr;
  for (const auto& [name, repair] : kRepairs) {
    if (repair == o.repair) return name;
  }
  return nullptr;
}

Json get_memory_limit(const MeshOptions& o, ModelKind) {
  return o.memory_limit_bytes == 0 ? Json(nullptr) : Json(o.memory_limit_bytes >> kMegabyteBits);
}

Json get_sizes(const MeshOptions& o, ModelKind) {
  return o.sizes.empty() ? Json(nullptr) : Json(sizes_as_text(o.sizes));
}

Json get_preset(const MeshOptions& o, ModelKind) {
  for (const auto& [name, preset] : kPresets) {
    if (preset == o.preset) return name;
  }
  return nullptr;
}

Json get_fail_on(const MeshOptions& o, ModelKind) {
  if (o.fail_on.empty()) return nullptr;
  std::string text;
  for (const std::string& gate : o.fail_on) text += (text.empty() ? "" : ",") + gate;
  return text;
}

Json get_chord_error(const MeshOptions& o, ModelKind kind) {
  return is_planar(kind) || o.chord_error_given ? Json(o.chord_error_rel) : Json(nullptr);
}

Json get_divisions(const MeshOptions& o, ModelKind) {
  if (o.divisions.empty()) return nullptr;
  std::string text;
  for (const DivisionRequest& d : o.divisions) {
    if (!text.empty()) text += ',';
    text += "marker:" + std::to_string(d.marker) + '=' + std::to_string(d.parts);
  }
  return text;
}

// Options that are one member of MeshOptions, by the way they are checked.
template <double MeshOptions::*Member>
constexpr OptionRow bound_row(OptionInfo info) {
  return {info,
          [](const OptionInfo& i, const OptionValue& v, MeshOptions& o) {
            return set_bound(i, v, o.*Member);
          },
          [](const MeshOptions& o, ModelKind) { return bound_to_json(o.*Member); }};
}

Result<void> set_curved(const OptionInfo& info, const OptionValue& value, MeshOptions& options) {
  bool curved = false;
  SYMCELL_TRY(set_flag(info, value, curved));
  options.curved = curved;
  return {};
}

template <bool MeshOptions::*Member>
constexpr OptionRow flag_row(OptionInfo info) {
  return {info,
          [](const OptionInfo& i, const OptionValue& v, MeshOptions& o) {
            return set_flag(i, v, o.*Member);
          },
          [](const MeshOptions& o, ModelKind) { return Json(o.*Member); }};
}

template <auto Member>
Json get_member(const MeshOptions& o, ModelKind) {
  return o.*Member;
}

using enum OptionScope;

constexpr auto kRows = std::to_array<OptionRow>({
    {{"fold", "auto|max|N", "auto",
      "n-fold symmetry, 1 to 30000; 1: none; max: the largest that the model has; auto: that, or "
      "for "
      "solids the divisor of it whose cell is the smallest",
      kAll},
     set_fold,
     [](const MeshOptions& o, ModelKind) {
       return o.fold ? Json(*o.fold) : Json(o.largest_fold ? "max" : "auto");
     }},
    flag_row<&MeshOptions::ignore_markers>(
        {"ignore_markers", "", "", "markers and region attributes take no part in the symmetry",
         kAll}),
    flag_row<&MeshOptions::keep_vertices>(
        {"keep_vertices", "", "",
         "every vertex is a node and so are its images, also where only the shape is symmetric",
         kPlanar}),
    {{"center", "X,Y", "detected", "planar: centre of the symmetry, in model units", kPlanar},
     set_center,
     get_center},
    {{"axis_origin", "X,Y,Z", "detected",
      "solids: a point of the axis, in model units; planar: the same as center", kSolids},
     set_axis_origin,
     [](const MeshOptions& o, ModelKind) { return point_to_json(o.axis_origin); }},
    {{"axis_direction", "X,Y,Z", "detected",
      "solids: direction of the axis, of any length; planar: 0,0,1", kSolids},
     set_axis_direction,
     [](const MeshOptions& o, ModelKind) { return point_to_json(o.axis_direction); }},
    {{"symmetry_tolerance", "T", "1e-6; STL, OFF, PLY, OBJ: 1e-3",
      "how far the model may be from symmetric, as a share of its diameter, above 0 to 0.1", kAll},
     set_symmetry_tolerance,
     get_symmetry_tolerance},
    {{"sector", "N", "",
      "planar, STL, OFF, PLY, OBJ: the model is one of N equal sectors about center, or 0,0, or "
      "the "
      "axis, or z; its copies are made",
      kAll},
     set_sector,
     [](const MeshOptions& o, ModelKind) { return o.sector ? Json(*o.sector) : Json(nullptr); }},
    {{"repair", "none|safe|all|wrap", "safe",
      "STL, OFF, PLY, OBJ: what is mended; safe: the shape stays; all: holes are closed, too; "
      "wrap: what else would be refused is wrapped; planar: safe: loose ends are joined; all: "
      "doubles are, too, crossings are split, overlaps merged",
      kAll},
     set_repair,
     get_repair},
    {{"min_angle", "DEG", "30", "planar: smallest angle of a triangle in degrees, 0 to 42",
      kPlanar},
     set_min_angle,
     get_member<&MeshOptions::min_angle_deg>},
    bound_row<&MeshOptions::max_area>({"max_area", "A", "",
                                       "planar: largest area of a triangle, in model units squared",
                                       kPlanar}),
    {{"radius_edge", "B", "1.414", "solids: largest circumradius / shortest edge, 1 to 100",
      kSolids},
     set_radius_edge,
     get_member<&MeshOptions::radius_edge>},
    {{"min_dihedral", "DEG", "0",
      "solids: smallest dihedral angle in degrees that the improvement aims at, 0 to 70", kSolids},
     set_min_dihedral,
     get_member<&MeshOptions::min_dihedral_deg>},
    bound_row<&MeshOptions::max_volume>(
        {"max_volume", "V", "", "solids: largest volume of an element, in model units cubed",
         kSolids}),
    bound_row<&MeshOptions::max_edge>({"max_edge", "L", "", "longest edge, in model units", kAll}),
    {{"min_edge", "L", "",
      "refinement makes no edge shorter than this, in model units; what would need one is exempt",
      kAll},
     set_min_edge,
     [](const MeshOptions& o, ModelKind) {
       return o.min_edge > 0 ? Json(o.min_edge) : Json(nullptr);
     }},
    {{"sizes", "GROUP=L,marker:M=L,vertex:V=L,region:R=L,point:X/Y/Z=L", "",
      "longest edges on a group by name or marker, at a vertex (from 0), of solids in a region and "
      "at a "
      "point, in model units; at all copies of them",
      kAll, true},
     set_sizes,
     get_sizes},
    {{"gradation", "G", "",
      "edges grow away from small ones by at most this factor from one to the next, 1.05 or more; "
      "of "
      "solids with sizes 1.5 if it is not given",
      kAll},
     set_gradation,
     [](const MeshOptions& o, ModelKind) { return bound_to_json(o.gradation); }},
    {{"preset", "coarse|normal|fine", "",
      "solids: 1, 2 or 4 elements across walls, away from them as gradation allows", kSolids},
     set_preset,
     get_preset},
    {{"elements", "N", "",
      "elements of the cell that are aimed at, to within 10 %, by one longest edge for all", kAll},
     set_elements,
     [](const MeshOptions& o, ModelKind) {
       return o.target_elements > 0 ? Json(o.target_elements) : Json(nullptr);
     }},
    {{"divisions", "marker:M=N", "",
      "planar: segments of a marker have N equal parts and no other points", kPlanar, true},
     set_divisions,
     get_divisions},
    flag_row<&MeshOptions::keep_boundary>(
        {"keep_boundary", "", "", "planar: no new points on what bounds the domain", kPlanar}),
    {{"chord_error", "E", "1e-3",
      "planar: how far chords may be from their arcs, as a share of the radius, above 0 to 0.1; "
      "STL, "
      "OFF, PLY, OBJ, if given: how far edges on curved faces",
      kAll},
     set_chord_error,
     get_chord_error},
    {{"feature_angle", "DEG", "30, 0 where the file names parts",
      "STL, OFF, PLY, OBJ: faces end at edges where the surface turns by so many degrees or more, "
      "0 "
      "to 89; each with its copies is a group, which inspect lists; 0: none",
      kSolids},
     set_feature_angle,
     get_feature_angle},
    flag_row<&MeshOptions::delaunay>(
        {"delaunay", "", "", "solids: a Delaunay mesh, at worse dihedral angles", kSolids}),
    {{"order", "1|2", "1", "1: linear elements; 2: quadratic, with mid-side nodes", kAll},
     set_order,
     get_member<&MeshOptions::order>},
    {{"curved", "true|false", "true of STEP and IGES",
      "surfaces: the boundary lies on the planes, cylinders, cones, spheres and tori that faces "
      "are; of STEP and IGES vertices, of order 2 mid-side nodes, too",
      kSolids},
     set_curved,
     [](const MeshOptions& o, ModelKind) { return o.curved ? Json(*o.curved) : Json(nullptr); }},
    {{"max_elements", "N", "50000000", "give up beyond this many elements of the cell", kAll},
     set_max_elements,
     get_member<&MeshOptions::max_elements>},
    {{"time_limit", "S", "", "give up after this many seconds", kAll},
     set_time_limit,
     [](const MeshOptions& o, ModelKind) { return bound_to_json(o.time_limit_s); }},
    {{"memory_limit", "MB", "", "give up beyond this much memory, in units of 2^20 bytes", kAll},
     set_memory_limit,
     get_memory_limit},
    {{"seed", "N", "0", "seed of random choices; same input and options: same bytes", kAll},
     set_seed,
     get_member<&MeshOptions::seed>},
    flag_row<&MeshOptions::plain>(
        {"plain", "", "",
         "Delaunay refinement only: no relocation, coarsening or other improvement", kAll}),
    flag_row<&MeshOptions::strict>(
        {"strict", "", "", "any warning is an error, and nothing is written", kAll}),
    {{"fail_on", "FIGURE<X,...", "",
      "figures of the statistics that are an error, as cell.min_dihedral_deg<20,cell.elements>1e6",
      kAll, true},
     set_fail_on,
     get_fail_on},
});

}  // namespace

std::span<const OptionRow> option_rows() {
  return kRows;
}

}  // namespace symcell::internal
