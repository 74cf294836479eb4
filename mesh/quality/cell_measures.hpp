/// Shape measures of tetrahedra, pyramids, prisms and hexahedra, one cell at a time.
#pragma once

#include "geometry/vec.hpp"
#include "mesh/data/shapes.hpp"

#include <array>
#include <cstdint>
#include <string_view>

namespace aeroloom::mesh {

/// Measures of cells.
enum class Measure : std::uint8_t {
  /// Degrees, between neighbouring faces inside the cell, 0 to 360: over 180 where the cell is folded or
  /// turned inside out. Of quadrilaterals the planes at both ends of the edge count, spanned there by the
  /// edges of the face. Tetrahedra: dihedral_range, flat and inverted ones 0 and 180.
  smallest_dihedral,
  largest_dihedral,
  mean_ratio,    ///< of tetrahedra, mean_ratio()
  radius_ratio,  ///< of tetrahedra, radius_ratio()
  /// Of the other shapes: the smallest determinant of the three unit vectors along the edges at a corner
  /// (Knupp, Ernst, Thompson, Stimpson and Pebay, The Verdict Geometric Quality Library, SAND2007-1751,
  /// doi:10.2172/901967), times 2 / sqrt(3) for prisms, sqrt(2) for pyramids, 1 at most: 1 for equal edges
  /// (at right angles in hexahedra), 0 flat, negative inside out there. A pyramid's apex, where four edges
  /// meet, does not count.
  scaled_jacobian,
  edge_ratio,    ///< longest over shortest edge
  volume_ratio,  ///< over all neighbours at faces: the largest ratio of volumes, larger over smaller
  volume,        ///< of quadrilaterals the bilinear surface counts, so volumes add up
};
inline constexpr std::size_t measure_count = 8;
inline constexpr std::array<Measure, measure_count> all_measures = {
    Measure::smallest_dihedral, Measure::largest_dihedral, Measure::mean_ratio,   Measure::radius_ratio,
    Measure::scaled_jacobian,   Measure::edge_ratio,       Measure::volume_ratio, Measure::volume};
/// As keys of reports have it.
std::string_view name_of(Measure measure);
std::string_view name_of(CellShape shape);

/// Whether there is such a measure of cells of this shape.
inline constexpr bool has_measure(CellShape shape, Measure measure) {
  const bool tetrahedra_alone = measure == Measure::mean_ratio || measure == Measure::radius_ratio;
  return shape == CellShape::tetrahedron ? measure != Measure::scaled_jacobian : !tetrahedra_alone;
}
/// Whether larger values are the worse ones.
inline constexpr bool larger_is_worse(Measure measure) {
  return measure == Measure::largest_dihedral || measure == Measure::edge_ratio ||
         measure == Measure::volume_ratio;
}

/// The value of a ratio that is larger, or that has none because its divisor is not above zero.
inline constexpr double largest_ratio = 1e30;

/// By Measure; those that a shape does not have, and the ratio of volumes, are 0.
using CellValues = std::array<double, measure_count>;

/// The corners are in the order of mesh/data/shapes.hpp. Positive where the cell is not inside out.
double cell_volume(CellShape shape, const geometry::Vec3* corners);
/// Six times the volume of the cone over a bilinear quadrilateral from the origin; positive where it sees the
/// corners counter-clockwise from outside.
double bilinear_cone_volume6(geometry::Vec3 a, geometry::Vec3 b, geometry::Vec3 c, geometry::Vec3 d);
/// Whether the edges of each corner (but a pyramid's apex) span a positive volume, exactly: where they do
/// not, the cell is folded there whatever its volume. Tetrahedra: whether the volume is positive.
bool has_positive_corners(CellShape shape, const geometry::Vec3* corners);
CellValues measure_cell(CellShape shape, const geometry::Vec3* corners);
/// Larger over smaller of two volumes; largest_ratio where one is not above zero.
double volume_ratio(double a, double b);

/// Area of a triangle; of a quadrilateral the mean of both ways to cut it.
double face_area(FaceShape shape, const geometry::Vec3* corners);

}  // namespace aeroloom::mesh
