#include "cad/repair/edge_on_face.hpp"

#include "cad/model/model.hpp"
#include "cad/tolerances.hpp"

#include <algorithm>

#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Geom2dAPI_Interpolate.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <TColStd_HArray1OfReal.hxx>
#include <TColgp_HArray1OfPnt2d.hxx>

namespace aeroloom::cad {

Handle(Geom2d_Curve) image_beside(const EdgeInterval& edge, const EdgeInterval& other,
                                  const Handle(Geom2d_Curve) & image, bool against, double tolerance) {
  constexpr int fewest = 16, most = 1024;  // points; doubled until `interpolated`, chosen, not measured
  const SampledEdge own(edge.edge), beside(other.edge);
  const auto along = [](const EdgeInterval& interval, double fraction) {
    return interval.first + fraction * (interval.last - interval.first);
  };
  // Where on the other: ends belong to ends.
  const auto foot = [&](double fraction) {
    const double guess = along(other, against ? 1 - fraction : fraction);
    if (fraction <= 0 || fraction >= 1) return guess;
    const Vec3 point = own.point(along(edge, fraction));
    SampledEdge::Foot found = beside.nearest_around(point, guess);
    if (found.away > 2 * tolerance) found = beside.nearest(point, 2 * tolerance);
    return std::clamp(found.parameter, other.first, other.last);
  };
  Handle(Geom2d_BSplineCurve) curve;
  for (int count = fewest; count <= most; count *= 2) {
    const Handle(TColgp_HArray1OfPnt2d) uv = new TColgp_HArray1OfPnt2d(1, count + 1);
    const Handle(TColStd_HArray1OfReal) at = new TColStd_HArray1OfReal(1, count + 1);
    for (int i = 0; i <= count; ++i) {
      const double fraction = static_cast<double>(i) / count;
      uv->SetValue(i + 1, image->Value(foot(fraction)));
      at->SetValue(i + 1, i == count ? edge.last : along(edge, fraction));
    }
    Geom2dAPI_Interpolate interpolation(uv, at, false, 0);
    interpolation.Perform();
    if (!interpolation.IsDone())
      throw CadError("an edge beside a strip has no parameter curve that follows it");
    curve = interpolation.Curve();
    double apart = 0, extent = 0;
    const gp_Pnt2d start = uv->Value(1);
    for (int i = 0; i < count; ++i) {
      const double fraction = (i + 0.5) / count;
      const gp_Pnt2d exact = image->Value(foot(fraction));
      apart = std::max(apart, curve->Value(along(edge, fraction)).Distance(exact));
      extent = std::max(extent, exact.Distance(start));
    }
    if (apart <= tolerances::interpolated * extent) break;
  }
  return curve;
}

void add_image(const TopoDS_Edge& edge, const Handle(Geom2d_Curve) & image, const TopoDS_Face& face,
               bool forward, double tolerance) {
  BRep_Builder builder;
  double low, high;
  const Handle(Geom2d_Curve) known = BRep_Tool::CurveOnSurface(edge, face, low, high);
  if (known.IsNull())
    builder.UpdateEdge(edge, image, face, tolerance);
  else if (forward)
    builder.UpdateEdge(edge, image, known, face, tolerance);
  else
    builder.UpdateEdge(edge, known, image, face, tolerance);
}

}  // namespace aeroloom::cad
