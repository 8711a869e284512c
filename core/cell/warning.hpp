// What a mesh or an inspection says beside its figures: what was changed, chosen or nearly fitted,
// in a sentence with figures, and what the user can do about it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/geometry/point.hpp"

namespace symcell {

struct CadNotes;
struct Curving;
struct ExemptCount;

enum class WarningCode : std::uint8_t {
  kNearSymmetry,          // a larger fold fits only just not
  kNoSymmetryFound,       // detection gave fold 1
  kFoldNotLargest,        // detection gave less than the largest fold that fits
  kAxisAmbiguous,         // other axes have the same fold
  kSurfaceRepaired,       // the surface was mended before
  kMarkersBreakSymmetry,  // the geometry alone has a larger fold
  kLoopsJoined,           // ends that stood beside each other were joined
  kEntitiesLeftOut,       // a drawing holds what is no part of a model
  kOpenContour,           // segments that all but close round a part of a planar model
  kModelRepaired,         // a planar model was mended on request
  kVerticesCopied,        // all sectors of a planar model got the vertices of all
  kArcsAsChords,          // vertices or sides of the mesh lie beside the arcs they belong to
  kElementsMissed,        // no size gives the number of elements that was asked for
  kUnitsConverted,        // a CAD file's lengths are not in millimetres
  kSolidsUnited,          // several solids of a CAD file are meshed as one
  kFacesAsChords,       // vertices or sides of the mesh lie beside the curved faces they belong to
  kSizesWithoutEffect,  // sizes that ask for no more than others do
  kExemptElements,      // many elements break a bound that the input forces them to
};

// The stable spelling used in JSON and logs.
[[nodiscard]] std::string_view warning_code_name(WarningCode code);

// A fold that is refused for its error alone.
struct NearFold {
  std::int32_t fold = 1;
  double error_rel = 0;      // of the diameter
  double tolerance_rel = 0;  // the symmetry tolerance, rounded up to two digits, that takes it
};

struct Warning {
  WarningCode code = WarningCode::kNearSymmetry;
  std::string text;                        // one plain sentence, without a full stop
  std::string mend;                        // likewise: what to give or to correct
  std::optional<NearFold> near_fold = {};  // of kNearSymmetry
};

// `error_rel` rounded up to two digits, with a little to spare for another way to the same fold.
[[nodiscard]] double tolerance_that_takes(double error_rel);

// `taken`: the fold of the result.  `tolerance_rel`: the one that refuses the other fold.
[[nodiscard]] Warning near_symmetry_warning(const NearFold& near_fold,
                                            std::int32_t taken,
                                            double tolerance_rel);
[[nodiscard]] Warning no_symmetry_warning(double tolerance_rel);
// `geometry`: the fold with markers and region attributes set aside.  `where`: what differs, in words
// that follow a colon.
[[nodiscard]] Warning markers_break_symmetry_warning(std::int32_t taken,
                                                     std::int32_t geometry,
                                                     const std::string& where);
// `why`: the reason to take less than `largest`, in words that follow "because".
[[nodiscard]] Warning fold_not_largest_warning(std::int32_t taken,
                                               std::int32_t largest,
                                               const std::string& why);
// `direction`: of the axis taken.
[[nodiscard]] Warning axis_ambiguous_warning(std::int32_t fold, Point3 origin, Point3 direction);
// Requires: `repairs` is not empty.
[[nodiscard]] Warning surface_repaired_warning(const std::vector<std::string>& repairs);
// `widest`: largest distance of ends that were joined, input units.
[[nodiscard]] Warning loops_joined_warning(std::size_t ends, double widest);
// Requires: the lists are not empty.
[[nodiscard]] Warning entities_left_out_warning(const std::vector<std::string>& left_out);
// `pieces`: of segments with nothing meshed on either side; `where`: an end of one.
[[nodiscard]] Warning segments_left_out_warning(std::size_t pieces, Point2 where);
// `where`: the two ends of one of them, in words.
[[nodiscard]] Warning open_contour_warning(std::size_t contours, const std::string& where);
[[nodiscard]] Warning model_repaired_warning(const std::vector<std::string>& repairs);
// `copies`: vertices of the whole model that it does not have.
[[nodiscard]] Warning vertices_copied_warning(std::int32_t fold, std::size_t copies);
// Per cell: `vertices` on chords, `sides` without a middle on their arc; not both 0.
[[nodiscard]] Warning arcs_as_chords_warning(std::size_t vertices, std::size_t sides);
// Where more than 0.5 % of a cell's `elements` are exempt.
[[nodiscard]] std::optional<Warning> exempt_elements_warning(const std::vector<ExemptCount>& exempt,
                                                             std::uint64_t elements);

// What is to be said of how a CAD file was read.
[[nodiscard]] std::vector<Warning> cad_warnings(const CadNotes& notes);

// Of what lies beside curved faces; something does.
[[nodiscard]] Warning faces_as_chords_warning(const Curving& counts);

// `found`: elements of the cell nearest to `wanted`.
[[nodiscard]] Warning elements_missed_warning(std::uint64_t wanted, std::uint64_t found);

// `sizes`: as given, each with the reason.  Requires: it is not empty.
[[nodiscard]] Warning sizes_without_effect_warning(const std::vector<std::string>& sizes);

// What the option `strict` makes of warnings.  Errors: kStrictWarnings, which lists them, unless
// there are none or `strict` is false.
[[nodiscard]] Result<void> check_strict(bool strict, const std::vector<Warning>& warnings);

}  // namespace symcell
