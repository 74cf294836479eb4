/// How many mesh segments each CAD edge gets.
#pragma once

#include "cad/model/model.hpp"

#include <vector>

namespace aeroloom::surface {

/// Least number of segments of a loop: two segments with the same ends would be one edge of a triangle.
inline constexpr int least_of_loop = 3;
/// Largest number of segments of a curve. So counts cannot overflow before the limit on memory is reported.
inline constexpr double most_segments = 1e8;

/// Measures of a CAD edge that decide on its number of segments.
struct EdgeMeasure {
  cad::EdgeId edge;
  double metric_length;  ///< integral of ds/h
  double length;         ///< estimated
  double chord;          ///< distance between its ends
  double turning;        ///< estimated integral of the curvature, radians
};

/// Segments per CAD edge; 0 where the edge carries no vertices. The number is the metric length, rounded, but
/// at least what a conforming triangulation needs. Of edges between the same two vertices at most one is a
/// single segment. A closed edge has at least three, and so has every loop of a face.
std::vector<int> count_segments(const cad::Model& model, std::vector<EdgeMeasure> measures);

}  // namespace aeroloom::surface
