/// A surface piece before it is meshed.
#pragma once

#include "sizing/field/size_field.hpp"
#include "surface/charts/chart_surface.hpp"

#include <tuple>

namespace aeroloom::surface {

/// Everything a rank needs to mesh a piece besides the model and the sizes.
struct PieceProblem {
  ChartSurface surface;
  FaceVertices vertices;  ///< on the borders of the piece
  double load = 1;        ///< predicted triangles

  static constexpr auto fields() {
    return std::tuple(&PieceProblem::surface, &PieceProblem::vertices, &PieceProblem::load);
  }
};

/// Predicted triangles of a chart surface under a field. Euler's formula gives them from the vertices: those
/// on the loops are known, those inside are the integral of 2/(sqrt(3) h^2) less what belongs to the loops.
double predict_triangles(const ChartSurface& surface, const sizing::SizeField& field);

/// As a bound on work needs it: the integral alone, over parts of facets that are a few sizes large, so that
/// sizes that fall at a few places count as far as they fall.
double integrate_triangles(const ChartSurface& surface, const sizing::SizeField& field);

}  // namespace aeroloom::surface
