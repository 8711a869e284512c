// VTK XML UnstructuredGrid files of one piece and one element type, as write_mesh makes them and as
// ParaView or meshio would save them: appended raw (plain or zlib) or ASCII, little-endian.
// Bears hostile input: nothing is allocated by a number in the file beyond what its bytes can hold.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/verify/mesh_data.hpp"

namespace symcell {

// Takes PointData lower_to_higher, CellData region, sector and cell_element where they are.
// Errors: kEmptyFile, kUnknownFormat (no VTU, or an encoding that is not read), kSyntax,
// kMissingField, kCountMismatch, kTruncated, kTooLarge, kNonFinite, kIndexOutOfRange,
// kUnsupportedModel (an element type other than triangles and tetrahedra).
[[nodiscard]] Result<MeshData> read_vtu(std::string_view bytes);

// Point data of three components by its name.
// Errors: as above; kMissingField names the arrays that there are, kNonFinite the node.
[[nodiscard]] Result<std::vector<Point3>> read_vtu_vectors(std::string_view bytes,
                                                           const std::string& name);

}  // namespace symcell
