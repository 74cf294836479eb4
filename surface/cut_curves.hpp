/// The borders between charts: discretised once, for both sides.
#pragma once

#include "sizing/size_field.hpp"
#include "surface/plane_cut.hpp"

#include <array>
#include <set>
#include <vector>

namespace aeroloom::surface {

/// Pairs of mesh vertices (lower first) that a boundary edge joins already: no second one may.
using JoinedVertices = std::set<std::array<std::int32_t, 2>>;

/// Spreads mesh vertices over the cut so that segments have length 1 in the metric of the field, appends them
/// to `vertices`, and takes the sides apart. The parts come in order of their first triangles.
std::vector<Support> separate_at_cut(const geometry::Model& model, const sizing::SizeField& field,
                                     CutSupport cut, FaceVertices& vertices, JoinedVertices& joined);

}  // namespace aeroloom::surface
