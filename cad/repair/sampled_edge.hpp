/// Edges with sample points, for distances between edges. Internal to cad/repair/.
#pragma once

#include "geometry/vec.hpp"

#include <vector>

#include <BRepAdaptor_Curve.hxx>
#include <TopoDS_Edge.hxx>

namespace aeroloom::cad {

using geometry::Vec3;

/// An edge that has a curve.
class SampledEdge {
public:
  explicit SampledEdge(const TopoDS_Edge& edge);

  struct Foot {
    double parameter = 0, away = 0;
  };

  double first() const { return _curve.FirstParameter(); }
  double last() const { return _curve.LastParameter(); }
  double length() const { return _length; }
  /// The parameter at a fraction of the range.
  double parameter(double fraction) const { return first() + fraction * (last() - first()); }
  Vec3 point(double parameter) const;
  Vec3 tangent(double parameter) const;
  /// The nearest point. If it is farther than `bound`, `away` may be too large.
  Foot nearest(Vec3 point, double bound) const;
  /// The nearest point around a parameter.
  Foot nearest_around(Vec3 point, double parameter) const;

private:
  BRepAdaptor_Curve _curve;
  std::vector<Vec3> _points;  // at equal steps of the parameter
  double _length = 0;
};

}  // namespace aeroloom::cad
