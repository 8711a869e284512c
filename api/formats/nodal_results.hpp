// Vectors at the nodes of a cell, as a solver gives them, and what they are in the full mesh.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/formats/mesh_writer.hpp"
#include "api/sink.hpp"
#include "core/base/error.hpp"
#include "core/cell/symmetry_cell_mesh.hpp"

namespace symcell {

// One mode or load case: real and imaginary part per node of the cell.
struct NodalResult {
  std::string name;                            // of the quantity: "DISP", "U"
  double value = 0;                            // frequency or time, as the file has it
  std::optional<std::int32_t> nodal_diameter;  // as the file has it
  std::vector<Point3> real;
  std::vector<Point3> imaginary;  // empty: none
};

// CalculiX .frd (ASCII) of a deck of the cell: vectors of three components at all nodes; an imaginary part
// (DISPI) belongs to the real one before it.  Errors: kSyntax, kTruncated, kCountMismatch
// (a node that is none, is missing or stands twice), kNonFinite, naming the line.
[[nodiscard]] Result<std::vector<NodalResult>> read_frd(std::string_view bytes, std::size_t nodes);

// A point array of three components of a VTU file, and one for the imaginary part (empty: none).
// Errors: those of reading; kMissingField (no such array), kNonFinite.
[[nodiscard]] Result<NodalResult> read_vtu_result(std::string_view bytes,
                                                  std::size_t nodes,
                                                  const std::string& array,
                                                  const std::string& imaginary);

// In sector s the vectors are those of the cell turned by s steps, times exp(i k 2 pi s / n); k may be
// negative: a wave that runs the other way. What the nodes of the bounds have decides which k it is.
struct NodalDiameter {
  std::int32_t signed_diameter = 0;
  double mismatch = 0;  // largest difference on the bounds, of the largest vector
};

// The one that fits best, of `wanted` (both directions) or of all.
[[nodiscard]] NodalDiameter find_nodal_diameter(const SymmetryCellMesh& cell,
                                                const NodalResult& result,
                                                std::optional<std::int32_t> wanted);

// The full mesh as VTU with the vectors at `phase` (radians) as point data `name`, and `name`_amplitude.
// Memory is O(cell).  Errors: as write_mesh.
[[nodiscard]] Result<void> write_full_result(const SymmetryCellMesh& cell,
                                             const NodalResult& result,
                                             std::int32_t signed_diameter,
                                             double phase,
                                             const std::string& name,
                                             VtuEncoding encoding,
                                             const Sink& sink);

}  // namespace symcell
