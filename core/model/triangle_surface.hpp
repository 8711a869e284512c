// The boundary of a solid as triangles, as STL, OFF, PLY and OBJ give it, or as the faces of STEP and
// IGES are tessellated. A shape's tessellation is as a rule not symmetric though the shape is.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/analytic_surface.hpp"
#include "core/geometry/point.hpp"

namespace symcell {

// A face of a CAD model.
struct CadFace {
  AnalyticSurface surface;
  std::string name;          // empty: it has none
  std::int32_t colour = -1;  // 0xRRGGBB; -1: it has none
};

// What a CAD file says beside its faces, and what was done to read it.
struct CadNotes {
  std::string unit;  // of length, in the file; coordinates are in millimetres
  std::vector<std::string> solids;
  std::uint32_t mended = 0;       // solids
  std::uint32_t left_out = 0;     // faces that are no part of a solid
  std::uint32_t inner_faces = 0;  // between two solids
};

// As read: nothing is welded, oriented or checked. STL has three vertices of its own a triangle;
// vertex and triangle indices are those of the file (polygons of OFF, PLY and OBJ are cut into
// fans, `source_face` then names the polygon).
struct TriangleSurface {
  std::vector<Point3> vertices;
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<std::int32_t> source_face;  // per triangle; empty: the triangle's own index
  // Parts that the file names, and which of them each triangle belongs to; empty: it names none, or one.
  std::vector<std::string> group_names;
  std::vector<std::int32_t> groups;
  // Of STEP and IGES: the faces, and which of them each triangle belongs to.
  std::vector<CadFace> cad_faces;
  std::vector<std::int32_t> cad_face;
  std::optional<CadNotes> cad_notes;
};

// More than these are refused (kTooLarge): three indices a triangle stay in 32 bits.
inline constexpr std::size_t kMaxSurfaceTriangles = 100'000'000;

}  // namespace symcell
