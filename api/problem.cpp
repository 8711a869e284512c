#include "api/problem.hpp"

#include <algorithm>
#include <array>

namespace symcell {
namespace {

// 400: the request is malformed; 422: well-formed, but the model can't be meshed as asked.
// Exit codes: 1 meshing failed, 2 wrong usage, 3 the model is not acceptable, 4 a limit.
constexpr std::array<ProblemRow, 41> kTable{{
    {ErrorCode::kEmptyFile, 400, 3, "The model is empty"},
    {ErrorCode::kJsonSyntax, 400, 3, "Not well-formed JSON"},
    {ErrorCode::kJsonTooDeep, 400, 3, "JSON is nested too deeply"},
    {ErrorCode::kWrongType, 400, 3, "A value has the wrong type"},
    {ErrorCode::kMissingField, 400, 3, "A required field is missing"},
    {ErrorCode::kUnknownFormat, 415, 3, "The model's format is not known"},
    {ErrorCode::kCountMismatch, 400, 3, "A count does not match what follows"},
    {ErrorCode::kTruncated, 400, 3, "The file ends too early"},
    {ErrorCode::kTooLarge, 413, 4, "The model is too large"},
    {ErrorCode::kSyntax, 400, 3, "The file breaks its format"},
    {ErrorCode::kUnreadable, 400, 3, "The file cannot be read"},
    {ErrorCode::kBadOption, 400, 2, "An option is not acceptable"},
    {ErrorCode::kBadFold, 400, 2, "The fold is not acceptable"},
    {ErrorCode::kBadAxis, 400, 2, "The axis is not acceptable"},
    {ErrorCode::kNonFinite, 422, 3, "A number is not finite"},
    {ErrorCode::kCoordinateRange, 422, 3, "Coordinates are out of range"},
    {ErrorCode::kIndexOutOfRange, 422, 3, "An index is out of range"},
    {ErrorCode::kDuplicateVertices, 422, 3, "Vertices coincide"},
    {ErrorCode::kZeroLengthSegment, 422, 3, "A segment has no length"},
    {ErrorCode::kOverlappingSegments, 422, 3, "Segments overlap"},
    {ErrorCode::kSelfIntersection, 422, 3, "The model intersects itself"},
    {ErrorCode::kDegenerateGeometry, 422, 3, "The model has no area"},
    {ErrorCode::kUnreachableSeed, 422, 3, "A seed is in no bounded part of the model"},
    {ErrorCode::kConflictingSeeds, 422, 3, "Seeds contradict each other"},
    {ErrorCode::kNotSymmetric, 422, 3, "The model is not symmetric as asked"},
    {ErrorCode::kUnsupportedModel, 422, 3, "Models of this kind are not supported"},
    {ErrorCode::kDegenerateFacet, 422, 3, "A facet has no area"},
    {ErrorCode::kNonplanarFacet, 422, 3, "A facet is not planar"},
    {ErrorCode::kNotWatertight, 422, 3, "The surface is not closed"},
    {ErrorCode::kAmbiguousSymmetry, 422, 3, "The symmetry is ambiguous"},
    {ErrorCode::kStrictWarnings, 422, 3, "There are warnings, and strict allows none"},
    {ErrorCode::kTetrahedralizationFailed, 422, 1, "The model could not be tetrahedralized"},
    {ErrorCode::kBoundUnreachable, 422, 1, "A quality bound cannot be reached"},
    {ErrorCode::kGateFailed, 422, 1, "A figure of the mesh is not acceptable"},
    {ErrorCode::kElementLimit, 422, 4, "The mesh would have too many elements"},
    {ErrorCode::kTimeLimit, 422, 4, "The time limit was reached"},
    {ErrorCode::kMemoryLimit, 422, 4, "The memory limit was reached"},
    {ErrorCode::kCancelled, 409, 1, "Cancelled"},
    {ErrorCode::kWorkerCrashed, 500, 1, "The mesher crashed on this model"},
    {ErrorCode::kWriteFailed, 500, 1, "The output could not be written"},
    {ErrorCode::kInternal, 500, 1, "Internal error"},
}};

}  // namespace

std::span<const ProblemRow> problem_table() {
  return kTable;
}

const ProblemRow& problem_row(ErrorCode code) {
  const auto* row = std::ranges::find(kTable, code, &ProblemRow::code);
  return row != kTable.end() ? *row : kTable.back();
}

nlohmann::ordered_json problem_document(const Error& error,
                                        std::string_view instance,
                                        std::string_view pointer_prefix) {
  const ProblemRow& row = problem_row(error.code);
  const std::string name(error_code_name(error.code));
  nlohmann::ordered_json document;
  document["type"] = "/problems/" + name;
  document["title"] = row.title;
  document["status"] = row.http_status;
  document["detail"] = error.message;
  if (!instance.empty()) document["instance"] = instance;
  document["code"] = name;
  if (!error.elements.empty()) document["elements"] = error.elements;
  if (!error.pointer.empty()) {
    // Pointers into the options are complete already; all others point into the model.
    const bool whole = error.pointer.starts_with("/options");
    std::string pointer = whole ? "" : std::string(pointer_prefix);
    pointer += error.pointer;
    document["errors"] = {{{"pointer", pointer}, {"detail", error.message}}};
  }
  return document;
}

}  // namespace symcell
