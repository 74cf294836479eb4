/// The borders between the parts of a background mesh, made straight before they become cuts.
#pragma once

#include "surface/remesh/remesh.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::surface {

/// Moves free vertices so that the borders between the triangles of different parts get straight and meet at
/// even angles, and smooths the others, as long as triangles stay well shaped. Connections stay. `part` per
/// triangle. Angles below `smallest_angle` (degrees) between borders do not get smaller.
void straighten_cuts(const cad::Model& model, const sizing::SizeField& field,
                     const std::vector<std::int32_t>& part, double smallest_angle, FaceMesh& mesh);

}  // namespace aeroloom::surface
