#include "improve/limits/examination.hpp"

#include "mesh/quality/quality.hpp"

#include <cmath>
#include <numbers>

namespace aeroloom::improve {

using mesh::LocalIndex;
using mesh::Piece;

std::array<geometry::Vec3, 4> points_of(const Piece& piece, LocalIndex cell) {
  const LocalIndex* c = piece.cell(cell);
  return {piece.point(c[0]), piece.point(c[1]), piece.point(c[2]), piece.point(c[3])};
}

double quality_of(const Piece& piece, LocalIndex cell, const mesh::TetQuality& measure) {
  const auto p = points_of(piece, cell);
  return measure(p[0], p[1], p[2], p[3]);
}

void Examination::add(double quality, const std::array<geometry::Vec3, 4>& p) {
  state.bad += quality < _target;
  if (quality > _bound) return;
  const double angle = mesh::dihedral_range(p[0], p[1], p[2], p[3]).smallest;
  if (angle >= state.least_angle) return;
  state.least_angle = angle;
  constexpr double rounding = 1e-9;  // of a quality against the sine of the angle that it is
  _bound = std::sin(angle * std::numbers::pi / 180) + rounding;
}

BadState examine(const Piece& piece, const mesh::TetQuality& measure) {
  Examination examination(measure);
  for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
    const auto p = points_of(piece, t);
    examination.add(measure(p[0], p[1], p[2], p[3]), p);
  }
  return examination.state;
}

}  // namespace aeroloom::improve
