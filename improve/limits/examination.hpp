/// How far tetrahedra are from the target: quality, least angle, and how many miss it.
#pragma once

#include "improve/improve_report.hpp"
#include "mesh/data/piece.hpp"
#include "mesh/quality/tet_quality.hpp"

#include <array>

namespace aeroloom::improve {

/// Adds tetrahedra to a state, their qualities known.
class Examination {
public:
  explicit Examination(const mesh::TetQuality& measure) : _target(measure.target()) {}
  void add(double quality, const std::array<geometry::Vec3, 4>& p);

  BadState state;

private:
  double _target;
  /// The quality is at most the sine of the smallest angle: above this nothing can lower the least angle.
  double _bound = 2;
};

std::array<geometry::Vec3, 4> points_of(const mesh::Piece& piece, mesh::LocalIndex cell);

/// The quality of a piece's cell.
double quality_of(const mesh::Piece& piece, mesh::LocalIndex cell, const mesh::TetQuality& measure);

BadState examine(const mesh::Piece& piece, const mesh::TetQuality& measure);

}  // namespace aeroloom::improve
