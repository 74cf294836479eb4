/// What a level asks for on a model's lifting bodies.
#pragma once

#include "sizing/choice/choose_sizes.hpp"
#include "sizing/choice/levels.hpp"
#include "sizing/lifting/lifting.hpp"
#include "sizing/sources/size_demands.hpp"

#include <vector>

namespace aeroloom::sizing {

/// Along leading and trailing edges the level's share of the local chord; on a blunt trailing edge its width
/// over the cells across, if that is less; where the skin meets other faces, at roots and tips, the share of
/// the semispan; in the wake, a surface behind each trailing edge along the flow, the share that walls have
/// of the reference chord, but of the local one.
std::vector<SizeLine> level_lines(const cad::Model& model, const LiftingBodies& bodies,
                                  const LevelSizes& level, geometry::Vec3 flow);

/// The same at each point of a trailing edge.
std::vector<double> trailing_sizes(const LiftingElement& element, const LevelSizes& level);

/// Bounds for all the rest: walls by the reference chord; the smallest size along edges for curvature and
/// features; growth and curvature angle of the level; in the far field a share of the domain.
GivenSizes level_bounds(const cad::Model& model, const LiftingBodies& bodies, const LevelSizes& level);

}  // namespace aeroloom::sizing
