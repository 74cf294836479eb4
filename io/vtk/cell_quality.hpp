/// Quality measures of cells of all shapes, for the cell arrays of files.
#pragma once

#include "geometry/vec.hpp"
#include "io/file_mesh.hpp"

#include <span>

namespace aeroloom::io {

/// The mean ratio: 1 for the regular cell of this shape (all edges equal; a cube), less for others, 0 for
/// flat and negative for inverted cells. Tetrahedra: mesh::mean_ratio. Other shapes: the smallest value of 3
/// det(T)^(2/3) / |T|^2 over the corners with three edges. T maps the edges at the corner of the regular cell
/// to those of this cell (Knupp, Finite Elements in Analysis and Design 39, 2003,
/// doi:10.1016/S0168-874X(02)00070-7). `corners`: in CellShape's order.
double mean_ratio(CellShape shape, std::span<const geometry::Vec3> corners);

/// The smallest dihedral angle (between neighbouring faces) in degrees: mesh::dihedral_range for tetrahedra,
/// mesh/quality/cell_measures.hpp for others.
double smallest_dihedral(CellShape shape, std::span<const geometry::Vec3> corners);

}  // namespace aeroloom::io
