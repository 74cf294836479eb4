// many_faces: writes CAD models of a thousand faces and more, as STEP, to see what the work per face costs.
//
// usage: many_faces plate|stack|exchanger FILE.step [COUNT]
//
// plate: a plate with COUNT (default 350) countersunk holes, three faces each.
// stack: COUNT (default 180) thin sheets of different extents, close to each other, six faces each.
// exchanger: COUNT (default 500) thin pipes close to each other between two plates, two faces each, askew, 50
// inches long, in inches.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRep_Builder.hxx>
#include <Interface_Static.hxx>
#include <STEPControl_Writer.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS_Compound.hxx>
#include <gp_Ax1.hxx>
#include <gp_Ax2.hxx>
#include <gp_Pnt.hxx>
#include <gp_Trsf.hxx>

namespace {

constexpr double thickness = 0.05;

/// What a countersunk drill leaves, on the axis through (x, y).
TopoDS_Shape drill(double x, double y, double radius) {
  const double sink = 0.3 * thickness, over = 0.1 * thickness;
  BRepBuilderAPI_MakePolygon profile;
  profile.Add(gp_Pnt(x, y, -over));
  profile.Add(gp_Pnt(x + radius + sink + over, y, -over));
  profile.Add(gp_Pnt(x + radius, y, sink));
  profile.Add(gp_Pnt(x + radius, y, thickness - sink));
  profile.Add(gp_Pnt(x + radius + sink + over, y, thickness + over));
  profile.Add(gp_Pnt(x, y, thickness + over));
  profile.Close();
  const gp_Ax1 axis(gp_Pnt(x, y, 0), gp_Dir(0, 0, 1));
  return BRepPrimAPI_MakeRevol(BRepBuilderAPI_MakeFace(profile.Wire()), axis).Shape();
}

TopoDS_Shape make_plate(int holes) {
  const int columns = static_cast<int>(std::ceil(std::sqrt(1.5 * holes)));
  const int rows = (holes + columns - 1) / columns;
  constexpr double pitch = 0.1;
  TopTools_ListOfShape plate, drills;
  plate.Append(BRepPrimAPI_MakeBox(pitch * columns, pitch * rows, thickness).Shape());
  for (int i = 0; i < holes; ++i) {
    const double radius = pitch * (0.1 + 0.15 * (i * 7 % 11) / 10);
    const int column = i % columns, row = i / columns;
    drills.Append(drill(pitch * (column + 0.5), pitch * (row + 0.5), radius));
  }
  BRepAlgoAPI_Cut cut;
  cut.SetArguments(plate);
  cut.SetTools(drills);
  cut.Build();
  if (!cut.IsDone()) throw std::runtime_error("the holes cannot be cut");
  return cut.Shape();
}

TopoDS_Shape make_stack(int sheets) {
  TopoDS_Compound stack;
  BRep_Builder builder;
  builder.MakeCompound(stack);
  double z = 0;
  for (int i = 0; i < sheets; ++i) {
    const double length = 0.6 + 0.04 * (i * 5 % 11), width = 0.4 + 0.03 * (i * 3 % 7);
    const double thin = 0.003 + 0.001 * (i % 4);
    const gp_Pnt low(0.01 * (i * 4 % 9), 0.01 * (i * 2 % 5), z);
    builder.Add(stack, BRepPrimAPI_MakeBox(low, length, width, thin).Shape());
    z += thin + 0.004 + 0.002 * (i % 3);
  }
  return stack;
}

/// Of a shape the others are taken away, or are added to it.
template <class Operation>
TopoDS_Shape combine(const TopoDS_Shape& shape, const TopTools_ListOfShape& others) {
  TopTools_ListOfShape shapes;
  shapes.Append(shape);
  Operation operation;
  operation.SetArguments(shapes);
  operation.SetTools(others);
  operation.Build();
  if (!operation.IsDone()) throw std::runtime_error("the pipes cannot be joined");
  return operation.Shape();
}

TopoDS_Shape make_exchanger(int pipes) {
  constexpr double inch = 25.4, length = 50 * inch, plate = inch, pitch = 0.8 * inch;
  constexpr double bore = 0.3 * inch, wall = 0.03 * inch;
  const int columns = static_cast<int>(std::ceil(std::sqrt(pipes))), rows = (pipes + columns - 1) / columns;
  const double width = pitch * (columns + 1), height = pitch * (rows + 1);
  TopTools_ListOfShape outer, inner;
  for (int i = 0; i < pipes; ++i) {
    const double x = pitch * (1 + i % columns), y = pitch * (1 + i / columns);
    const gp_Ax2 from(gp_Pnt(x, y, 0.5 * plate), gp_Dir(0, 0, 1));
    outer.Append(BRepPrimAPI_MakeCylinder(from, bore + wall, length - plate).Shape());
    const gp_Ax2 before(gp_Pnt(x, y, -plate), gp_Dir(0, 0, 1));
    inner.Append(BRepPrimAPI_MakeCylinder(before, bore, length + 2 * plate).Shape());
  }
  outer.Append(BRepPrimAPI_MakeBox(gp_Pnt(0, 0, length - plate), width, height, plate).Shape());
  const TopoDS_Shape body =
      combine<BRepAlgoAPI_Fuse>(BRepPrimAPI_MakeBox(width, height, plate).Shape(), outer);
  gp_Trsf askew;
  askew.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(1, 2, 0.5)), 0.7);
  return BRepBuilderAPI_Transform(combine<BRepAlgoAPI_Cut>(body, inner), askew).Shape();
}

}  // namespace

int main(int argc, char** argv) {
  const std::string kind = argc > 1 ? argv[1] : "";
  if (argc < 3 || (kind != "plate" && kind != "stack" && kind != "exchanger")) {
    std::fprintf(stderr, "usage: many_faces plate|stack|exchanger FILE.step [COUNT]\n");
    return 2;
  }
  try {
    const int usual = kind == "plate" ? 350 : kind == "stack" ? 180 : 500;
    const int count = argc > 3 ? std::atoi(argv[3]) : usual;
    STEPControl_Writer writer;
    if (kind == "exchanger") Interface_Static::SetCVal("write.step.unit", "INCH");
    writer.Transfer(kind == "plate"   ? make_plate(count)
                    : kind == "stack" ? make_stack(count)
                                      : make_exchanger(count),
                    STEPControl_AsIs);
    if (writer.Write(argv[2]) != IFSelect_RetDone) throw std::runtime_error("the file cannot be written");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "many_faces: %s\n", error.what());
    return 1;
  }
  return 0;
}
