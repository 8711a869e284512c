#include <BRepAlgoAPI_BuilderAlgo.hxx>
#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepLib.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <NCollection_IndexedDataMap.hxx>
#include <ShapeBuild_ReShape.hxx>
#include <ShapeFix_Shape.hxx>
#include <ShapeFix_Solid.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Solid.hxx>
#include <algorithm>
#include <cmath>

#include "api/cad/parts.hpp"

namespace symcell::cad {
namespace {

// Faces that stand apart by less of the diameter are one surface: files written with single precision
// and with tolerances of a part in 100,000 are common.
constexpr double kSewRel = 1e-5;

double diagonal_of(const TopoDS_Shape& shape) {
  Bnd_Box box;
  BRepBndLib::AddClose(shape, box);
  if (box.IsVoid() || box.IsOpen()) return 0;
  return std::sqrt(box.SquareExtent());
}

class BodyMaker {
 public:
  explicit BodyMaker(const FileShapes& shapes) : shapes_(shapes) {}

  Bodies run() {
    collect_solids();
    const bool closed = !solids_.empty();
    if (!closed) sew();
    if (solids_.empty()) {
      // Open: what bounds nothing is for the surface's own repair.
      for (TopExp_Explorer e(open_, TopAbs_FACE); e.More(); e.Next()) add_face(e.Current());
      return std::move(result_);
    }
    if (closed) mend();
    if (solids_.size() > 1) fuse();
    take_outer_faces();
    return std::move(result_);
  }

 private:
  // In the places that assemblies give them.
  void collect_solids() {
    std::size_t number = 0;
    for (TopExp_Explorer e(shapes_.shape, TopAbs_SOLID); e.More(); e.Next()) {
      solids_.push_back(e.Current());
      const std::string* name = shapes_.solid_names.Seek(e.Current().Located(TopLoc_Location()));
      ++number;
      result_.solid_names.push_back(
          name != nullptr && !name->empty() ? *name : "solid " + std::to_string(number));
      label_faces(e.Current());
    }
    if (solids_.empty()) {
      label_faces(shapes_.shape);
      return;
    }
    for (TopExp_Explorer e(shapes_.shape, TopAbs_FACE, TopAbs_SOLID); e.More(); e.Next()) {
      ++result_.left_out;
    }
  }

  void label_faces(const TopoDS_Shape& shape) {
    for (TopExp_Explorer e(shape, TopAbs_FACE); e.More(); e.Next()) {
      if (const FaceLabel* label = shapes_.labels.Seek(e.Current().Located(TopLoc_Location()))) {
        labels_.Bind(e.Current(), *label);
      }
    }
  }

  // What a face of `shape` was turned into is labelled as it was. Faces are asked in the order of the shape: of two
  // that became one the first one's label stays. `turned` calls its last argument with what it is now.
  template <class Turned>
  void follow_labels(const TopoDS_Shape& shape, const Turned& turned) {
    for (TopExp_Explorer e(shape, TopAbs_FACE); e.More(); e.Next()) {
      const FaceLabel* found = labels_.Seek(e.Current());
      if (found == nullptr) continue;
      const FaceLabel label = *found;  // which stays where the map grows
      turned(e.Current(), [&](const TopoDS_Shape& now) {
        if (!now.IsNull() && !labels_.IsBound(now)) labels_.Bind(now, label);
      });
    }
  }

  void sew() {
    const double size = diagonal_of(shapes_.shape);
    BRepBuilderAPI_Sewing sewing(std::max(kSewRel * size, 1e-9));
    TopExp_Explorer faces(shapes_.shape, TopAbs_FACE);
    if (!faces.More())
      throw Refusal{Status::kNoShape, "it holds no solid and no surface, only curves"};
    for (; faces.More(); faces.Next()) sewing.Add(faces.Current());
    sewing.Perform();
    follow_labels(shapes_.shape, [&](const TopoDS_Shape& face, const auto& is_now) {
      is_now(sewing.Modified(face));
    });
    open_ = sewing.SewedShape();
    if (sewing.NbFreeEdges() > 0) return;
    for (TopExp_Explorer e(open_, TopAbs_SHELL); e.More(); e.Next()) {
      TopoDS_Solid solid;
      BRep_Builder().MakeSolid(solid);
      BRep_Builder().Add(solid, e.Current());
      BRepLib::OrientClosedSolid(solid);
      solids_.push_back(solid);
      result_.solid_names.push_back("solid " + std::to_string(solids_.size()));
    }
  }

  void mend() {
    for (TopoDS_Shape& solid : solids_) {
      if (BRepCheck_Analyzer(solid).IsValid()) continue;
      const Handle(ShapeFix_Shape) fix = new ShapeFix_Shape(solid);
      fix->Perform();
      const TopoDS_Shape fixed = fix->Shape();
      if (fixed.IsNull() || !TopExp_Explorer(fixed, TopAbs_FACE).More()) continue;
      follow_labels(solid, [&](const TopoDS_Shape& face, const auto& is_now) {
        const TopoDS_Shape now = fix->Context()->Apply(face);
        for (TopExp_Explorer e(now, TopAbs_FACE); e.More(); e.Next()) is_now(e.Current());
      });
      solid = fixed;
      ++result_.mended;
    }
  }

  void fuse() {
    TopTools_ListOfShape arguments;
    for (const TopoDS_Shape& solid : solids_) arguments.Append(solid);
    BRepAlgoAPI_BuilderAlgo fused;
    fused.SetArguments(arguments);
    fused.SetNonDestructive(Standard_True);
    fused.SetRunParallel(Standard_False);
    fused.Build();
    // What cannot be fused is united as overlapping bodies of any surface are.
    if (fused.HasErrors() || fused.Shape().IsNull()) return;
    for (const TopoDS_Shape& solid : solids_) {
      follow_labels(solid, [&](const TopoDS_Shape& face, const auto& is_now) {
        for (TopTools_ListOfShape::Iterator i(fused.Modified(face)); i.More(); i.Next()) {
          is_now(i.Value());
        }
      });
    }
    std::vector<TopoDS_Shape> parts;
    for (TopExp_Explorer e(fused.Shape(), TopAbs_SOLID); e.More(); e.Next()) {
      parts.push_back(e.Current());
    }
    if (!parts.empty()) solids_ = std::move(parts);
  }

  void take_outer_faces() {
    NCollection_IndexedDataMap<TopoDS_Shape, int, TopTools_ShapeMapHasher> uses;
    for (const TopoDS_Shape& solid : solids_) {
      for (TopExp_Explorer e(solid, TopAbs_FACE); e.More(); e.Next()) {
        if (int* count = uses.ChangeSeek(e.Current())) {
          ++*count;
        } else {
          uses.Add(e.Current(), 1);
        }
      }
    }
    for (int i = 1; i <= uses.Extent(); ++i) {
      if (uses.FindFromIndex(i) == 1) {
        add_face(uses.FindKey(i));
      } else {
        ++result_.inner_faces;
      }
    }
  }

  void add_face(const TopoDS_Shape& face) {
    result_.faces.push_back(face);
    if (const FaceLabel* label = labels_.Seek(face)) result_.labels.Bind(face, *label);
  }

  const FileShapes& shapes_;
  Bodies result_;
  std::vector<TopoDS_Shape> solids_;
  TopoDS_Shape open_;
  FaceLabels labels_;  // of faces in their places
};

}  // namespace

Bodies make_bodies(const FileShapes& shapes) {
  return BodyMaker(shapes).run();
}

}  // namespace symcell::cad
