#include "cad/repair/repair_edges.hpp"

#include "cad/model/model_data.hpp"
#include "cad/model/to_vec.hpp"
#include "cad/model/topology/model_topology.hpp"
#include "cad/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <BRepLib.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Geom2dAPI_Interpolate.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <Geom2d_Curve.hxx>
#include <Geom_Curve.hxx>
#include <NCollection_DataMap.hxx>
#include <ShapeFix_Edge.hxx>
#include <TColStd_HArray1OfReal.hxx>
#include <TColgp_HArray1OfPnt2d.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_ShapeMapHasher.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

/// Of an edge, and of the parameter curve that is drawn through them; chosen, not measured.
constexpr int samples = 200;

/// Crowded towards the ends, where parameters run away most.
double sample_parameter(double first, double last, int i) {
  return first + (last - first) * 0.5 * (1 - std::cos(std::numbers::pi * i / samples));
}

/// An edge with its image in the parameters of a face.
class EdgeOnFace {
public:
  EdgeOnFace(const TopoDS_Edge& edge, const FaceEvaluator& face)
      : _face(face),
        _curve(BRep_Tool::Curve(edge, _first, _last)),
        _image(BRep_Tool::CurveOnSurface(edge, face.shape, _low, _high)) {}

  double parameter(int i) const { return i == samples ? _last : sample_parameter(_first, _last, i); }
  Vec3 point(int i) const { return to_vec(_curve->Value(parameter(i))); }
  Vec2 image(int i) const {
    const gp_Pnt2d uv = _image->Value(_low + (parameter(i) - _first) / (_last - _first) * (_high - _low));
    return {uv.X(), uv.Y()};
  }
  /// Whether the two lie farther apart than that somewhere, at equal parameters.
  bool differ_by_more(double tolerance) const {
    for (int i = 0; i <= samples; ++i) {
      if (distance(_face.surface.point(image(i)), point(i)) > tolerance) return true;
    }
    return false;
  }

private:
  const FaceEvaluator& _face;
  double _first = 0, _last = 0, _low = 0, _high = 0;
  Handle(Geom_Curve) _curve;
  Handle(Geom2d_Curve) _image;
};

struct Pace {
  double before = 0,
         after = 0;  ///< largest distance of the edge from its parameter curve at equal parameters
  Handle(TColgp_HArray1OfPnt2d) uv;  ///< of the points of the edge
  Handle(TColStd_HArray1OfReal) at;
};

Pace measure_pace(const EdgeOnFace& edge, const FaceEvaluator& face, double tolerance) {
  Pace pace{0, 0, new TColgp_HArray1OfPnt2d(1, samples + 1), new TColStd_HArray1OfReal(1, samples + 1)};
  for (int i = 0; i <= samples; ++i) {
    const Vec3 point = edge.point(i);
    Vec2 uv = edge.image(i);
    pace.before = std::max(pace.before, distance(face.surface.point(uv), point));
    if (i > 0 && i < samples) uv = find_parameters(face, point, uv, tolerance);
    pace.after = std::max(pace.after, distance(face.surface.point(uv), point));
    pace.uv->SetValue(i + 1, gp_Pnt2d(uv.x, uv.y));
    pace.at->SetValue(i + 1, edge.parameter(i));
  }
  return pace;
}

/// Gives an edge that leaves its face, because its two curves run at different paces, a parameter curve that
/// keeps up. True when it did.
bool keep_pace(const TopoDS_Edge& edge, const FaceEvaluator& face, double tolerance) {
  const EdgeOnFace on_face(edge, face);
  if (!on_face.differ_by_more(tolerance)) return false;
  const Pace pace = measure_pace(on_face, face, tolerances::foot_that_measures * tolerance);
  if (pace.after > tolerances::better_pace * pace.before) return false;
  Geom2dAPI_Interpolate interpolation(pace.uv, pace.at, false, 0);
  interpolation.Perform();
  if (!interpolation.IsDone()) return false;
  BRep_Builder builder;
  builder.UpdateEdge(edge, interpolation.Curve(), face.shape, pace.after);
  builder.Range(edge, face.shape, pace.at->First(), pace.at->Last());
  return true;
}

}  // namespace

void repair_edges(const TopoDS_Shape& shape, double tolerance, Changes& changes) {
  TopTools_IndexedDataMapOfShapeListOfShape users;
  TopExp::MapShapesAndUniqueAncestors(shape, TopAbs_EDGE, TopAbs_FACE, users);
  // Made when first asked for; anew where parameter curves of the face have changed.
  NCollection_DataMap<TopoDS_Shape, FaceEvaluator, TopTools_ShapeMapHasher> evaluators;
  int curves = 0, images = 0, paces = 0;
  for (int i = 1; i <= users.Extent(); ++i) {
    const TopoDS_Edge edge = TopoDS::Edge(users.FindKey(i).Oriented(TopAbs_FORWARD));
    if (BRep_Tool::Degenerated(edge)) continue;
    double first, last;
    if (BRep_Tool::Curve(edge, first, last).IsNull()) curves += BRepLib::BuildCurve3d(edge);
    for (const TopoDS_Shape& shape_of_face : users(i)) {
      const TopoDS_Face face = TopoDS::Face(shape_of_face.Oriented(TopAbs_FORWARD));
      const bool seam = BRep_Tool::IsClosed(edge, face);
      if (BRep_Tool::CurveOnSurface(edge, face, first, last).IsNull()) {
        images += ShapeFix_Edge().FixAddPCurve(edge, face, seam);
        evaluators.UnBind(face);
      } else if (!seam && !BRep_Tool::Curve(edge, first, last).IsNull()) {
        if (!evaluators.IsBound(face)) evaluators.Bind(face, make_evaluator(face, tolerance));
        if (!keep_pace(edge, evaluators.Find(face), tolerance)) continue;
        ++paces;
        evaluators.UnBind(face);
      }
    }
  }
  if (curves > 0) changes.push_back({fmt::format("{} edges got the curve they lacked", curves)});
  if (images > 0)
    changes.push_back({fmt::format("{} edges got the parameter curve they lacked on a face", images)});
  if (paces > 0) {
    changes.push_back({fmt::format(
        "{} parameter curves left their edges by more than {:.3g}, running at another pace: fitted anew",
        paces, tolerance)});
  }
}

}  // namespace aeroloom::cad
