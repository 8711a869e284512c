// A CAD file's shapes with what it says of them.
#pragma once

#include <NCollection_DataMap.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopTools_ShapeMapHasher.hxx>
#include <TopoDS_Shape.hxx>
#include <cstdint>
#include <string>
#include <vector>

#include "api/cad/cad_module.hpp"

namespace symcell::cad {

// Something that the user is to be told, instead of an answer.
struct Refusal {
  Status status;
  std::string text;
};

struct FaceLabel {
  std::string name;
  std::int32_t colour = -1;  // 0xRRGGBB
  friend bool operator==(const FaceLabel&, const FaceLabel&) = default;
};

// By face, in whatever orientation. Copies of a part in an assembly have one face, in several places.
using FaceLabels = NCollection_DataMap<TopoDS_Shape, FaceLabel, TopTools_ShapeMapHasher>;

struct FileShapes {
  TopoDS_Shape shape;
  std::string unit;
  FaceLabels labels;  // of faces without their place
  NCollection_DataMap<TopoDS_Shape, std::string, TopTools_ShapeMapHasher>
      solid_names;  // of solids without their place
};

// In millimetres. Throws: Refusal, and what OpenCASCADE throws.
[[nodiscard]] FileShapes read_step(const Request& request);
[[nodiscard]] FileShapes read_iges(const Request& request);

struct Bodies {
  std::vector<TopoDS_Shape> faces;  // that bound the material, which is on the inner side of each
  FaceLabels labels;                // of these faces, in their places
  std::vector<std::string> solid_names;
  std::uint32_t mended = 0, left_out = 0, inner_faces = 0;
};

// The solids of a file: mended where they are invalid, sewn from faces where there are none; those
// that touch or overlap share faces, and what has material on both sides is left out.
[[nodiscard]] Bodies make_bodies(const FileShapes& shapes);

// Tessellates the faces and writes them as cad_module.hpp says.
class Answer;
void write_tessellation(const Bodies& bodies,
                        const std::string& unit,
                        const Request& request,
                        Answer& answer);

}  // namespace symcell::cad
