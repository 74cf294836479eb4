/// Scales shapes that are too small or too large for the CAD library. Internal to cad/.
#pragma once

#include "cad/model/named_shape.hpp"

namespace aeroloom::cad {

/// A precision that a file states, in `unit` of the file's. The library writes its own into files of any
/// size: that stays.
double precision_in(double unit, double stated);

/// The shape with its labels in `unit` of the file's, a power of two: numbers keep their digits. Tolerances
/// are the library's where they are no larger in the file. The library's own scaling fails where parameters
/// are lengths below its precision.
NamedShape scaled(NamedShape named, double unit);

}  // namespace aeroloom::cad
