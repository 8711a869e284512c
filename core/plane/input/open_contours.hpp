// Contours that were meant to be closed and are not.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/model/pslg.hpp"
#include "core/plane/input/subdomains.hpp"

namespace symcell::plane {

// Two ends of segments at which no other segment ends, near each other for the length of what they end.
struct LooseEnds {
  std::int32_t a = 0, b = 0;  // vertices
  double apart = 0;
};

// "vertices 3 at (50, -30) and 17 at (50, -29.999), which are 0.001 apart"
[[nodiscard]] std::string describe_loose_ends(const Pslg& pslg, const LooseEnds& ends);

// Segments that have the same face on both sides bound nothing.
struct OpenContours {
  std::optional<LooseEnds> outside;  // of such in a face that is not meshed: the nearest
  std::vector<LooseEnds> inside;     // of such in faces that are, which stay as inner segments
  std::size_t left_out = 0;          // pieces of segments in faces that are not meshed
  Point2 left_out_at;                // an end of one of them
};

// Cost: O(N log N).
[[nodiscard]] OpenContours find_open_contours(const Pslg& pslg, const Subdomains& subdomains);

}  // namespace symcell::plane
