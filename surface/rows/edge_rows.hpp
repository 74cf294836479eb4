/// Rows of right-angled triangles along CAD edges: what is asked for, and how many each column has.
///
/// The first row is `height` high, each further one `growth` times higher, until a row is as high as the
/// segments of the edge are long. Where segments get shorter, towards ends of the edge and wherever the field
/// asks for it, rows become fewer, one at a time, so that they end in isotropic triangles.
#pragma once

#include "geometry/vec.hpp"
#include "surface/surface_options.hpp"

#include <span>
#include <vector>

namespace aeroloom::surface {

/// The height of a row, from 0 on.
double row_height(const EdgeRows& rows, int row);

/// The height of so many rows together.
double breadth_of(const EdgeRows& rows, int count);

/// How many rows each vertex of a discretised edge has, the same on both sides of the edge. None at its ends;
/// neighbours differ by one at most.
std::vector<int> count_rows(std::span<const geometry::Vec3> vertices, const EdgeRows& rows);

}  // namespace aeroloom::surface
