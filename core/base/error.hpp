// Errors that an input can cause, as values: the code, a message that names ids, values and the
// mend, the ids of the entities at fault, and a JSON pointer into the request where one exists.
// Bugs are not errors: see SYMCELL_ASSERT in assert.hpp.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

namespace symcell {

// Stable numbers, grouped by layer; `error_code_name` gives the stable spelling used in JSON, logs
// and metrics. A code is never renumbered or reused. tests check that api/problem has a row each.
enum class ErrorCode : std::uint16_t {
  // Reading a file or request body.
  kEmptyFile = 100,
  kJsonSyntax = 101,
  kJsonTooDeep = 102,
  kWrongType = 103,
  kMissingField = 104,
  kUnknownFormat = 105,
  kCountMismatch = 106,
  kTruncated = 107,
  kTooLarge = 108,
  kSyntax = 109,
  kUnreadable = 110,
  // Options.
  kBadOption = 200,
  kBadFold = 201,
  kBadAxis = 202,
  // The model.
  kNonFinite = 300,
  kCoordinateRange = 301,
  kIndexOutOfRange = 302,
  kDuplicateVertices = 303,
  kZeroLengthSegment = 304,
  kOverlappingSegments = 305,
  kSelfIntersection = 306,
  kDegenerateGeometry = 307,
  kUnreachableSeed = 308,
  kConflictingSeeds = 309,
  kNotSymmetric = 310,
  kUnsupportedModel = 311,
  kDegenerateFacet = 312,
  kNonplanarFacet = 313,
  kNotWatertight = 314,
  kAmbiguousSymmetry = 315,  // a surface of revolution: the fold must be given
  kStrictWarnings = 316,     // the option `strict`, and there are warnings
  // Meshing.
  kBoundUnreachable = 400,
  kTetrahedralizationFailed = 401,  // no sector could be tetrahedralized
  kGateFailed = 402,                // the option `fail_on`, and a figure of the mesh meets it
  // Limits.
  kElementLimit = 500,
  kTimeLimit = 501,
  kMemoryLimit = 502,
  kCancelled = 503,
  kWorkerCrashed = 504,  // the worker process died on this job
  // Writing.
  kWriteFailed = 600,
  // A mesh failed its own checks, or a library failed: never the user's fault.
  kInternal = 900,
};

[[nodiscard]] std::string_view error_code_name(ErrorCode code);

// Whether trying in another way would only run into the same limit.
[[nodiscard]] constexpr bool is_limit(ErrorCode code) {
  return code == ErrorCode::kCancelled || code == ErrorCode::kTimeLimit ||
         code == ErrorCode::kMemoryLimit || code == ErrorCode::kElementLimit;
}

struct Error {
  ErrorCode code = ErrorCode::kInternal;
  std::string message;                 // one line: what, where, how to mend
  std::vector<std::int64_t> elements;  // ids of the entities at fault, in input numbering
  std::string pointer;                 // JSON pointer into the model, e.g. "/segments/3"
};

template <class T>
using Result = tl::expected<T, Error>;

// What a function that returns a Result returns where it fails.
using Failure = tl::unexpected<Error>;

[[nodiscard]] inline Failure fail(Error error) {
  return Failure(std::move(error));
}
[[nodiscard]] inline Failure fail(ErrorCode code,
                                  std::string message,
                                  std::vector<std::int64_t> elements = {},
                                  std::string pointer = {}) {
  return Failure(Error{code, std::move(message), std::move(elements), std::move(pointer)});
}

// The error of a failed result, to be returned as that of another type.
template <class T>
[[nodiscard]] Failure error_of(const Result<T>& failed) {
  return Failure(failed.error());
}

// Returns the error of an expression that gives a Result, where it is one; goes on otherwise.
#define SYMCELL_TRY(...)                            \
  if (const auto tried_ = (__VA_ARGS__); !tried_) { \
    return ::symcell::error_of(tried_);             \
  } else /* so that the macro is one statement */   \
    static_cast<void>(0)

}  // namespace symcell
