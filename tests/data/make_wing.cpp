// Makes configs/geometry/wing.step: make_wing FILE. Compile against OpenCASCADE by hand; nothing else needs
// it.
#include <cmath>

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepOffsetAPI_ThruSections.hxx>
#include <GeomAPI_Interpolate.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Interface_Static.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <STEPControl_Controller.hxx>
#include <TColgp_HArray1OfPnt.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Wire.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <gp_Pnt.hxx>

namespace {

/// Half the thickness of the aerofoil NACA 0012 with a closed trailing edge, over the chord.
double half_thickness(double x) {
  return 0.6 * (0.2969 * std::sqrt(x) + x * (-0.1260 + x * (-0.3516 + x * (0.2843 - 0.1036 * x))));
}

/// One side of a section from nose to trailing edge, by points close together at both.
TopoDS_Edge side(gp_Pnt nose, double chord, double sign) {
  constexpr int points = 41;
  Handle(TColgp_HArray1OfPnt) places = new TColgp_HArray1OfPnt(1, points);
  for (int i = 0; i < points; ++i) {
    const double x = 0.5 * (1 - std::cos(M_PI * i / (points - 1)));
    const double z = i == 0 || i == points - 1 ? 0 : sign * half_thickness(x);
    places->SetValue(i + 1, gp_Pnt(nose.X() + chord * x, nose.Y(), nose.Z() + chord * z));
  }
  GeomAPI_Interpolate curve(places, false, 1e-9);
  curve.Perform();
  return BRepBuilderAPI_MakeEdge(curve.Curve());
}

TopoDS_Wire section(gp_Pnt nose, double chord) {
  return BRepBuilderAPI_MakeWire(side(nose, chord, 1), side(nose, chord, -1));
}

}  // namespace

/// Half a wing from the plane y = 0 to y = 3 m: chord 1 m at the root, 0.5 m at the tip, the leading edge
/// swept by 20 degrees, the trailing edge sharp. The solid is called wing.
int main(int argc, char** argv) {
  if (argc != 2) return 2;
  STEPControl_Controller::Init();
  Interface_Static::SetCVal("write.step.unit", "M");
  Interface_Static::SetCVal("xstep.cascade.unit", "M");
  BRepOffsetAPI_ThruSections loft(true, true);
  loft.AddWire(section(gp_Pnt(0, 0, 0), 1));
  loft.AddWire(section(gp_Pnt(3 * std::tan(20 * M_PI / 180), 3, 0), 0.5));
  loft.Build();
  Handle(TDocStd_Document) document;
  XCAFApp_Application::GetApplication()->NewDocument("MDTV-XCAF", document);
  const TDF_Label part = XCAFDoc_DocumentTool::ShapeTool(document->Main())->AddShape(loft.Shape(), false);
  TDataStd_Name::Set(part, "wing");
  STEPCAFControl_Writer writer;
  writer.SetNameMode(true);
  writer.Transfer(document, STEPControl_AsIs);
  writer.Write(argv[1]);
  return 0;
}
