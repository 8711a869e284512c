// Writes STEP and IGES files of parts into the folder that is given.
//
// Millimetres unless the name says inch:
//   disc        radius 50, height 10, bore 10, six holes of radius 6 at 30
//   flange      a disc with a hub, eight bolt holes with chamfers, a bore
//   bracket     fold 2: a plate with rounded ends, two holes
//   nut         a hexagon with a bore
//   ball_ring   fold 5: a ring with five balls sunk into it
//   two_solids  a block and a cylinder on it, which share a face in part
//   overlap     two cylinders that overlap
//   inch_plate  a plate of 4 by 2 by 0.5 inches with a hole
//   coloured    the disc, its bore named and red, its rim blue
//   sheet       one face, no solid
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRep_Builder.hxx>
#include <IGESControl_Controller.hxx>
#include <IGESControl_Writer.hxx>
#include <Interface_Static.hxx>
#include <STEPControl_Controller.hxx>
#include <STEPControl_Writer.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Wire.hxx>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <gp_Ax2.hxx>
#include <gp_Pln.hxx>
#include <numbers>
#include <sstream>
#include <string>

namespace {

std::string folder;

gp_Ax2 up(double x, double y, double z) {
  return {gp_Pnt(x, y, z), gp_Dir(0, 0, 1)};
}

TopoDS_Shape cylinder(double x, double y, double z, double radius, double height) {
  return BRepPrimAPI_MakeCylinder(up(x, y, z), radius, height).Shape();
}

TopoDS_Shape cut(const TopoDS_Shape& from, const TopoDS_Shape& what) {
  return BRepAlgoAPI_Cut(from, what).Shape();
}

TopoDS_Shape fuse(const TopoDS_Shape& a, const TopoDS_Shape& b) {
  return BRepAlgoAPI_Fuse(a, b).Shape();
}

template <class Make>
TopoDS_Shape cut_round(TopoDS_Shape shape, int fold, double radius, const Make& make) {
  for (int k = 0; k < fold; ++k) {
    const double angle = 2 * std::numbers::pi * k / fold + 0.1;
    shape = cut(shape, make(radius * std::cos(angle), radius * std::sin(angle)));
  }
  return shape;
}

TopoDS_Shape disc() {
  const TopoDS_Shape ring = cut(cylinder(0, 0, 0, 50, 10), cylinder(0, 0, -1, 10, 12));
  return cut_round(ring, 6, 30, [](double x, double y) { return cylinder(x, y, -1, 6, 12); });
}

TopoDS_Shape flange() {
  TopoDS_Shape body = fuse(cylinder(0, 0, 0, 60, 12), cylinder(0, 0, 12, 30, 25));
  body = cut(body, cylinder(0, 0, -1, 20, 40));
  body = cut_round(body, 8, 45, [](double x, double y) { return cylinder(x, y, -1, 5, 14); });
  return cut_round(body, 8, 45, [](double x, double y) {
    return BRepPrimAPI_MakeCone(up(x, y, 10), 5, 7.5, 2.5).Shape();
  });
}

TopoDS_Shape bracket() {
  TopoDS_Shape body = BRepPrimAPI_MakeBox(gp_Pnt(-40, -15, 0), gp_Pnt(40, 15, 8)).Shape();
  for (const double side : {-1.0, 1.0}) body = fuse(body, cylinder(side * 40, 0, 0, 15, 8));
  for (const double side : {-1.0, 1.0}) body = cut(body, cylinder(side * 40, 0, -1, 7, 10));
  return cut(body, BRepPrimAPI_MakeBox(gp_Pnt(-10, -5, -1), gp_Pnt(10, 5, 9)).Shape());
}

TopoDS_Shape nut() {
  BRepBuilderAPI_MakePolygon outline;
  for (int k = 0; k < 6; ++k) {
    const double angle = 2 * std::numbers::pi * k / 6;
    outline.Add(gp_Pnt(10 * std::cos(angle), 10 * std::sin(angle), 0));
  }
  outline.Close();
  const TopoDS_Face face = BRepBuilderAPI_MakeFace(outline.Wire());
  return cut(BRepPrimAPI_MakePrism(face, gp_Vec(0, 0, 8)).Shape(), cylinder(0, 0, -1, 5, 10));
}

TopoDS_Shape ball_ring() {
  TopoDS_Shape body = BRepPrimAPI_MakeTorus(up(0, 0, 0), 30, 8).Shape();
  for (int k = 0; k < 5; ++k) {
    const double angle = 2 * std::numbers::pi * k / 5;
    body = fuse(
        body,
        BRepPrimAPI_MakeSphere(gp_Pnt(38 * std::cos(angle), 38 * std::sin(angle), 0), 6).Shape());
  }
  return body;
}

TopoDS_Shape compound(const TopoDS_Shape& a, const TopoDS_Shape& b) {
  TopoDS_Compound all;
  BRep_Builder builder;
  builder.MakeCompound(all);
  builder.Add(all, a);
  builder.Add(all, b);
  return all;
}

void write_step(const std::string& name, const TopoDS_Shape& shape, const char* unit = "MM") {
  STEPControl_Controller::Init();
  Interface_Static::SetCVal("write.step.unit", unit);
  STEPControl_Writer writer;
  writer.Transfer(shape, STEPControl_AsIs);
  writer.Write((folder + "/" + name + ".step").c_str());
}

void write_iges(const std::string& name, const TopoDS_Shape& shape, int brep) {
  IGESControl_Controller::Init();
  IGESControl_Writer writer("MM", brep);
  writer.AddShape(shape);
  writer.ComputeModel();
  writer.Write((folder + "/" + name + ".igs").c_str());
}

std::string text_of(const std::string& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

// The number of an entity that begins so, as #12; it is given a name there.
std::string entity(std::string& text, const std::string& begin, const std::string& name) {
  const std::size_t at = text.find(begin);
  const std::size_t number = text.rfind('#', at);
  const std::string id = text.substr(number, text.find(' ', number) - number);
  if (!name.empty()) text.insert(text.find('\'', at) + 1, name);
  return id;
}

// The bore is named and red, the largest cylinder blue.
void write_coloured() {
  std::string text = text_of(folder + "/disc.step");
  // Faces by their surfaces: #a = ADVANCED_FACE('',(...),#b,.T.); #b = CYLINDRICAL_SURFACE('',#c,10.);
  std::string styled;
  std::string items;
  int next = 900000;
  const auto colour_face = [&](const std::string& radius, const std::string& name,
                               const std::string& rgb) {
    std::size_t cylinder_at = text.find("CYLINDRICAL_SURFACE");
    while (!text.substr(0, text.find(';', cylinder_at)).ends_with("," + radius + ")")) {
      cylinder_at = text.find("CYLINDRICAL_SURFACE", cylinder_at + 1);
    }
    const std::size_t begin = text.rfind('#', text.rfind('=', cylinder_at));
    const std::string surface = text.substr(begin, text.find(' ', begin) - begin);
    std::size_t face = text.find("ADVANCED_FACE");
    while (text.substr(face, text.find(';', face) - face).find("," + surface + ",") ==
           std::string::npos) {
      face = text.find("ADVANCED_FACE", face + 1);
    }
    const std::size_t id_begin = text.rfind('#', face);
    const std::string id = text.substr(id_begin, text.find(' ', id_begin) - id_begin);
    text.insert(text.find('\'', face) + 1, name);
    const auto own = [&](int i) { return "#" + std::to_string(next + i); };
    styled += own(0) + "=COLOUR_RGB(''," + rgb + ");\n" + own(1) + "=FILL_AREA_STYLE_COLOUR(''," +
              own(0) + ");\n" + own(2) + "=FILL_AREA_STYLE('',(" + own(1) + "));\n" + own(3) +
              "=SURFACE_STYLE_FILL_AREA(" + own(2) + ");\n" + own(4) + "=SURFACE_SIDE_STYLE('',(" +
              own(3) + "));\n" + own(5) + "=SURFACE_STYLE_USAGE(.BOTH.," + own(4) + ");\n" +
              own(6) + "=PRESENTATION_STYLE_ASSIGNMENT((" + own(5) + "));\n" + own(7) +
              "=STYLED_ITEM('',(" + own(6) + ")," + id + ");\n";
    items += (items.empty() ? "" : ",") + own(7);
    next += 10;
  };
  colour_face("10.", "shaft seat", "1.,0.,0.");
  colour_face("50.", "", "0.,0.,1.");
  const std::string context = entity(text, "( GEOMETRIC_REPRESENTATION_CONTEXT", "");
  styled += "#" + std::to_string(next) +
            "=MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',(" + items + ")," +
            context + ");\n";
  text.insert(text.rfind("ENDSEC;"), styled);
  std::ofstream(folder + "/coloured.step") << text;
}

// Two boxes that overlap, with four sides in common planes; every face has a name of its solid and a number.
void write_named_overlap() {
  const auto box = [](double from, double to) {
    return BRepPrimAPI_MakeBox(gp_Pnt(from, -10, 0), gp_Pnt(to, 10, 10)).Shape();
  };
  write_step("named_overlap", compound(box(0, 20), box(10, 30)));
  std::string text = text_of(folder + "/named_overlap.step");
  int number = 0;
  const std::string begin = "ADVANCED_FACE('";
  for (std::size_t at = text.find(begin); at != std::string::npos; at = text.find(begin, at + 1)) {
    text.insert(at + begin.size(), (number < 6 ? "first " : "second ") + std::to_string(number));
    ++number;
  }
  std::ofstream(folder + "/named_overlap.step") << text;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  folder = argv[1];
  const TopoDS_Shape plate = disc();
  write_step("flange", flange());
  write_step("bracket", bracket());
  write_step("nut", nut());
  write_step("ball_ring", ball_ring());
  write_step("two_solids",
             compound(BRepPrimAPI_MakeBox(gp_Pnt(-20, -20, 0), gp_Pnt(20, 20, 10)).Shape(),
                      cylinder(0, 0, 10, 8, 15)));
  write_step("overlap", compound(cylinder(0, 0, 0, 20, 20), cylinder(0, 0, 10, 10, 30)));
  const double inch = 25.4;
  const TopoDS_Shape block =
      BRepPrimAPI_MakeBox(gp_Pnt(-2 * inch, -inch, 0), gp_Pnt(2 * inch, inch, 0.5 * inch)).Shape();
  write_step("inch_plate", cut(block, cylinder(0, 0, -1, 0.5 * inch, 20)), "INCH");
  write_step("sheet", BRepBuilderAPI_MakeFace(gp_Pln(), 0, 10, 0, 10).Shape());
  write_iges("disc_faces", plate, 0);
  write_iges("disc_solid", plate, 1);
  write_step("disc", plate);
  write_coloured();
  write_named_overlap();
  return 0;
}
