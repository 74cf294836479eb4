/// Curves of a background mesh: a subset of the vertices of the fine curves.
#pragma once

#include "geometry/model.hpp"
#include "surface/curves.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::surface {

/// The curves of one face, coarsened. Other curves of the model have no interior vertices here.
struct CoarseCurves {
  CurveMesh curves;
  std::vector<CurveVertex> fine_vertex;  ///< per vertex of `curves`: the same one of the fine curves
};

/// Keeps vertices so that segments are about `factor` fine ones long and turn by at most `largest_turn`
/// radians as far as the fine ones allow it, and no fewer than a conforming triangulation needs.
CoarseCurves coarsen_curves(const geometry::Model& model, const CurveMesh& fine, geometry::FaceId face,
                            double factor, double largest_turn);

/// The fine vertices between the ends of coarse segments.
class FineSegments {
public:
  FineSegments(const geometry::Model& model, const CurveMesh& fine, const CoarseCurves& coarse,
               geometry::FaceId face);
  /// The fine vertices strictly between two neighbouring vertices of a coarse curve (fine numbers), from the
  /// first to the second. Empty where the segment is a fine one, or none at all.
  std::vector<CurveVertex> between(CurveVertex first, CurveVertex second) const;

private:
  struct Segment {
    CurveVertex low, high;  // ends
    std::int32_t begin, end;  // of _interior; from low to high
  };
  std::vector<Segment> _segments;  // by ends
  std::vector<CurveVertex> _interior;
};

}  // namespace aeroloom::surface
