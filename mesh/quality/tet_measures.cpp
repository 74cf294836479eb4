#include "mesh/quality/tet_measures.hpp"

#include "geometry/angle.hpp"

#include <cmath>

namespace aeroloom::mesh {

using geometry::Vec3;

void TetMeasures::measure(const Piece& piece, LocalIndex first, int count) {
  gather(piece, first, count);
  measure_edges_and_normals();
  for (int i = 0; i < count; ++i) {
    const double volume = volume6[i];
    smallest_dihedral[i] = volume > 0 ? geometry::degrees_per_radian * std::atan2(volume, _highest[i]) : 0;
    largest_dihedral[i] = volume > 0 ? geometry::degrees_per_radian * std::atan2(volume, _lowest[i]) : 180;
    const double root = std::cbrt(volume / 2);
    mean_ratio[i] = _squared_edges[i] > 0 ? 12 * root * std::abs(root) / _squared_edges[i] : 0;
  }
}

void TetMeasures::gather(const Piece& piece, LocalIndex first, int count) {
  for (int i = 0; i < count; ++i) {
    const LocalIndex* v = piece.cell(first + i);
    for (int k = 0; k < 4; ++k) {
      const double* p = piece.coordinates.data() + 3 * static_cast<std::size_t>(v[k]);
      for (int axis = 0; axis < 3; ++axis) _points[k][axis][i] = p[axis];
    }
  }
}

void TetMeasures::measure_edges_and_normals() {
  for (int i = 0; i < most; ++i) {
    const auto corner = [&](int k) { return Vec3{_points[k][0][i], _points[k][1][i], _points[k][2][i]}; };
    const Vec3 a = corner(0), b = corner(1), c = corner(2), d = corner(3);
    const Vec3 ab = b - a, ac = c - a, ad = d - a, bc = c - b, bd = d - b, cd = d - c;
    // Outward normals but for the sign, normal k opposite vertex k.
    const Vec3 na = cross(bc, bd), nb = cross(ad, ac), nc = cross(ab, ad), nd = cross(ac, ab);
    const double aa = dot(ab, ab), bb = dot(ac, ac), cc = dot(ad, ad), dd = dot(bc, bc), ee = dot(bd, bd),
                 ff = dot(cd, cd);
    const double volume = dot(cross(ab, ac), ad);
    const double x[6] = {-dot(nc, nd) / std::sqrt(aa), -dot(nb, nd) / std::sqrt(bb),
                         -dot(nb, nc) / std::sqrt(cc), -dot(na, nd) / std::sqrt(dd),
                         -dot(na, nc) / std::sqrt(ee), -dot(na, nb) / std::sqrt(ff)};
    double lowest = x[0], highest = x[0];
    for (int k = 1; k < 6; ++k) {
      lowest = x[k] < lowest ? x[k] : lowest;
      highest = x[k] > highest ? x[k] : highest;
    }
    const Vec3 center = aa * cross(ac, ad) + bb * cross(ad, ab) + cc * cross(ab, ac);
    const double normals =
        std::sqrt(dot(na, na)) + std::sqrt(dot(nb, nb)) + std::sqrt(dot(nc, nc)) + std::sqrt(dot(nd, nd));
    const double product = normals * std::sqrt(dot(center, center));
    volume6[i] = volume;
    _lowest[i] = lowest;
    _highest[i] = highest;
    _squared_edges[i] = aa + bb + cc + dd + ee + ff;
    const double ratio = 6 * volume * std::abs(volume) / product;
    radius_ratio[i] = product > 0 ? ratio : 0;
  }
}

}  // namespace aeroloom::mesh
