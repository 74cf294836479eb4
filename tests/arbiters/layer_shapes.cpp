/// Shapes for meshes with layers, as BREP files: layer_shapes FOLDER.
#include <cstdio>
#include <initializer_list>
#include <string>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <TopoDS_Compound.hxx>
#include <gp_Ax2.hxx>
#include <gp_Pln.hxx>

namespace {

TopoDS_Shape together(std::initializer_list<TopoDS_Shape> shapes) {
  TopoDS_Compound compound;
  BRep_Builder builder;
  builder.MakeCompound(compound);
  for (const TopoDS_Shape& shape : shapes) builder.Add(compound, shape);
  return compound;
}

/// Half of a ball of radius 2 without a rod of radius 0.4 along z that goes through it: y >= 0.
TopoDS_Shape half_ball_with_rod() {
  const TopoDS_Shape rod =
      BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0, 0, -4), gp_Dir(0, 0, 1)), 0.4, 8).Shape();
  const TopoDS_Shape ball = BRepAlgoAPI_Cut(BRepPrimAPI_MakeSphere(2.0).Shape(), rod).Shape();
  return BRepAlgoAPI_Cut(ball, BRepPrimAPI_MakeBox(gp_Pnt(-9, -9, -9), gp_Pnt(9, 0, 9)).Shape()).Shape();
}

/// A plate along a duct with free rims.
TopoDS_Shape plate() {
  const gp_Pln plane(gp_Ax3(gp_Pnt(0, 0, 0.5), gp_Dir(0, 0, 1), gp_Dir(1, 0, 0)));
  return BRepBuilderAPI_MakeFace(plane, 1, 2, 0.25, 0.75).Shape();
}

/// A fin whose leading and trailing edge lie in the plane y = 0.
TopoDS_Shape fin() {
  BRepBuilderAPI_MakePolygon section(gp_Pnt(-1, 0, 0), gp_Pnt(0, -0.2, 0), gp_Pnt(1, 0, 0), gp_Pnt(0, 0.2, 0),
                                     true);
  return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(section.Wire()).Shape(), gp_Vec(0, 0, 1)).Shape();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return std::puts("usage: layer_shapes FOLDER"), 2;
  const auto write = [&](const char* name, const TopoDS_Shape& shape) {
    return BRepTools::Write(shape, (std::string(argv[1]) + "/" + name + ".brep").c_str());
  };
  const TopoDS_Shape duct = BRepPrimAPI_MakeBox(3.0, 1.0, 1.0).Shape();
  const TopoDS_Shape other = BRepPrimAPI_MakeBox(gp_Pnt(3, 0, 0), 1.0, 1.0, 1.0).Shape();
  const bool written = write("box", BRepPrimAPI_MakeBox(gp_Pnt(0, -0.5, 0), 1.0, 1.0, 0.5).Shape()) &&
                       write("rod", half_ball_with_rod()) && write("plate", together({duct, plate()})) &&
                       write("boxes", together({duct, other})) && write("fin", fin());
  return written ? 0 : 1;
}
