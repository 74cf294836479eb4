/// The sum of inverse mean ratios around a vertex, as a function of its position: the objective of smoothing
/// for average quality.
#pragma once

#include "improve/tets/tet_mesh.hpp"

#include <limits>
#include <vector>

namespace aeroloom::improve {

/// The tetrahedra around a vertex, without the vertex. The sum of their inverse mean ratios
/// (mesh::mean_ratio) weighs the worst most and is convex near its minimum (Freitag and Knupp, Int. J. Numer.
/// Meth. Engng 53, 2002, doi:10.1002/nme.341). Values are negated: smaller is worse.
class InverseRatios {
public:
  /// The value if a tetrahedron is not positive; worse than all others.
  static constexpr double invalid = -std::numeric_limits<double>::max();

  void clear() { _cones.clear(); }
  /// Adds the tetrahedron (a, b, c, vertex), positive in VTK's order.
  void add(Vec3 a, Vec3 b, Vec3 c);
  std::size_t size() const { return _cones.size(); }

  /// The negated sum with the vertex at p.
  double operator()(Vec3 p) const;
  /// The same with its gradient, which leaves out invalid tetrahedra.
  double with_gradient(Vec3 p, Vec3& gradient) const;

private:
  struct Cone {
    Vec3 a, sum;     ///< a corner of the face opposite the vertex, and the sum of its corners
    Vec3 normal;     ///< of that face, with twice its area as length, towards the vertex
    double squares;  ///< squared edges of the face and squared corners relative to a, summed
  };
  std::vector<Cone> _cones;
};

/// The maximum along a line of a function with the given slope at 0 and the given rise after `step`. It is
/// the peak of the parabola, at most at twice the step; the step itself if the parabola opens upwards.
struct Peak {
  double step, rise;
};
inline Peak peak_along(double slope, double step, double rise) {
  const double bend = 2 * (slope * step - rise) / (step * step);
  if (!(bend > 0)) return {step, rise};
  const double at = slope / bend;
  return at < 2 * step ? Peak{at, 0.5 * slope * at} : Peak{2 * step, (slope - bend * step) * 2 * step};
}

}  // namespace aeroloom::improve
