#include "cad/read/scale_shape.hpp"

#include "cad/model/shape_map.hpp"
#include "cad/tolerances.hpp"

#include <algorithm>
#include <cmath>

#include <BRepTools_Modifier.hxx>
#include <BRepTools_TrsfModification.hxx>
#include <BRep_Tool.hxx>
#include <Geom2dConvert.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <Geom2d_Line.hxx>
#include <Geom2d_TrimmedCurve.hxx>
#include <Geom_Curve.hxx>
#include <Geom_Plane.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_Surface.hxx>
#include <ShapeFix_ShapeTolerance.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColgp_Array1OfPnt2d.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>
#include <gp_GTrsf2d.hxx>
#include <gp_Trsf.hxx>

namespace aeroloom::cad {
namespace {

bool is_plane(Handle(Geom_Surface) surface) {
  if (const auto trimmed = Handle(Geom_RectangularTrimmedSurface)::DownCast(surface); !trimmed.IsNull())
    surface = trimmed->BasisSurface();
  return !Handle(Geom_Plane)::DownCast(surface).IsNull();
}

/// Factors of the parameters of a surface, and of those of the curve on it.
struct ParameterScales {
  double u, v, along;

  gp_Pnt2d operator()(const gp_Pnt2d& at) const { return {u * at.X(), v * at.Y()}; }
};

Handle(Geom2d_Curve) chord(const gp_Pnt2d& begin, const gp_Pnt2d& end, double first, double last) {
  TColgp_Array1OfPnt2d poles(1, 2);
  TColStd_Array1OfReal knots(1, 2);
  TColStd_Array1OfInteger multiplicities(1, 2);
  poles(1) = begin, poles(2) = end;
  knots(1) = first, knots(2) = last;
  multiplicities.Init(2);
  return new Geom2d_BSplineCurve(poles, knots, multiplicities, 1);
}

Handle(Geom2d_Curve)
    scaled_line(const Geom2d_Line& line, double first, double last, const ParameterScales& scales) {
  const gp_Dir2d direction = line.Direction();
  const gp_Vec2d speed(scales.u * direction.X() / scales.along, scales.v * direction.Y() / scales.along);
  if (std::abs(speed.Magnitude() - 1) <= tolerances::rounding)
    return new Geom2d_Line(scales(line.Location()), gp_Dir2d(speed));
  return chord(scales(line.Value(first)), scales(line.Value(last)), scales.along * first,
               scales.along * last);
}

Handle(Geom2d_Curve) scaled_spline(const Handle(Geom2d_Curve) & curve, double first, double last,
                                   const ParameterScales& scales) {
  const Handle(Geom2d_BSplineCurve) spline =
      Geom2dConvert::CurveToBSplineCurve(new Geom2d_TrimmedCurve(curve, first, last));
  for (int i = 1; i <= spline->NbPoles(); ++i) spline->SetPole(i, scales(spline->Pole(i)));
  TColStd_Array1OfReal knots(1, spline->NbKnots());
  spline->Knots(knots);
  for (double& knot : knots) knot *= scales.along;
  spline->SetKnots(knots);
  return {spline};
}

/// As the library's, but curves in parameters are scaled without regard to its precision.
class Scaling : public BRepTools_TrsfModification {
public:
  using BRepTools_TrsfModification::BRepTools_TrsfModification;

  bool NewCurve2d(const TopoDS_Edge& edge, const TopoDS_Face& face, const TopoDS_Edge&, const TopoDS_Face&,
                  Handle(Geom2d_Curve) & result, double& tolerance) override {
    tolerance = BRep_Tool::Tolerance(edge) * Trsf().ScaleFactor();
    const Handle(Geom_Surface) surface = BRep_Tool::Surface(face);
    double first, last;
    Handle(Geom2d_Curve) curve = BRep_Tool::CurveOnSurface(edge, face, first, last);
    if (curve.IsNull() || is_plane(surface)) return false;  // the library has none on planes either
    if (const auto trimmed = Handle(Geom2d_TrimmedCurve)::DownCast(curve); !trimmed.IsNull())
      curve = trimmed->BasisCurve();
    double low, high;
    const Handle(Geom_Curve) in_space = BRep_Tool::Curve(edge, low, high);
    const gp_GTrsf2d parameters = surface->ParametricTransformation(Trsf());
    const ParameterScales scales{parameters.Value(1, 1), parameters.Value(2, 2),
                                 in_space.IsNull() ? 1 : in_space->ParametricTransformation(Trsf())};
    const auto line = Handle(Geom2d_Line)::DownCast(curve);
    if (scales.u == 1 && scales.v == 1 && scales.along == 1)
      result = Handle(Geom2d_Curve)::DownCast(curve->Copy());
    else if (!line.IsNull())
      result = scaled_line(*line, first, last, scales);
    else
      result = scaled_spline(curve, first, last, scales);
    return true;
  }
};

double tolerance_of(const TopoDS_Shape& part) {
  if (part.ShapeType() == TopAbs_FACE) return BRep_Tool::Tolerance(TopoDS::Face(part));
  if (part.ShapeType() == TopAbs_EDGE) return BRep_Tool::Tolerance(TopoDS::Edge(part));
  return BRep_Tool::Tolerance(TopoDS::Vertex(part));
}

}  // namespace

double precision_in(double unit, double stated) {
  return stated <= tolerances::library_length ? stated : stated / unit;
}

namespace {

TopoDS_Shape scaled_shape(const TopoDS_Shape& shape, double unit) {
  gp_Trsf transformation;
  transformation.SetScaleFactor(1 / unit);
  const Handle(Scaling) scaling = new Scaling(transformation);
  BRepTools_Modifier modifier(shape, scaling);
  const TopoDS_Shape& scaled = modifier.ModifiedShape(shape);
  const ShapeFix_ShapeTolerance tolerance;
  for (const TopAbs_ShapeEnum kind : {TopAbs_FACE, TopAbs_EDGE, TopAbs_VERTEX}) {
    const TopTools_IndexedMapOfShape before = map_of(shape, kind), after = map_of(scaled, kind);
    for (int i = 1; i <= after.Extent(); ++i)
      tolerance.SetTolerance(
          after(i), std::max(tolerances::library_length, precision_in(unit, tolerance_of(before(i)))), kind);
  }
  return scaled;
}

}  // namespace

NamedShape scaled(NamedShape named, double unit) {
  const TopoDS_Shape shape = scaled_shape(named.shape, unit / named.unit);
  const TopTools_IndexedMapOfShape before = map_of(named.shape, TopAbs_FACE),
                                   after = map_of(shape, TopAbs_FACE);
  FaceLabels labels;
  for (int i = 1; i <= before.Extent() && i <= after.Extent(); ++i)
    if (const FaceLabel* label = named.labels.Seek(before(i))) labels.Bind(after(i), *label);
  named.labels = labels;
  named.shape = shape;
  named.precision = precision_in(unit / named.unit, named.precision);
  named.unit = unit;
  return named;
}

}  // namespace aeroloom::cad
