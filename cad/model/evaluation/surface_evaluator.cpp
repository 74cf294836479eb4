#include "cad/model/evaluation/surface_evaluator.hpp"

#include "cad/model/to_vec.hpp"

#include <algorithm>

#include <GeomConvert.hxx>
#include <Geom_BezierSurface.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <TColStd_Array1OfReal.hxx>

namespace aeroloom::cad {
namespace {

Handle(Geom_BSplineSurface) as_spline(const Handle(Geom_Surface) & surface) {
  const auto trimmed = Handle(Geom_RectangularTrimmedSurface)::DownCast(surface);
  if (!trimmed.IsNull()) return as_spline(trimmed->BasisSurface());
  if (surface->IsKind(STANDARD_TYPE(Geom_BezierSurface)))
    return GeomConvert::SurfaceToBSplineSurface(surface);
  return Handle(Geom_BSplineSurface)::DownCast(surface);
}

std::vector<double> flat_knots(const TColStd_Array1OfReal& sequence) {
  return {sequence.begin(), sequence.end()};
}

}  // namespace

SplineSurface::SplineSurface(const Handle(Geom_BSplineSurface) & original) {
  const auto surface = Handle(Geom_BSplineSurface)::DownCast(original->Copy());
  if (surface->IsUPeriodic()) {
    _u.period = surface->UPeriod();
    surface->SetUNotPeriodic();
  }
  if (surface->IsVPeriodic()) {
    _v.period = surface->VPeriod();
    surface->SetVNotPeriodic();
  }
  _u.degree = surface->UDegree(), _v.degree = surface->VDegree();
  _u.poles = surface->NbUPoles(), _v.poles = surface->NbVPoles();
  _u.knots = flat_knots(surface->UKnotSequence());
  _v.knots = flat_knots(surface->VKnotSequence());
  surface->Bounds(_u.low, _u.high, _v.low, _v.high);
  _rational = surface->IsURational() || surface->IsVRational();
  for (int i = 1; i <= _u.poles; ++i) {
    for (int j = 1; j <= _v.poles; ++j) {
      const double weight = _rational ? surface->Weight(i, j) : 1;
      const gp_Pnt pole = surface->Pole(i, j);
      _poles.insert(_poles.end(), {weight * pole.X(), weight * pole.Y(), weight * pole.Z()});
      if (_rational) _poles.push_back(weight);
    }
  }
}

int SplineSurface::Direction::span(double parameter) const {
  const auto begin = knots.begin() + degree, end = knots.begin() + poles;
  // The last knot at or below the parameter; at the upper end the last span that is not empty.
  const auto above = std::upper_bound(begin + 1, end, parameter);
  auto at = above - 1;
  while (at > begin && *at == *(at + 1)) --at;
  return static_cast<int>(at - knots.begin());
}

void SplineSurface::basis(const Direction& direction, int span, double parameter, int order, Basis& result) {
  const int degree = direction.degree;
  const double* const knots = direction.knots.data() + span;
  // Rows of the triangle of basis functions of growing degree; the last three are kept.
  std::array<std::array<double, max_count>, 3> rows;
  std::array<double, max_count> left, right;
  auto row = [&](int of_degree) -> std::array<double, max_count>& { return rows[of_degree % 3]; };
  row(0)[0] = 1;
  for (int d = 1; d <= degree; ++d) {
    left[d] = parameter - knots[1 - d];
    right[d] = knots[d] - parameter;
    const auto& lower = row(d - 1);
    auto& upper = row(d);
    double saved = 0;
    for (int r = 0; r < d; ++r) {
      const double fraction = lower[r] / (right[r + 1] + left[d - r]);
      upper[r] = saved + right[r + 1] * fraction;
      saved = left[d - r] * fraction;
    }
    upper[d] = saved;
  }
  std::copy_n(row(degree).begin(), degree + 1, result[0].begin());
  // A derivative is a difference of functions one degree lower, divided by the knots they span.
  auto differentiate = [&](const std::array<double, max_count>& lower, int d,
                           std::array<double, max_count>& upper) {
    double before = 0;
    for (int r = 0; r < d; ++r) {
      const double quotient = d * lower[r] / (knots[r + 1] - knots[r + 1 - d]);
      upper[r] = before - quotient;
      before = quotient;
    }
    upper[d] = before;
  };
  if (order >= 1) differentiate(row(degree - 1), degree, result[1]);
  if (order >= 2 && degree >= 2) {
    std::array<double, max_count> first;
    differentiate(row(degree - 2), degree - 1, first);
    differentiate(first, degree, result[2]);
  } else if (order >= 2) {
    result[2].fill(0);
  }
}

template <int order, int width>
SurfaceJet SplineSurface::sum(Vec2 uv) const {
  const int span_u = _u.span(uv.x), span_v = _v.span(uv.y);
  Basis in_u, in_v;
  basis(_u, span_u, uv.x, order, in_u);
  basis(_v, span_v, uv.y, order, in_v);
  const int first_u = span_u - _u.degree, first_v = span_v - _v.degree;
  // Homogeneous sums: S, Su, Sv, Suu, Suv, Svv.
  double sums[6][4] = {};
  for (int i = 0; i <= _u.degree; ++i) {
    double along[order + 1][width] = {};
    const double* pole =
        _poles.data() + static_cast<std::size_t>(width) * ((first_u + i) * _v.poles + first_v);
    for (int j = 0; j <= _v.degree; ++j, pole += width) {
      for (int d = 0; d <= order; ++d) {
        for (int k = 0; k < width; ++k) along[d][k] += in_v[d][j] * pole[k];
      }
    }
    for (int k = 0; k < width; ++k) {
      sums[0][k] += in_u[0][i] * along[0][k];
      if constexpr (order >= 1) {
        sums[1][k] += in_u[1][i] * along[0][k];
        sums[2][k] += in_u[0][i] * along[1][k];
      }
      if constexpr (order >= 2) {
        sums[3][k] += in_u[2][i] * along[0][k];
        sums[4][k] += in_u[1][i] * along[1][k];
        sums[5][k] += in_u[0][i] * along[2][k];
      }
    }
  }
  const auto vec = [&](int which) { return Vec3{sums[which][0], sums[which][1], sums[which][2]}; };
  SurfaceJet jet{vec(0), vec(1), vec(2), vec(3), vec(4), vec(5)};
  if constexpr (width == 4) {
    const auto weight = [&](int which) { return sums[which][3]; };
    const double w = weight(0);
    jet.point = jet.point / w;
    jet.du = (jet.du - weight(1) * jet.point) / w;
    jet.dv = (jet.dv - weight(2) * jet.point) / w;
    jet.duu = (jet.duu - 2 * weight(1) * jet.du - weight(3) * jet.point) / w;
    jet.duv = (jet.duv - weight(1) * jet.dv - weight(2) * jet.du - weight(4) * jet.point) / w;
    jet.dvv = (jet.dvv - 2 * weight(2) * jet.dv - weight(5) * jet.point) / w;
  }
  return jet;
}

SurfaceJet SplineSurface::evaluate(Vec2 uv, int order) const {
  uv = {_u.wrap(uv.x), _v.wrap(uv.y)};
  if (order == 0) return _rational ? sum<0, 4>(uv) : sum<0, 3>(uv);
  if (order == 1) return _rational ? sum<1, 4>(uv) : sum<1, 3>(uv);
  return _rational ? sum<2, 4>(uv) : sum<2, 3>(uv);
}

SurfaceEvaluator::SurfaceEvaluator(const Handle(Geom_Surface) & surface) : _adaptor(surface) {
  const Handle(Geom_BSplineSurface) spline = as_spline(surface);
  if (!spline.IsNull()) _spline.emplace(spline);
}

SurfaceJet SurfaceEvaluator::jet(Vec2 uv, int order) const {
  if (_spline) return _spline->evaluate(uv, order);
  gp_Pnt point;
  gp_Vec du, dv, duu, dvv, duv;
  if (order == 0) {
    point = _adaptor.Value(uv.x, uv.y);
  } else if (order == 1) {
    _adaptor.D1(uv.x, uv.y, point, du, dv);
  } else {
    _adaptor.D2(uv.x, uv.y, point, du, dv, duu, dvv, duv);
  }
  return {to_vec(point.XYZ()), to_vec(du.XYZ()),  to_vec(dv.XYZ()),
          to_vec(duu.XYZ()),   to_vec(duv.XYZ()), to_vec(dvv.XYZ())};
}

}  // namespace aeroloom::cad
