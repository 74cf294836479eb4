/// The input for meshing one surface piece.
#pragma once

#include "sizing/field/size_field.hpp"
#include "surface/charts/chart_surface.hpp"

namespace aeroloom::surface {

/// All that a rank needs to mesh a piece, besides the model and the size field.
struct PieceProblem {
  ChartSurface surface;
  FaceVertices vertices;  ///< on the borders of the piece
  double load = 1;        ///< predicted triangles

  double facets() const { return static_cast<double>(surface.triangles.size()); }
};

/// Predicted number of triangles of a surface under a field, by Euler's formula from the number of vertices.
/// Vertices on the loops are known. The number inside is the integral of 2/(sqrt(3) h^2), less what belongs
/// to the loops.
double predict_triangles(const ChartSurface& surface, const sizing::SizeField& field);

/// Number of triangles for bounds on work: the integral alone; long facets are first cut to a few local
/// sizes. So small regions with small sizes count in full.
double integrate_triangles(const ChartSurface& surface, const sizing::SizeField& field);

}  // namespace aeroloom::surface
