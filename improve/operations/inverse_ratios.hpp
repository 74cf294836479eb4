/// The sum of the inverse mean ratios around a vertex, as a function of its place: what smoothing for the
/// average lowers.
#pragma once

#include "improve/tets/tet_mesh.hpp"

#include <limits>
#include <vector>

namespace aeroloom::improve {

/// The tetrahedra around a vertex without the vertex itself. The sum of their inverse mean ratios
/// (mesh::mean_ratio) counts the worst most and is convex near its minimum (Freitag and Knupp, Int. J. Numer.
/// Meth. Engng 53, 2002, doi:10.1002/nme.341). All is negated: what is smaller is worse.
class InverseRatios {
public:
  /// The sum where a tetrahedron is not positive: worse than any other.
  static constexpr double invalid = -std::numeric_limits<double>::max();

  void clear() { _cones.clear(); }
  /// Adds the tetrahedron (a, b, c, vertex), positive in VTK's order.
  void add(Vec3 a, Vec3 b, Vec3 c);
  std::size_t size() const { return _cones.size(); }

  /// With the vertex at p.
  double operator()(Vec3 p) const;
  /// The sum with its gradient; invalid ones are left out of the latter.
  double with_gradient(Vec3 p, Vec3& gradient) const;

private:
  struct Cone {
    Vec3 a, sum;     ///< a corner of the face opposite to the vertex, and the sum of the three
    Vec3 normal;     ///< of that face, twice its area long, towards the vertex
    double squares;  ///< of the face's edges and of its corners' places relative to a, summed
  };
  std::vector<Cone> _cones;
};

/// Where a function that is to rise is highest along a line, from its slope at the start and its rise after
/// `step`: that parabola's peak, at most twice the step; the step itself where the function bends upwards.
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
