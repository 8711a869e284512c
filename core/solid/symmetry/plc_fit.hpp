// How well a rotation maps a PLC onto itself: vertices onto vertices, then segments and facets with
// their markers, then the cells on their sides with their hole and region seeds.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/cell/warning.hpp"
#include "core/geometry/axis_frame.hpp"
#include "core/geometry/orbit_vertex.hpp"
#include "core/geometry/point_tree.hpp"
#include "core/solid/plc/plc_cells.hpp"
#include "core/solid/plc/plc_complex.hpp"

namespace symcell::solid {

struct PlcFit {
  std::int32_t fold = 1;
  AxisFrame frame;
  double error = 0;  // input units; over all turns if vertices match, else over one
  std::int32_t worst_vertex = -1;
  bool accepted = false;
  std::string mismatch;                // why not, if it is not for the error
  std::vector<std::int64_t> elements;  // of the mismatch
  // If vertices match: per point its orbit and exponent; orbits are in the order of their first
  // point, which has exponent 0.  Points within the tolerance of the axis are orbits of one.
  std::vector<OrbitVertex> vertex;
  std::vector<std::uint8_t> on_axis;  // per orbit
  std::vector<Warning> warnings;      // of the search that chose this fit
};

// What the rotation by one sector does to the complex.
struct ComplexImage {
  std::vector<std::int32_t> edge;   // per edge its image
  std::vector<std::int32_t> facet;  // per facet its image
  // Set if something has no image: then the above is incomplete.
  std::optional<std::string> mismatch;
  std::vector<std::int64_t> elements;  // input ids in the mismatch
};

// `point_image`: per point of the complex its image.
[[nodiscard]] ComplexImage map_complex(const PlcComplex& complex,
                                       const std::vector<std::int32_t>& point_image,
                                       bool ignore_markers);

class PlcMatcher {
 public:
  // `tolerance`: input units.
  PlcMatcher(const PlcComplex& complex,
             const PlcCells& cells,
             double tolerance,
             bool ignore_markers);

  // `adjust`: whether the axis is a first guess, to be fitted to the vertices.
  [[nodiscard]] PlcFit fit(std::int32_t fold, const AxisFrame& frame, bool adjust) const;

  [[nodiscard]] const PlcComplex& complex() const { return complex_; }
  [[nodiscard]] double tolerance() const { return tolerance_; }

 private:
  struct Images;
  [[nodiscard]] Images images_of(std::int32_t fold, const AxisFrame& frame) const;
  [[nodiscard]] AxisFrame adjusted(std::int32_t fold,
                                   const AxisFrame& frame,
                                   const std::vector<std::int32_t>& image) const;
  bool make_orbits(PlcFit& fit, const std::vector<std::int32_t>& image) const;
  void measure(PlcFit& fit) const;
  void compare_cells(const std::vector<std::int32_t>& point_image,
                     const ComplexImage& mapped,
                     PlcFit& fit) const;
  [[nodiscard]] bool alike(std::int32_t cell, std::int32_t image) const;
  [[nodiscard]] std::string describe_cell(std::int32_t cell) const;

  const PlcComplex& complex_;
  const PlcCells& cells_;
  double tolerance_;
  bool ignore_markers_;
  PointTree tree_;
};

}  // namespace symcell::solid
