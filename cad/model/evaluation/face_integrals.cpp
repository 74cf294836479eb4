#include "cad/model/evaluation/face_integrals.hpp"

#include "cad/model/shape_map.hpp"
#include "cad/tolerances.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Geom2dAdaptor_Curve.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Iterator.hxx>
#include <math.hxx>
#include <math_Vector.hxx>

namespace aeroloom::cad {
namespace {

/// Gauss's rule on [-1, 1].
struct Rule {
  std::vector<double> points, weights;

  explicit Rule(int count) {
    math_Vector at(1, count), weight(1, count);
    math::GaussPoints(count, at);
    math::GaussWeights(count, weight);
    for (int i = 1; i <= count; ++i) points.push_back(at(i)), weights.push_back(weight(i));
  }
};

/// The rule for each of so many parts of an interval: splines of many spans are smooth over each of them. A
/// rule of n points is exact up to degree 2n - 1; where one part stands for a whole analytic surface it is
/// 23, and with many parts 3, their number making up for it. The numbers of parts were chosen, not measured.
const Rule& rule_for(std::size_t parts) {
  static const Rule two(2), three(3), five(5), twelve(12);
  return parts <= 1 ? twelve : parts <= 4 ? five : parts <= 10 ? three : two;
}

/// Calls `visit(parameter, weight)` at the points of the rule on each part between breaks.
template <class Visit>
void integrate(const std::vector<double>& breaks, Visit&& visit) {
  const Rule& rule = rule_for(breaks.size() - 1);
  for (std::size_t part = 0; part + 1 < breaks.size(); ++part) {
    const double middle = 0.5 * (breaks[part] + breaks[part + 1]);
    const double half = 0.5 * (breaks[part + 1] - breaks[part]);
    for (std::size_t i = 0; i < rule.points.size(); ++i)
      visit(middle + half * rule.points[i], half * rule.weights[i]);
  }
}

/// The knots of one direction of a surface, those of the periods beside it included.
std::vector<double> knots_of(const TColStd_Array1OfReal& intervals, double period) {
  std::vector<double> knots;
  for (const double knot : intervals) {
    knots.push_back(knot);
    if (period > 0) knots.insert(knots.end(), {knot - period, knot + period});
  }
  std::sort(knots.begin(), knots.end());
  return knots;
}

/// From one parameter to another, in either sense, with the knots between them.
void list_breaks(double from, double to, const std::vector<double>& knots, std::vector<double>& breaks) {
  const auto [low, high] = std::minmax(from, to);
  const double rounding = tolerances::same_parameter * (high - low);
  breaks.assign(1, low);
  for (auto k = std::upper_bound(knots.begin(), knots.end(), low + rounding);
       k != knots.end() && *k < high - rounding; ++k) {
    if (*k > breaks.back() + rounding) breaks.push_back(*k);
  }
  breaks.push_back(high);
  if (from > to) std::reverse(breaks.begin(), breaks.end());
}

class FaceIntegrator {
public:
  FaceIntegrator(const SurfaceEvaluator& surface, Vec3 reference, Vec2 low)
      : _surface(surface), _reference(reference), _low(low) {
    const GeomAdaptor_Surface& s = surface.adaptor();
    TColStd_Array1OfReal u(1, s.NbUIntervals(GeomAbs_CN) + 1), v(1, s.NbVIntervals(GeomAbs_CN) + 1);
    s.UIntervals(u, GeomAbs_CN);
    s.VIntervals(v, GeomAbs_CN);
    _u_knots = knots_of(u, s.IsUPeriodic() ? s.UPeriod() : 0);
    _v_knots = knots_of(v, s.IsVPeriodic() ? s.VPeriod() : 0);
  }

  /// Along a parameter curve, `sign` -1 where the loop runs against it.
  void add(const Geom2dAdaptor_Curve& curve, double sign) {
    list_breaks(curve);
    integrate(_along, [&](double t, double weight) {
      gp_Pnt2d at;
      gp_Vec2d tangent;
      curve.D1(t, at, tangent);
      if (tangent.Y() != 0) add_row({at.X(), at.Y()}, sign * weight * tangent.Y());
    });
  }

  /// The whole rectangle from `low` to here.
  void add_rectangle(Vec2 high) {
    cad::list_breaks(_low.y, high.y, _v_knots, _along);
    integrate(_along, [&](double v, double weight) { add_row({high.x, v}, weight); });
  }

  const FaceIntegrals& sums() const { return _sums; }

private:
  /// Where the curve or, at about those places, the surface below it changes from one polynomial to the next.
  void list_breaks(const Geom2dAdaptor_Curve& curve) {
    TColStd_Array1OfReal intervals(1, curve.NbIntervals(GeomAbs_CN) + 1);
    curve.Intervals(intervals, GeomAbs_CN);
    _along.assign(1, intervals.First());
    for (int i = intervals.Lower(); i < intervals.Upper(); ++i) {
      const double from = intervals(i), to = intervals(i + 1);
      const double v_from = curve.Value(from).Y(), v_to = curve.Value(to).Y();
      cad::list_breaks(v_from, v_to, _v_knots, _crossed);
      for (std::size_t k = 1; k + 1 < _crossed.size(); ++k)
        _along.push_back(from + (_crossed[k] - v_from) / (v_to - v_from) * (to - from));
      _along.push_back(to);
    }
  }

  /// The integrals along u from the low side to a point, times a weight.
  void add_row(Vec2 to, double weight) {
    cad::list_breaks(_low.x, to.x, _u_knots, _across);
    integrate(_across, [&](double u, double width) {
      const SurfaceJet jet = _surface.jet({u, to.y}, 1);
      const Vec3 normal = cross(jet.du, jet.dv);
      const Vec3 at = jet.point - _reference;
      _sums.area += weight * width * norm(normal);
      _sums.flux += weight * width * dot(at, normal) / 3;
      _sums.area_vector += weight * width * normal;
      _sums.moment += weight * width * norm(normal) * at;
    });
  }

  const SurfaceEvaluator& _surface;
  Vec3 _reference;
  Vec2 _low;
  std::vector<double> _u_knots, _v_knots;
  std::vector<double> _along, _across, _crossed;
  FaceIntegrals _sums;
};

}  // namespace

FaceIntegrals integrate_face(const TopoDS_Face& face, const SurfaceEvaluator& surface, Vec3 reference) {
  const TopoDS_Face forward = TopoDS::Face(face.Oriented(TopAbs_FORWARD));
  Vec2 low, high;
  BRepTools::UVBounds(forward, low.x, high.x, low.y, high.y);
  FaceIntegrator integrator(surface, reference, low);
  if (!TopoDS_Iterator(forward).More()) integrator.add_rectangle(high);
  for (TopExp_Explorer each(forward, TopAbs_EDGE); each.More(); each.Next()) {
    const TopoDS_Edge& edge = TopoDS::Edge(each.Current());
    if (!bounds_material(edge)) continue;
    double first = 0, last = 0;
    const Handle(Geom2d_Curve) curve = BRep_Tool::CurveOnSurface(edge, forward, first, last);
    if (curve.IsNull() || !(last > first)) continue;
    integrator.add(Geom2dAdaptor_Curve(curve, first, last), edge.Orientation() == TopAbs_FORWARD ? 1 : -1);
  }
  return integrator.sums();
}

}  // namespace aeroloom::cad
