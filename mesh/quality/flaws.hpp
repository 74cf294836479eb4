/// What is wrong with cells and faces, on one scale for all shapes, in boundary layers or not.
#pragma once

#include "mesh/data/piece.hpp"
#include "mesh/quality/cell_measures.hpp"

#include <array>
#include <cstdint>
#include <string_view>

namespace aeroloom::mesh {

/// Stretching along a wall is no flaw of a cell of layers; flat in other directions, twisted, and next to
/// cells of another size are flaws.
enum class Flaw : std::uint8_t {
  small_angle,        ///< smallest dihedral angle of a tetrahedron off layers, degrees
  bad_shape,          ///< corner_shape() of a cell of layers
  size_jump,          ///< volume of the largest neighbour over that of the cell
  non_orthogonality,  ///< of a face between two cells, degrees (mesh/quality/face_measures.hpp)
  skewness,           ///< of a face
};
inline constexpr std::size_t flaw_count = 5;
inline constexpr std::array<Flaw, flaw_count> all_flaws = {
    Flaw::small_angle, Flaw::bad_shape, Flaw::size_jump, Flaw::non_orthogonality, Flaw::skewness};
/// As keys of reports have it.
std::string_view name_of(Flaw flaw);

/// A measure of shape that stretching along one side does not change. Tetrahedra: the largest determinant of
/// three unit edges at a corner, 1 with right angles, 0 flat. Pyramids and prisms: Measure::scaled_jacobian.
/// Not positive: inside out.
double corner_shape(CellShape shape, const geometry::Vec3* corners);

/// How bad a value is, on a logarithmic scale: 0 and less is good, 1 and more is poor.
double severity_of(Flaw flaw, double value);

enum class Verdict : std::uint8_t { good, fair, poor };
Verdict verdict_of(double severity);
std::string_view name_of(Verdict verdict);

struct FlawedCell {
  double value = 0;  ///< of the flaw
  double severity = 0;
  GlobalIndex cell = 0;  ///< number in the whole mesh, as WorstCellOfShape::cell
  CellShape shape = CellShape::tetrahedron;
  Flaw flaw = Flaw::small_angle;
  geometry::Vec3 center;  ///< mean of the corners; of a flaw of a face, the centre of the face
};
/// By severity, then by number.
bool is_worse(const FlawedCell& a, const FlawedCell& b);

}  // namespace aeroloom::mesh
