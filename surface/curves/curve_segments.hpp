/// How many segments each CAD edge gets.
#pragma once

#include "cad/model/model.hpp"

#include <tuple>
#include <vector>

namespace aeroloom::surface {

/// Segments of a loop, at least: two between the same two vertices would be one edge of a triangle.
inline constexpr int least_of_loop = 3;
/// Segments of a curve, at most: a count must not overflow before a message says that so many fit in no
/// memory.
inline constexpr double most_segments = 1e8;

/// Measures of a constraining edge that decide how many segments it gets.
struct EdgeMeasure {
  cad::EdgeId edge;
  double metric_length;  ///< integral of ds/h
  double length;         ///< about
  double chord;          ///< distance of its ends
  double turning;        ///< about the integral of the curvature, radians

  static constexpr auto fields() {
    return std::tuple(&EdgeMeasure::edge, &EdgeMeasure::metric_length, &EdgeMeasure::length,
                      &EdgeMeasure::chord, &EdgeMeasure::turning);
  }
};

/// Segments per edge of the model, 0 where it carries no vertices: the metric length rounded, but no fewer
/// than a conforming triangulation needs. Of edges that join the same two vertices at most one is a single
/// segment, a closed edge has three or more, and so has every loop of a face.
std::vector<int> count_segments(const cad::Model& model, std::vector<EdgeMeasure> measures);

}  // namespace aeroloom::surface
