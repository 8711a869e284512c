#include "core/cell/warning.hpp"

#include <cctype>
#include <charconv>
#include <cmath>

#include "core/cell/statistics.hpp"
#include "core/model/describe.hpp"
#include "core/model/triangle_surface.hpp"

namespace symcell {
namespace {

// A fold is refined on its own axis, and detection may measure it about another: the two differ by
// less than this share as a rule.
constexpr double kSpare = 2e-3;
// Share of a cell's elements that may be exempt without a word.
constexpr double kFewExempt = 0.005;

std::string fold_text(std::int32_t fold) {
  return "fold=" + std::to_string(fold);
}

std::string rounded_point(Point3 p) {
  return describe_rounded(p.x) + "," + describe_rounded(p.y) + "," + describe_rounded(p.z);
}

std::string listed(const std::vector<std::string>& texts, const char* between) {
  std::string list;
  for (const std::string& text : texts) list += (list.empty() ? "" : between) + text;
  return list;
}

}  // namespace

std::string_view warning_code_name(WarningCode code) {
  switch (code) {
    case WarningCode::kNearSymmetry: return "near_symmetry";
    case WarningCode::kNoSymmetryFound: return "no_symmetry_found";
    case WarningCode::kFoldNotLargest: return "fold_not_largest";
    case WarningCode::kAxisAmbiguous: return "axis_ambiguous";
    case WarningCode::kSurfaceRepaired: return "surface_repaired";
    case WarningCode::kMarkersBreakSymmetry: return "markers_break_symmetry";
    case WarningCode::kLoopsJoined: return "loops_joined";
    case WarningCode::kEntitiesLeftOut: return "entities_left_out";
    case WarningCode::kOpenContour: return "open_contour";
    case WarningCode::kModelRepaired: return "model_repaired";
    case WarningCode::kVerticesCopied: return "vertices_copied";
    case WarningCode::kArcsAsChords: return "arcs_as_chords";
    case WarningCode::kElementsMissed: return "elements_missed";
    case WarningCode::kUnitsConverted: return "units_converted";
    case WarningCode::kSizesWithoutEffect: return "sizes_without_effect";
    case WarningCode::kSolidsUnited: return "solids_united";
    case WarningCode::kFacesAsChords: return "faces_as_chords";
    case WarningCode::kExemptElements: return "exempt_elements";
  }
  return "unknown";
}

double tolerance_that_takes(double error_rel) {
  if (!(error_rel > 0) || !std::isfinite(error_rel)) return error_rel;
  const double wanted = (1 + kSpare) * error_rel;
  const int exponent = static_cast<int>(std::floor(std::log10(wanted))) - 1;
  const double digits = std::ceil(wanted / std::pow(10.0, exponent));
  // Read as a decimal, so that it is written as one again.
  const std::string text =
      std::to_string(static_cast<int>(digits)) + "e" + std::to_string(exponent);
  double value = wanted;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

Warning near_symmetry_warning(const NearFold& near_fold, std::int32_t taken, double tolerance_rel) {
  const std::string tolerance = describe_number(near_fold.tolerance_rel);
  Warning warning;
  warning.code = WarningCode::kNearSymmetry;
  warning.text = "fold " + std::to_string(near_fold.fold) + " fits to within " +
                 describe_rounded(near_fold.error_rel) + " of the diameter, the tolerance is " +
                 describe_number(tolerance_rel) + "; fold " + std::to_string(taken) + " was taken";
  warning.mend = "give symmetry_tolerance=" + tolerance + " for fold " +
                 std::to_string(near_fold.fold) + ", or " + fold_text(taken) + " if " +
                 std::to_string(taken) + " is meant";
  warning.near_fold = near_fold;
  return warning;
}

Warning no_symmetry_warning(double tolerance_rel) {
  return {WarningCode::kNoSymmetryFound,
          "no fold above 1 fits within the tolerance of " + describe_number(tolerance_rel) +
              " of the diameter: the cell is the whole model",
          "give the fold that is meant, to be told where the model breaks it, or a larger "
          "symmetry_tolerance; give fold=1 if none is meant"};
}

Warning markers_break_symmetry_warning(std::int32_t taken,
                                       std::int32_t geometry,
                                       const std::string& where) {
  return {WarningCode::kMarkersBreakSymmetry,
          "the geometry has fold " + std::to_string(geometry) +
              ", markers and region attributes only " + std::to_string(taken) +
              (where.empty() ? "" : ": " + where),
          "give ignore_markers=true for fold " + std::to_string(geometry) + ", or " +
              fold_text(taken) + " if " + std::to_string(taken) + " is meant"};
}

Warning fold_not_largest_warning(std::int32_t taken, std::int32_t largest, const std::string& why) {
  return {
      WarningCode::kFoldNotLargest,
      "fold " + std::to_string(taken) + " was taken although " + std::to_string(largest) +
          " fits too, because " + why,
      "give " + fold_text(largest) + " for the largest, or " + fold_text(taken) + " to settle it"};
}

Warning axis_ambiguous_warning(std::int32_t fold, Point3 origin, Point3 direction) {
  return {WarningCode::kAxisAmbiguous,
          "more than one axis has fold " + std::to_string(fold) + ": the one through (" +
              rounded_point(origin) + ") along (" + rounded_point(direction) + ") was taken",
          "give axis_direction for another, or axis_direction=" + rounded_point(direction) +
              " to settle it"};
}

Warning surface_repaired_warning(const std::vector<std::string>& repairs) {
  std::string text = "the surface was repaired in " + std::to_string(repairs.size()) +
                     (repairs.size() == 1 ? " way: " : " ways: ");
  for (std::size_t i = 0; i < repairs.size(); ++i) text += (i > 0 ? "; " : "") + repairs[i];
  return {WarningCode::kSurfaceRepaired, std::move(text),
          "look at the places named, and mend the model where that is not what it should be"};
}

Warning loops_joined_warning(std::size_t ends, double widest) {
  return {WarningCode::kLoopsJoined,
          std::to_string(ends) + (ends == 1 ? " end of a segment was" : " ends of segments were") +
              " joined with others up to " + describe_rounded(widest) + " away",
          "let the segments share their vertices"};
}

Warning entities_left_out_warning(const std::vector<std::string>& left_out) {
  return {WarningCode::kEntitiesLeftOut, "of the drawing was left out: " + listed(left_out, ", "),
          "explode them to lines and arcs if they belong to the model"};
}

Warning segments_left_out_warning(std::size_t pieces, Point2 where) {
  return {WarningCode::kEntitiesLeftOut,
          std::to_string(pieces) + (pieces == 1 ? " piece" : " pieces") +
              " of segments, such as one at " + describe_point(where) + ", " +
              (pieces == 1 ? "bounds" : "bound") + " nothing that is meshed, and " +
              (pieces == 1 ? "is" : "are") + " left out",
          "close them into loops if they bound a part of the model, or remove them"};
}

Warning open_contour_warning(std::size_t contours, const std::string& where) {
  return {WarningCode::kOpenContour,
          std::to_string(contours) + (contours == 1 ? " contour is" : " contours are") +
              " open by little, such as at " + where +
              ": segments within the mesh, which bound nothing",
          "draw the ends onto each other if the contour bounds a hole or a region"};
}

Warning faces_as_chords_warning(const Curving& counts) {
  std::vector<std::string> parts;
  const auto add = [&](std::uint64_t count, const char* what) {
    if (count > 0) parts.push_back(std::to_string(count) + what);
  };
  add(counts.left, " vertices lie beside their curved faces");
  add(counts.straightened, " edges of curved faces stay straight");
  add(counts.other_faces,
      " faces are no plane, cylinder, cone, sphere or torus, and stay as they are tessellated");
  return {WarningCode::kFacesAsChords, listed(parts, "; "),
          "a smaller max_edge, or chord_error, brings the mesh nearer to them"};
}

std::vector<Warning> cad_warnings(const CadNotes& notes) {
  std::vector<Warning> warnings;
  std::string unit;
  for (const char c : notes.unit) {
    unit += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  // As STEP and IGES name it; without a name files are in millimetres, too.
  const bool millimetres = unit.empty() || unit == "mm" || unit.starts_with("millimet");
  if (!millimetres) {
    warnings.push_back({WarningCode::kUnitsConverted,
                        "the file's lengths are in " + unit +
                            "; coordinates, sizes and results are in millimetres",
                        "give lengths in millimetres, and forces in newtons for stresses in MPa"});
  }
  if (notes.solids.size() > 1) {
    constexpr std::size_t kNamed = 8;
    std::vector<std::string> names = notes.solids;
    if (names.size() > kNamed) {
      names.resize(kNamed);
      names.emplace_back("...");
    }
    warnings.push_back(
        {WarningCode::kSolidsUnited,
         std::to_string(notes.solids.size()) + " solids (" + listed(names, ", ") +
             ") are meshed as one material" +
             (notes.inner_faces > 0
                  ? ", without the " + std::to_string(notes.inner_faces) + " faces between them"
                  : ""),
         "export them one by one if they differ in material"});
  }
  if (notes.left_out > 0) {
    warnings.push_back({WarningCode::kEntitiesLeftOut,
                        std::to_string(notes.left_out) +
                            " faces of the file are no part of a solid and were left out",
                        "join them to solids in the CAD program if they belong to the part"});
  }
  return warnings;
}

Warning model_repaired_warning(const std::vector<std::string>& repairs) {
  return {WarningCode::kModelRepaired, "the model was repaired: " + listed(repairs, "; "),
          "look at the places named, and mend the model where that is not what it should be"};
}

Warning vertices_copied_warning(std::int32_t fold, std::size_t copies) {
  return {
      WarningCode::kVerticesCopied,
      "no outline of one sector fits the others within the tolerance, so that each sector got the "
      "vertices of all " +
          std::to_string(fold) + ": " + std::to_string(copies) + " more than the model has",
      "correct the model, raise symmetry_tolerance, or give a smaller fold"};
}

Warning arcs_as_chords_warning(std::size_t vertices, std::size_t sides) {
  std::string text;
  if (vertices > 0) {
    text = std::to_string(vertices) + " vertices of the cell lie on chords, beside their arcs";
  }
  if (sides > 0) {
    text += (text.empty() ? "" : "; ") + std::to_string(sides) +
            " sides of the cell are straight, as their triangles would fold along the arcs";
  }
  return {WarningCode::kArcsAsChords, std::move(text),
          "lower chord_error, or widen the gaps that arcs leave there"};
}

std::optional<Warning> exempt_elements_warning(const std::vector<ExemptCount>& exempt,
                                               std::uint64_t elements) {
  std::uint64_t count = 0;
  std::string reasons;
  bool by_curves = true;
  for (const ExemptCount& e : exempt) {
    count += e.elements;
    by_curves = by_curves && (e.reason == "curved_boundary" || e.elements == 0);
    reasons += (reasons.empty() ? "" : ", ") + e.reason + " " + std::to_string(e.elements);
  }
  if (!(static_cast<double>(count) > kFewExempt * static_cast<double>(elements))) {
    return std::nullopt;
  }
  return Warning{WarningCode::kExemptElements,
                 std::to_string(count) + " of the cell's " + std::to_string(elements) +
                     " elements are exempt from the quality bound (" + reasons + ")",
                 by_curves ? "give a shorter max_edge, which follows curved faces more closely, or "
                             "curved=false for chords"
                           : "blunt the model's sharp corners, relax the bound, or take a smaller "
                             "fold where the fold angle is the reason"};
}

Warning elements_missed_warning(std::uint64_t wanted, std::uint64_t found) {
  return {WarningCode::kElementsMissed,
          "no longest edge that was tried gives " + std::to_string(wanted) +
              " elements to within 10 %: the cell has " + std::to_string(found),
          found > wanted ? "take more elements, or a model with fewer small features"
                         : "give max_edge"};
}

Warning sizes_without_effect_warning(const std::vector<std::string>& sizes) {
  return {WarningCode::kSizesWithoutEffect,
          "of the sizes these change nothing: " + listed(sizes, "; "),
          "correct their places or lengths, or leave them away"};
}

Result<void> check_strict(bool strict, const std::vector<Warning>& warnings) {
  if (!strict || warnings.empty()) return {};
  std::string message = std::to_string(warnings.size()) +
                        (warnings.size() == 1 ? " warning" : " warnings") +
                        ", and strict allows none";
  for (const Warning& warning : warnings) {
    message += ": " + std::string(warning_code_name(warning.code)) + ": " + warning.text + "; " +
               warning.mend;
  }
  return fail(ErrorCode::kStrictWarnings, std::move(message), {}, "/options/strict");
}

}  // namespace symcell
