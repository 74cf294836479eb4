/// Another start for local improvement: vertices thrown a little at random.
#pragma once

#include "mesh/data/piece.hpp"

#include <cstdint>

namespace aeroloom::improve {

/// Moves the vertices inside that are not shared, each along every axis by up to `fraction` of its shortest
/// edge, or not at all where that would invert a tetrahedron. Numbers come from a hash of `seed`, vertex and
/// axis: the same seed moves the same piece in the same way.
void perturb(mesh::Piece& piece, double fraction, std::uint64_t seed);

}  // namespace aeroloom::improve
