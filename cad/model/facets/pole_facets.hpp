/// Facets around the poles of a surface. Seen by this folder only.
#pragma once

#include "cad/model/model.hpp"

namespace aeroloom::cad {

/// A pole is one point of space and a line in parameters. The CAD library puts no vertices on that line, so
/// that facets reach the pole at parameters far from their own, and what is interpolated on them lies
/// elsewhere. This gives each facet a vertex of the pole at its own parameters, with facets of no area
/// between them. Where that would turn a facet over in parameters the pole stays as it is. `facets` is
/// counter-clockwise in parameters here.
void spread_poles(const Model& model, FaceId id, Facets& facets);

}  // namespace aeroloom::cad
