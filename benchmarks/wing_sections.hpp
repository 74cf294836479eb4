/// Sections of the wings that benchmark programs write.
#pragma once

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeSolid.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepLib.hxx>
#include <GeomAPI_Interpolate.hxx>
#include <Geom_BSplineCurve.hxx>
#include <TColStd_HArray1OfReal.hxx>
#include <TColgp_HArray1OfPnt.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Solid.hxx>
#include <gp.hxx>
#include <gp_Pln.hxx>
#include <gp_Pnt.hxx>

namespace aeroloom::wings {

/// A section of the wing: where its leading edge is, its chord, the thickness of its trailing edge over
/// chord.
struct SpanSection {
  double x, y, chord, trailing_edge;
};

inline constexpr double thickness = 0.12;  // over chord
inline constexpr int intervals = 20;       // of the interpolated upper and lower side

/// Half the thickness of the four-digit section (Jacobs, Ward and Pinkerton, NACA report 460, 1933) at x of a
/// unit chord, closed at the trailing edge, whose own thickness is then added linearly.
inline double half_thickness(double x, double trailing_edge) {
  const double closed = 0.2969 * std::sqrt(x) + x * (-0.1260 + x * (-0.3516 + x * (0.2843 - 0.1036 * x)));
  return 5 * thickness * closed + 0.5 * trailing_edge * x;
}

inline gp_Pnt point_of(const SpanSection& section, double x, double sign) {
  return {section.x + section.chord * x, section.y,
          sign * section.chord * half_thickness(x, section.trailing_edge)};
}

/// One side from the leading to the trailing edge; the same parameters on every section.
inline Handle(Geom_BSplineCurve) side_of(const SpanSection& section, double sign) {
  const Handle(TColgp_HArray1OfPnt) points = new TColgp_HArray1OfPnt(1, intervals + 1);
  const Handle(TColStd_HArray1OfReal) parameters = new TColStd_HArray1OfReal(1, intervals + 1);
  for (int i = 0; i <= intervals; ++i) {
    const double angle = 0.5 * std::numbers::pi * i / intervals;
    points->SetValue(i + 1, point_of(section, i == intervals ? 1 : 1 - std::cos(angle), sign));
    parameters->SetValue(i + 1, angle);
  }
  GeomAPI_Interpolate interpolate(points, parameters, Standard_False, 1e-9);
  interpolate.Perform();
  return interpolate.Curve();
}

/// The face that closes the wing at a section.
inline TopoDS_Face cap(const SpanSection& section) {
  BRepBuilderAPI_MakeWire wire(BRepBuilderAPI_MakeEdge(side_of(section, 1)).Edge(),
                               BRepBuilderAPI_MakeEdge(side_of(section, -1)).Edge());
  if (section.trailing_edge > 0)
    wire.Add(BRepBuilderAPI_MakeEdge(point_of(section, 1, 1), point_of(section, 1, -1)).Edge());
  return BRepBuilderAPI_MakeFace(gp_Pln(point_of(section, 0, 1), gp::DY()), wire.Wire()).Face();
}

/// The solid inside of faces whose edges are less than `tolerance` apart.
inline TopoDS_Solid solid_of(const std::vector<TopoDS_Face>& faces, double tolerance) {
  BRepBuilderAPI_Sewing sewing(tolerance);
  for (const TopoDS_Face& face : faces) sewing.Add(face);
  sewing.Perform();
  if (sewing.SewedShape().ShapeType() != TopAbs_SHELL) throw std::runtime_error("the faces do not close");
  TopoDS_Solid solid = BRepBuilderAPI_MakeSolid(TopoDS::Shell(sewing.SewedShape()));
  BRepLib::OrientClosedSolid(solid);
  return solid;
}

}  // namespace aeroloom::wings
