#include "api/schema/option_table.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "api/printable.hpp"

namespace symcell::internal {
namespace {

using Kind = OptionValue::Kind;

tl::unexpected<Error> refuse(ErrorCode code,
                             const OptionInfo& info,
                             const OptionValue& value,
                             const std::string& wanted) {
  const std::string shown = printable(value.text);
  std::string name(info.name);
  return fail(code, name + " must be " + wanted + "; got " + (shown.empty() ? "nothing" : shown),
              {}, "/options/" + name);
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
  const Result<double> number =
      in_range(info, value, 0, false, 1e300, "a positive number; leave it out for no bound");
  if (!number) return tl::unexpected(number.error());
  bound = *number;
  return {};
}

Result<void> set_fold(const OptionInfo& info, const OptionValue& value, MeshOptions& options) {
  if (value.kind == Kind::kText && value.text == "auto") {
    options.fold.reset();
    return {};
  }
  const std::optional<std::uint64_t> fold = as_whole(value);
  if (!fold || *fold < 1 || *fold > static_cast<std::uint64_t>(kMaxFold)) {
    return refuse(ErrorCode::kBadFold, info, value,
                  "\"auto\" or a whole number from 1 (no symmetry) to " + std::to_string(kMaxFold));
  }
  options.fold = static_cast<std::int32_t>(*fold);
  return {};
}

Result<void> set_ignore_markers(const OptionInfo& info,
                                const OptionValue& value,
                                MeshOptions& options) {
  const std::optional<bool> flag = as_bool(value);
  if (!flag) return refuse(ErrorCode::kBadOption, info, value, "true or false");
  options.ignore_markers = *flag;
  return {};
}

Result<void> set_center(const OptionInfo& info, const OptionValue& value, MeshOptions& options) {
  const auto numbers = as_numbers(value);
  const bool planar =
      numbers && (numbers->size() == 2 || (numbers->size() == 3 && (*numbers)[2] == 0));
  if (!planar || !std::ranges::all_of(*numbers, [](double c) { return std::abs(c) <= 1e60; })) {
    return refuse(ErrorCode::kBadAxis, info, value, "two finite coordinates x,y of the plane");
  }
  const Point2 center{(*numbers)[0], (*numbers)[1]};
  if (options.center && *options.center != center) {
    return refuse(ErrorCode::kBadAxis, info, value,
                  "the same point as the other of center and axis_origin; give one of them");
  }
  options.center = center;
  return {};
}

Result<void> set_axis_direction(const OptionInfo& info, const OptionValue& value, MeshOptions&) {
  const auto numbers = as_numbers(value);
  const bool along_z = numbers && numbers->size() == 3 && (*numbers)[0] == 0 &&
                       (*numbers)[1] == 0 && std::abs((*numbers)[2]) == 1;
  if (along_z) return {};
  return refuse(ErrorCode::kBadAxis, info, value,
                "0,0,1 or left out for a planar model: its axis is normal to the plane");
}

Result<void> set_symmetry_tolerance(const OptionInfo& info,
                                    const OptionValue& value,
                                    MeshOptions& options) {
  const Result<double> number =
      in_range(info, value, 0, false, 0.1,
               "a number above 0, at most 0.1 (a share of the model's diameter)");
  if (!number) return tl::unexpected(number.error());
  options.symmetry_tolerance_rel = *number;
  return {};
}

Result<void> set_min_angle(const OptionInfo& info, const OptionValue& value, MeshOptions& options) {
  const Result<double> number =
      in_range(info, value, 0, true, kMaxMinAngleDeg, "a number of degrees from 0 to 42");
  if (!number) return tl::unexpected(number.error());
  options.min_angle_deg = *number;
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
  const Result<double> number = in_range(info, value, 0, false, 1e9,
                                         "a positive number of seconds; leave it out for no limit");
  if (!number) return tl::unexpected(number.error());
  options.time_limit_s = *number;
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

Result<void> set_plain(const OptionInfo& info, const OptionValue& value, MeshOptions& options) {
  const std::optional<bool> flag = as_bool(value);
  if (!flag) return refuse(ErrorCode::kBadOption, info, value, "true or false");
  options.plain = *flag;
  return {};
}

Result<void> refuse_solids_only(const OptionInfo& info, const OptionValue& value, MeshOptions&) {
  if (value.kind == Kind::kBool && !value.boolean) return {};  // "delaunay": false asks for nothing
  const std::string name(info.name);
  return fail(ErrorCode::kBadOption,
              name + " is for solid models; planar models take min_angle, max_area and max_edge",
              {}, "/options/" + name);
}

using Json = nlohmann::ordered_json;

Json bound_to_json(double bound) {
  return std::isfinite(bound) ? Json(bound) : Json(nullptr);
}

Json get_center(const MeshOptions& o) {
  return o.center ? Json::array({o.center->x, o.center->y}) : Json(nullptr);
}

Json get_nothing(const MeshOptions&) {
  return nullptr;
}

constexpr auto kRows = std::to_array<OptionRow>({
    {{"fold", "auto|N", "auto",
      "n-fold symmetry, 1 to 30000; 1: none; auto: the largest that the model has", false},
     set_fold,
     [](const MeshOptions& o) { return o.fold ? Json(*o.fold) : Json("auto"); }},
    {{"ignore_markers", "", "", "markers and region attributes take no part in the symmetry",
      false},
     set_ignore_markers,
     [](const MeshOptions& o) { return Json(o.ignore_markers); }},
    {{"center", "X,Y", "detected", "centre of the symmetry, in model units", false},
     set_center,
     get_center},
    {{"axis_origin", "X,Y[,0]", "detected",
      "a point of the axis; for planar models the same as center", false},
     set_center,
     get_nothing},
    {{"axis_direction", "X,Y,Z", "0,0,1", "direction of the axis; planar models: 0,0,1", false},
     set_axis_direction,
     get_nothing},
    {{"symmetry_tolerance", "T", "1e-6",
      "how far the model may be from symmetric, as a share of its diameter, above 0 to 0.1", false},
     set_symmetry_tolerance,
     [](const MeshOptions& o) { return Json(o.symmetry_tolerance_rel); }},
    {{"min_angle", "DEG", "30", "smallest angle of a triangle in degrees, 0 to 42", false},
     set_min_angle,
     [](const MeshOptions& o) { return Json(o.min_angle_deg); }},
    {{"max_area", "A", "", "largest area of a triangle, in model units squared", false},
     [](const OptionInfo& i, const OptionValue& v, MeshOptions& o) {
       return set_bound(i, v, o.max_area);
     },
     [](const MeshOptions& o) { return bound_to_json(o.max_area); }},
    {{"radius_edge", "B", "", "solids only: largest circumradius / shortest edge", true},
     refuse_solids_only,
     get_nothing},
    {{"min_dihedral", "DEG", "", "solids only: smallest dihedral angle in degrees", true},
     refuse_solids_only,
     get_nothing},
    {{"max_volume", "V", "", "solids only: largest volume, in model units cubed", true},
     refuse_solids_only,
     get_nothing},
    {{"max_edge", "L", "", "longest edge, in model units", false},
     [](const OptionInfo& i, const OptionValue& v, MeshOptions& o) {
       return set_bound(i, v, o.max_edge);
     },
     [](const MeshOptions& o) { return bound_to_json(o.max_edge); }},
    {{"delaunay", "", "", "solids only: keep the mesh Delaunay, no improvement beyond it", true},
     refuse_solids_only,
     get_nothing},
    {{"order", "1|2", "1", "1: linear elements; 2: quadratic, with mid-side nodes", false},
     set_order,
     [](const MeshOptions& o) { return Json(o.order); }},
    {{"max_elements", "N", "50000000", "give up beyond this many elements of the cell", false},
     set_max_elements,
     [](const MeshOptions& o) { return Json(o.max_elements); }},
    {{"time_limit", "S", "", "give up after this many seconds", false},
     set_time_limit,
     [](const MeshOptions& o) { return bound_to_json(o.time_limit_s); }},
    {{"seed", "N", "0", "seed of random choices; same input and options: same bytes", false},
     set_seed,
     [](const MeshOptions& o) { return Json(o.seed); }},
    {{"plain", "", "", "plain Delaunay refinement only: no relocation, no coarsening", false},
     set_plain,
     [](const MeshOptions& o) { return Json(o.plain); }},
});

}  // namespace

std::span<const OptionRow> option_rows() {
  return kRows;
}

}  // namespace symcell::internal
