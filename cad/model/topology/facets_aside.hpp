/// A model of both kinds of faces taken apart and put together. Seen by this folder only.
#pragma once

#include "cad/model/model.hpp"

namespace aeroloom::cad {

/// The faces, edges and vertices of the shape alone. It has the bytes of the whole model.
Model without_facets(const Model& model);

/// A model with closed strips, made of without_facets(before), and behind its faces those of facets of the
/// model before.
Model with_facets_of(const Model& before, const Model& closed);

}  // namespace aeroloom::cad
