/// The measure that decides every change of the improver.
#pragma once

#include "geometry/predicates.hpp"
#include "geometry/vec.hpp"
#include "mesh/data/piece.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace aeroloom::mesh {

/// Mean length of the six edges of a tetrahedron.
inline double mean_edge(const std::array<geometry::Vec3, 4>& p) {
  double sum = 0;
  for (const auto& [i, k] : mesh::tetrahedron_edges) sum += distance(p[i], p[k]) / 6;
  return sum;
}

/// The biased minimum sine of the dihedral angles (Klingner and Shewchuk, 16th International Meshing
/// Roundtable, 2007, doi:10.1007/978-3-540-75103-8_1): small for small and for large angles alike. The weight
/// of obtuse angles is such that a tetrahedron falls below target() exactly when an angle is below the target
/// angle T or above 180 - 1.5 T. Not positive for flat or inverted tetrahedra.
class TetQuality {
public:
  static constexpr double largest_target = 50;  ///< degrees
  /// `target_angle` in degrees, above 0 and at most largest_target; throws std::invalid_argument otherwise.
  explicit TetQuality(double target_angle) {
    if (!(target_angle > 0 && target_angle <= largest_target)) {
      throw std::invalid_argument("improve: the target angle must lie within (0, 50] degrees");
    }
    const double small = target_angle * std::numbers::pi / 180;
    _target = std::sin(small);
    _full_bias_cosine = std::cos(1.5 * small);
    _bias = 1 - _target / std::sin(1.5 * small);
  }

  double target() const { return _target; }

  double operator()(geometry::Vec3 a, geometry::Vec3 b, geometry::Vec3 c, geometry::Vec3 d) const {
    const geometry::Vec3 ab = b - a, ac = c - a, ad = d - a;
    const geometry::Vec3 na = cross(c - b, d - b), nb = cross(ad, ac), nc = cross(ab, ad), nd = cross(ac, ab);
    const double volume = -dot(nd, ad);
    const double aa = dot(na, na), bb = dot(nb, nb), cc = dot(nc, nc), dd = dot(nd, nd);
    double least = angle_term(dot(na, nb), aa * bb, dot(d - c, d - c));
    least = std::min(least, angle_term(dot(na, nc), aa * cc, dot(d - b, d - b)));
    least = std::min(least, angle_term(dot(na, nd), aa * dd, dot(c - b, c - b)));
    least = std::min(least, angle_term(dot(nb, nc), bb * cc, dot(ad, ad)));
    least = std::min(least, angle_term(dot(nb, nd), bb * dd, dot(ac, ac)));
    least = std::min(least, angle_term(dot(nc, nd), cc * dd, dot(ab, ab)));
    const double value = volume * std::sqrt(least);
    return std::isfinite(value) ? value : -1;
  }

private:
  /// The squared biased sine over the squared volume: from the dot product of the two outward normals, the
  /// product of their squared lengths, and the squared length of the edge between them.
  double angle_term(double normals, double squares, double edge) const {
    const double plain = edge / squares;
    if (normals <= 0) return plain;
    const double weight = 1 - _bias * std::min(1.0, normals / std::sqrt(squares) / _full_bias_cosine);
    return plain * weight * weight;
  }

  double _target, _full_bias_cosine, _bias;
};

}  // namespace aeroloom::mesh
