/// Scans of tetrahedra: how many are bad, and the smallest dihedral angle.
#pragma once

#include "improve/improve_report.hpp"
#include "mesh/data/piece.hpp"
#include "mesh/quality/tet_quality.hpp"

#include <array>

namespace aeroloom::improve {

/// Collects the state of tetrahedra whose qualities are known.
class Examination {
public:
  explicit Examination(const mesh::TetQuality& measure) : _target(measure.target()) {}
  void add(double quality, const std::array<geometry::Vec3, 4>& p);

  BadState state;

private:
  double _target;
  /// A quality is at most the sine of the smallest angle. Tetrahedra above this bound cannot lower it.
  double _bound = 2;
};

std::array<geometry::Vec3, 4> points_of(const mesh::Piece& piece, mesh::LocalIndex cell);

/// The quality of a tetrahedron of a piece.
double quality_of(const mesh::Piece& piece, mesh::LocalIndex cell, const mesh::TetQuality& measure);

BadState examine(const mesh::Piece& piece, const mesh::TetQuality& measure);

}  // namespace aeroloom::improve
