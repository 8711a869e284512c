#include "core/base/error.hpp"

namespace symcell {

std::string_view error_code_name(ErrorCode code) {
  switch (code) {
    case ErrorCode::kEmptyFile: return "empty_file";
    case ErrorCode::kJsonSyntax: return "json_syntax";
    case ErrorCode::kJsonTooDeep: return "json_too_deep";
    case ErrorCode::kWrongType: return "wrong_type";
    case ErrorCode::kMissingField: return "missing_field";
    case ErrorCode::kUnknownFormat: return "unknown_format";
    case ErrorCode::kCountMismatch: return "count_mismatch";
    case ErrorCode::kTruncated: return "truncated";
    case ErrorCode::kTooLarge: return "too_large";
    case ErrorCode::kSyntax: return "syntax";
    case ErrorCode::kUnreadable: return "unreadable";
    case ErrorCode::kBadOption: return "bad_option";
    case ErrorCode::kBadFold: return "bad_fold";
    case ErrorCode::kBadAxis: return "bad_axis";
    case ErrorCode::kNonFinite: return "non_finite";
    case ErrorCode::kCoordinateRange: return "coordinate_range";
    case ErrorCode::kIndexOutOfRange: return "index_out_of_range";
    case ErrorCode::kDuplicateVertices: return "duplicate_vertices";
    case ErrorCode::kZeroLengthSegment: return "zero_length_segment";
    case ErrorCode::kOverlappingSegments: return "overlapping_segments";
    case ErrorCode::kSelfIntersection: return "self_intersection";
    case ErrorCode::kDegenerateGeometry: return "degenerate_geometry";
    case ErrorCode::kUnreachableSeed: return "unreachable_seed";
    case ErrorCode::kConflictingSeeds: return "conflicting_seeds";
    case ErrorCode::kNotSymmetric: return "not_symmetric";
    case ErrorCode::kUnsupportedModel: return "unsupported_model";
    case ErrorCode::kDegenerateFacet: return "degenerate_facet";
    case ErrorCode::kNonplanarFacet: return "nonplanar_facet";
    case ErrorCode::kNotWatertight: return "not_watertight";
    case ErrorCode::kAmbiguousSymmetry: return "ambiguous_symmetry";
    case ErrorCode::kStrictWarnings: return "strict_warnings";
    case ErrorCode::kTetrahedralizationFailed: return "tetrahedralization_failed";
    case ErrorCode::kBoundUnreachable: return "bound_unreachable";
    case ErrorCode::kGateFailed: return "gate_failed";
    case ErrorCode::kElementLimit: return "element_limit";
    case ErrorCode::kTimeLimit: return "time_limit";
    case ErrorCode::kMemoryLimit: return "memory_limit";
    case ErrorCode::kCancelled: return "cancelled";
    case ErrorCode::kWorkerCrashed: return "worker_crashed";
    case ErrorCode::kWriteFailed: return "write_failed";
    case ErrorCode::kInternal: return "internal";
  }
  return "internal";
}

}  // namespace symcell
