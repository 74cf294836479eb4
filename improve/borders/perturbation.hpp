/// Random perturbation of vertices, to give local improvement another start.
#pragma once

#include "mesh/data/piece.hpp"

#include <cstdint>

namespace aeroloom::improve {

/// Moves each interior vertex that is not shared by up to `fraction` of its shortest edge along each axis.
/// Moves that would invert a tetrahedron are left out. Random numbers come from a hash of seed, vertex and
/// axis, so equal seeds give equal moves.
void perturb(mesh::Piece& piece, double fraction, std::uint64_t seed);

}  // namespace aeroloom::improve
