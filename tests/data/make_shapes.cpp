// Makes the CAD files of this folder: make_shapes FOLDER. Not built with the tests: the files are kept, as
// those of another program would be.
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <utility>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepLib.hxx>
#include <BRepOffsetAPI_ThruSections.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRep_Tool.hxx>
#include <GC_MakeArcOfCircle.hxx>
#include <GeomAPI_PointsToBSpline.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <IGESControl_Writer.hxx>
#include <Interface_Static.hxx>
#include <STEPControl_Controller.hxx>
#include <STEPControl_Writer.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Solid.hxx>
#include <gp_Ax2.hxx>

namespace {

TopoDS_Edge curve_through(const TColgp_Array1OfPnt& points) {
  return BRepBuilderAPI_MakeEdge(GeomAPI_PointsToBSpline(points, 3, 5, GeomAbs_C2, 1e-4).Curve());
}

TopoDS_Shape outward(const TopoDS_Shape& shape) {
  TopoDS_Solid solid = TopoDS::Solid(shape);
  BRepLib::OrientClosedSolid(solid);
  return solid;
}

/// A round nose, a tube and a cone with a flat end: 8 m long and 1 m thick.
TopoDS_Shape fuselage() {
  const gp_Pnt nose(0, 0, 0), shoulder(0.5, 0, 0.5), waist(5, 0, 0.5), tail(8, 0, 0.1), end(8, 0, 0);
  const gp_Pnt between(0.5 - 0.5 * std::sqrt(0.5), 0, 0.5 * std::sqrt(0.5));
  BRepBuilderAPI_MakeWire outline;
  outline.Add(BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(nose, between, shoulder).Value()));
  outline.Add(BRepBuilderAPI_MakeEdge(shoulder, waist));
  outline.Add(BRepBuilderAPI_MakeEdge(waist, tail));
  outline.Add(BRepBuilderAPI_MakeEdge(tail, end));
  outline.Add(BRepBuilderAPI_MakeEdge(end, nose));
  const TopoDS_Face half = BRepBuilderAPI_MakeFace(outline.Wire());
  return outward(BRepPrimAPI_MakeRevol(half, gp_Ax1(nose, gp_Dir(1, 0, 0))).Shape());
}

/// NACA 0012 with its blunt trailing edge: two curves and a segment.
TopoDS_Wire section(double x, double y, double z, double chord) {
  constexpr int count = 15;
  TColgp_Array1OfPnt upper(1, count), lower(1, count);
  for (int i = 0; i < count; ++i) {
    const double s = 0.5 * (1 - std::cos(M_PI * i / (count - 1)));
    const double half = 0.6 * (0.2969 * std::sqrt(s) - 0.126 * s - 0.3516 * s * s + 0.2843 * s * s * s -
                               0.1015 * s * s * s * s);
    upper(i + 1) = gp_Pnt(x + chord * s, y, z + chord * half);
    lower(i + 1) = gp_Pnt(x + chord * s, y, z - chord * half);
  }
  BRepBuilderAPI_MakeWire wire(curve_through(upper));
  wire.Add(BRepBuilderAPI_MakeEdge(upper(count), lower(count)).Edge());
  wire.Add(curve_through(lower));
  return wire.Wire();
}

TopoDS_Shape wing(double side) {
  BRepOffsetAPI_ThruSections loft(true, true);
  loft.AddWire(section(2.6, 0, -0.1, 1.8));
  loft.AddWire(section(4.0, 4 * side, 0.1, 0.7));
  return outward(loft.Shape());
}

/// A plate that stands on another, with rounded edges, a bore and a slot.
TopoDS_Shape bracket() {
  const TopoDS_Shape foot = BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 0), 60, 40, 8).Shape();
  const TopoDS_Shape wall = BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 0), 8, 40, 45).Shape();
  TopoDS_Shape shape = BRepAlgoAPI_Fuse(foot, wall).Shape();
  BRepAlgoAPI_Fuse joined(foot, wall);
  joined.SimplifyResult();
  shape = joined.Shape();
  BRepFilletAPI_MakeFillet rounding(shape);
  for (TopExp_Explorer edge(shape, TopAbs_EDGE); edge.More(); edge.Next()) {
    const TopoDS_Edge& e = TopoDS::Edge(edge.Current());
    gp_Pnt ends[2];
    int n = 0;
    for (TopExp_Explorer v(e, TopAbs_VERTEX); v.More() && n < 2; v.Next())
      ends[n++] = BRep_Tool::Pnt(TopoDS::Vertex(v.Current()));
    const bool is_inner = ends[0].X() == 8 && ends[1].X() == 8 && ends[0].Z() == 8 && ends[1].Z() == 8;
    const bool is_corner = ends[0].X() == 60 && ends[1].X() == 60 && ends[0].Y() == ends[1].Y();
    if (is_inner || is_corner) rounding.Add(5, e);
  }
  shape = rounding.Shape();
  const gp_Ax2 up(gp_Pnt(38, 20, -1), gp_Dir(0, 0, 1)), across(gp_Pnt(-1, 20, 30), gp_Dir(1, 0, 0));
  shape = BRepAlgoAPI_Cut(shape, BRepPrimAPI_MakeCylinder(up, 9, 20).Shape()).Shape();
  return BRepAlgoAPI_Cut(shape, BRepPrimAPI_MakeCylinder(across, 6, 20).Shape()).Shape();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const std::filesystem::path folder = argv[1];
  STEPControl_Controller::Init();
  Interface_Static::SetCVal("write.step.unit", "M");
  Interface_Static::SetCVal("xstep.cascade.unit", "M");
  STEPControl_Writer step;
  step.Transfer(BRepAlgoAPI_Fuse(BRepAlgoAPI_Fuse(fuselage(), wing(1)).Shape(), wing(-1)).Shape(),
                STEPControl_AsIs);
  step.Write((folder / "wing_body.step").c_str());
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  IGESControl_Writer iges("MM", 0);  // trimmed faces that know nothing of each other
  iges.AddShape(bracket());
  iges.ComputeModel();
  iges.Write((folder / "bracket.igs").c_str());
  return 0;
}
