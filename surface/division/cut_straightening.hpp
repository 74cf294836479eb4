/// Straightens the borders between the parts of a background mesh before they become cuts.
#pragma once

#include "surface/remesh/remesh.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::surface {

/// Moves free vertices so that borders between parts become straight and meet at even angles. Smooths the
/// other vertices. Triangles stay well shaped, connections do not change. `part`: per triangle. Angles
/// between borders that are below `smallest_angle` (degrees) do not get smaller.
void straighten_cuts(const cad::Model& model, const sizing::SizeField& field,
                     const std::vector<std::int32_t>& part, double smallest_angle, FaceMesh& mesh);

}  // namespace aeroloom::surface
