/// Noise is no feature: what is smaller than one stated tolerance is closed before anything is meshed. Seen
/// by this folder and by domain/.
#pragma once

#include "cad/model/named_shape.hpp"
#include "cad/repair/change.hpp"

namespace aeroloom::cad {

/// The length below which details are noise, in the shape's unit: two millionths of the diagonal, or twice
/// the file's own precision where that is more, at most a hundred thousandth of the diagonal and a tenth of
/// the smallest size asked for (0: none asked for).
double noise_tolerance(double diagonal, double precision, double smallest_size);

/// The shape without faces narrower than the tolerance and edges shorter than that. The sides of such a face
/// become one edge, the ends of such an edge one vertex half-way; surfaces stay as they are. Shells that
/// were closed are so still. `smallest_size`: the smallest size asked for, 0 where none is. What
/// cannot be closed stays. All of it is appended to
/// `changes`.
NamedShape close_noise(NamedShape named, double smallest_size, Changes& changes);

}  // namespace aeroloom::cad
