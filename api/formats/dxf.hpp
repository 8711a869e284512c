// DXF drawings as planar models, read by dxflib.
#pragma once

#include <string_view>

#include "core/base/error.hpp"
#include "core/model/pslg.hpp"

namespace symcell {

// ASCII DXF of any version: LINE, ARC, CIRCLE, LWPOLYLINE, POLYLINE, ELLIPSE, SPLINE (by control
// points), INSERT of blocks, and POINT. Arcs stay arcs, ellipses and splines become arcs
// (curve_drawing.hpp). Layers are markers, numbered from 1 as they come, with their names; layer "0"
// is 0 and entities on it within a block are on the layer of the insertion; "Defpoints" is left out.
// A POINT on a layer whose name begins with "hole" is a hole seed, on another the seed of a region
// whose attribute is the layer's marker. What is of paper space or invisible is no part of it; what is on
// layers that are frozen or off, and other entities, are told in `notes.left_out`.
// Errors: those of scan_dxf, kEmptyFile, kMissingField (no such block), kSyntax (a block that holds
// itself, a spline that is none), kUnsupportedModel (not in a plane), kTooLarge; with entity and line.
[[nodiscard]] Result<Pslg> read_dxf(std::string_view bytes);

}  // namespace symcell
