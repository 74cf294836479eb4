/// Analytic shapes: small models with known areas, volumes and curvatures.
#pragma once

#include "cad/model/model.hpp"

namespace aeroloom::cad {

enum class PrimitiveKind { box, sphere, cylinder, torus, box_with_sphere };

/// All shapes are centred at the origin, unit "m".
struct PrimitiveDimensions {
  Vec3 box{1, 1, 1};          ///< side lengths
  double radius = 0.25;       ///< sphere, cylinder; of the torus' tube
  double height = 1;          ///< of the cylinder, along z
  double major_radius = 0.5;  ///< of the torus, around z
};

/// A fluid domain of one region. Patches: box "xmin" ... "zmax"; sphere "sphere"; cylinder "side", "bottom"
/// and "top"; torus "torus"; box_with_sphere (the box without the sphere) "farfield", which is far field, and
/// "sphere". Throws CadError for dimensions that make no shape.
Model make_primitive_domain(PrimitiveKind kind, const PrimitiveDimensions& dimensions = {});

}  // namespace aeroloom::cad
