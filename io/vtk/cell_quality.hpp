/// Shape measures of cells of all shapes, as the cell arrays of files show them.
#pragma once

#include "geometry/vec.hpp"
#include "io/file_mesh.hpp"

#include <span>

namespace aeroloom::io {

/// 1 for the regular cell of this shape (all edges equal), less for all others, 0 flat, negative inverted.
/// Tetrahedra: mesh::mean_ratio. Pyramids and prisms: the smallest over the corners where three edges meet of
/// 3 det(T)^(2/3) / |T|^2, where T maps the edges of the regular cell's corner to those of this one; at a
/// regular tetrahedron's corner that is its mean ratio (Knupp, Finite Elements in Analysis and Design 39,
/// 2003, doi:10.1016/S0168-874X(02)00070-7). `corners` in CellShape's order.
double mean_ratio(CellShape shape, std::span<const geometry::Vec3> corners);

/// Smallest angle between neighbouring faces, degrees. Tetrahedra: mesh::dihedral_range; others as in
/// mesh/quality/cell_measures.hpp.
double smallest_dihedral(CellShape shape, std::span<const geometry::Vec3> corners);

}  // namespace aeroloom::io
