/// The sizes that a grid level requests on the lifting bodies of a model.
#pragma once

#include "sizing/choice/choose_sizes.hpp"
#include "sizing/choice/levels.hpp"
#include "sizing/lifting/lifting.hpp"
#include "sizing/sources/size_requests.hpp"

#include <vector>

namespace aeroloom::sizing {

/// Lines with the sizes of a level. Along leading and trailing edges the size is a fraction of the local
/// chord. On a blunt trailing edge it is at most the width over the number of cells across. Where the skin
/// meets other faces, at roots and tips, it is a fraction of the semispan. A wake behind each trailing edge
/// has the size of walls, relative to the local chord.
std::vector<SizeLine> level_lines(const cad::Model& model, const LiftingBodies& bodies,
                                  const LevelSizes& level, geometry::Vec3 flow);

/// The sizes at each point of a trailing edge.
std::vector<double> trailing_sizes(const LiftingElement& element, const LevelSizes& level);

/// The bounds for everything else. The largest size on walls follows from the reference chord. The smallest
/// size along edges is the minimum for curvature and features. Growth and curvature angle are those of the
/// level. The far field has a fraction of the size of the domain.
GivenSizes level_bounds(const cad::Model& model, const LiftingBodies& bodies, const LevelSizes& level);

}  // namespace aeroloom::sizing
