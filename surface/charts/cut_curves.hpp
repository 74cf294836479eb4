/// The cuts between charts and between pieces: discretised once, for both sides.
#pragma once

#include "sizing/field/size_field.hpp"
#include "surface/charts/chart_surface.hpp"

#include <array>
#include <set>
#include <vector>

namespace aeroloom::surface {

/// Pairs of mesh vertices (lower first) that a boundary edge joins already: no second one may.
using JoinedVertices = std::set<std::array<std::int32_t, 2>>;

/// A chart surface divided into parts. Whoever divided it, the edges between triangles of different parts are
/// cuts.
struct CutSurface {
  ChartSurface surface;
  std::vector<std::int32_t> part;  ///< per triangle
};

/// The pairs that a chart surface's loops join, for a chart surface that is not cut yet.
JoinedVertices joined_vertices(const ChartSurface& surface);

/// Spreads mesh vertices over the cuts so that segments have length 1 in the metric of the field, appends
/// them to `vertices`, and takes the parts asunder. They come in the order of their first triangles, a part
/// in several pieces as several parts. Pairs that cuts join are added to `joined`.
std::vector<ChartSurface> discretise_cuts(const cad::Model& model, const sizing::SizeField& field,
                                          CutSurface cut, FaceVertices& vertices, JoinedVertices& joined);

}  // namespace aeroloom::surface
