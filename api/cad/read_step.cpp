#include <IFSelect_ReturnStatus.hxx>
#include <Interface_Static.hxx>
#include <Quantity_Color.hxx>
#include <STEPConstruct.hxx>
#include <STEPConstruct_Styles.hxx>
#include <STEPControl_Controller.hxx>
#include <STEPControl_Reader.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <StepVisual_Colour.hxx>
#include <StepVisual_StyledItem.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <istream>
#include <streambuf>

#include "api/cad/names.hpp"
#include "api/cad/parts.hpp"

namespace symcell::cad {
namespace {

// The bytes as they lie in memory, as a stream.
class BytesBuffer : public std::streambuf {
 public:
  BytesBuffer(const char* bytes, std::size_t size) {
    // A buffer for reading alone is not written to.
    char* begin = const_cast<char*>(bytes);  // NOLINT(cppcoreguidelines-pro-type-const-cast)
    setg(begin, begin, begin + size);
  }
};

std::int32_t rgb(const Quantity_Color& colour) {
  double r = 0, g = 0, b = 0;
  colour.Values(r, g, b, Quantity_TOC_sRGB);
  const auto byte = [](double share) {
    return static_cast<std::int32_t>(std::lround(255 * std::clamp(share, 0.0, 1.0)));
  };
  return byte(r) << 16 | byte(g) << 8 | byte(b);
}

std::string name_of(const Handle(XSControl_TransferReader) & transfer, const TopoDS_Shape& shape) {
  const auto item =
      Handle(StepRepr_RepresentationItem)::DownCast(transfer->EntityFromShapeResult(shape, 1));
  if (item.IsNull() || item->Name().IsNull()) return {};
  return plain_name(item->Name()->ToCString());
}

// Colours of faces, and of solids on the faces that have none of their own.
void read_colours(const Handle(XSControl_WorkSession) & session, FileShapes& result) {
  STEPConstruct_Styles styles(session);
  if (!styles.LoadStyles()) return;
  const Handle(Transfer_TransientProcess)& process = session->TransferReader()->TransientProcess();
  for (const bool of_faces : {true, false}) {
    for (Standard_Integer i = 1; i <= styles.NbStyles(); ++i) {
      const Handle(StepVisual_StyledItem) style = styles.Style(i);
      if (style.IsNull() || style->Item().IsNull()) continue;
      Handle(StepVisual_Colour) surface, bound, curve, render;
      Standard_Real transparency = 0;
      Standard_Boolean of_component = Standard_False;
      if (!styles.GetColors(style, surface, bound, curve, render, transparency, of_component)) {
        continue;
      }
      Quantity_Color colour;
      if (surface.IsNull() || !STEPConstruct_Styles::DecodeColor(surface, colour)) continue;
      const TopoDS_Shape shape = STEPConstruct::FindShape(process, style->Item());
      if (shape.IsNull() || (shape.ShapeType() == TopAbs_FACE) != of_faces) continue;
      for (TopExp_Explorer e(shape, TopAbs_FACE); e.More(); e.Next()) {
        FaceLabel* label = result.labels.ChangeSeek(e.Current().Located(TopLoc_Location()));
        if (label != nullptr && label->colour < 0) label->colour = rgb(colour);
      }
    }
  }
}

}  // namespace

FileShapes read_step(const Request& request) {
  STEPControl_Controller::Init();
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  STEPControl_Reader reader;
  BytesBuffer buffer(request.bytes, request.size);
  std::istream stream(&buffer);
  if (reader.ReadStream("model", stream) != IFSelect_RetDone) {
    throw Refusal{Status::kSyntax, "it is not written as STEP is, or is cut off"};
  }
  FileShapes result;
  TColStd_SequenceOfAsciiString lengths, angles, solid_angles;
  reader.FileUnits(lengths, angles, solid_angles);
  if (!lengths.IsEmpty()) result.unit = lengths.First().ToCString();
  reader.TransferRoots();
  result.shape = reader.OneShape();
  if (result.shape.IsNull()) {
    throw Refusal{Status::kNoShape, "it holds no solid and no surface that can be read"};
  }
  const Handle(XSControl_WorkSession) session = reader.WS();
  const Handle(XSControl_TransferReader) transfer = session->TransferReader();
  for (TopExp_Explorer e(result.shape, TopAbs_FACE); e.More(); e.Next()) {
    const TopoDS_Shape face = e.Current().Located(TopLoc_Location());
    if (!result.labels.IsBound(face)) result.labels.Bind(face, {name_of(transfer, face), -1});
  }
  for (TopExp_Explorer e(result.shape, TopAbs_SOLID); e.More(); e.Next()) {
    const TopoDS_Shape solid = e.Current().Located(TopLoc_Location());
    if (!result.solid_names.IsBound(solid)) {
      result.solid_names.Bind(solid, name_of(transfer, solid));
    }
  }
  read_colours(session, result);
  drop_name_of_all(result.labels);
  return result;
}

}  // namespace symcell::cad
