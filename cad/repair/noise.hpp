/// Closes noise: details below a stated tolerance, which would only make bad elements. Internal to cad/.
#pragma once

#include "cad/model/named_shape.hpp"
#include "cad/repair/change.hpp"

namespace aeroloom::cad {

/// The length below which details are noise, in the shape's unit. It is 2e-6 of the diagonal, or twice the
/// precision of the file if that is more. It is at most 1e-5 of the diagonal and a tenth of the smallest
/// size; 0: no size is known.
double noise_tolerance(double diagonal, double precision, double smallest_size);

/// Removes faces narrower than the tolerance and edges shorter than it. The two sides of such a face become
/// one edge; the ends of such an edge become one vertex in their middle. Surfaces do not change, and closed
/// shells stay closed. Details that cannot be closed stay. Every change is appended to `changes`.
/// `smallest_size` is 0 if no size is known.
NamedShape close_noise(NamedShape named, double smallest_size, Changes& changes);

}  // namespace aeroloom::cad
