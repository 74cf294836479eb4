/// Curves that one face passes on both sides. Seen by this folder only.
#pragma once

#include "cad/faceted/facet_complex.hpp"

namespace aeroloom::cad {

/// Divides faces so that none has both sides of a curve: each triangle joins the side that is nearer over the
/// face, so that the division goes on from where a curve ends inside. The parts keep names and regions.
/// Triangles come out sorted by face. Throws CadError where that does not separate them.
void divide_at_sharp_seams(FacetComplex& complex);

}  // namespace aeroloom::cad
