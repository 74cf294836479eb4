/// Cuts between charts and between pieces. Each is discretised once, for both of its sides.
#pragma once

#include "sizing/field/size_field.hpp"
#include "surface/charts/chart_surface.hpp"

#include <array>
#include <set>
#include <vector>

namespace aeroloom::surface {

/// Pairs of mesh vertices, the lower first, that a boundary edge joins. No second edge may join such a pair.
using JoinedVertices = std::set<std::array<std::int32_t, 2>>;

/// A triangulation divided into parts. Edges between triangles of different parts are the cuts.
struct CutSurface {
  ChartSurface surface;
  std::vector<std::int32_t> part;  ///< per triangle
};

/// The pairs of an uncut surface: those of its loop edges.
JoinedVertices joined_vertices(const ChartSurface& surface);

/// Places mesh vertices on the cuts and separates the parts. Segments have length 1 in the metric of the
/// field. The vertices are appended to `vertices`, the pairs that the cuts join are added to `joined`. Parts
/// come in the order of their first triangles; each connected component is a part of its own.
std::vector<ChartSurface> discretise_cuts(const cad::Model& model, const sizing::SizeField& field,
                                          CutSurface cut, FaceVertices& vertices, JoinedVertices& joined);

}  // namespace aeroloom::surface
