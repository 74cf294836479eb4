/// Sources on the faces, edges and corners of a model.
#pragma once

#include "cad/model/evaluation/face_corners.hpp"
#include "sizing/field/sources.hpp"

#include <span>
#include <utility>
#include <vector>

namespace aeroloom::sizing {

/// The triangulation of a face that samples and predictions start from.
cad::Facets sampling_facets(const cad::Model& model, cad::FaceId face, bool far_field);

/// Two edges of a face, the lower one first.
using EdgePair = std::pair<cad::EdgeId, cad::EdgeId>;

/// A segment of a line along a narrow region of a face, with the distances to the opposite line at its ends.
struct NarrowSegment {
  geometry::Vec3 first, last;
  double first_width, last_width;  ///< exact only below `reach`
};

/// The narrow regions of a face as segments, none longer than narrow_size(). A region lies between two edges
/// of the face that share no vertex, between parts of one edge, or between two edges that end in a closed
/// corner (is_closed_corner()). Distances of `reach` and more do not count.
std::vector<NarrowSegment> narrow_segments(const cad::Model& model, const cad::Facets& facets,
                                           std::span<const EdgePair> closed_corners,
                                           const SizingOptions& options, double reach);

/// Sources of the narrow regions of a face: the narrow_size() of the distance between their sides. Distances
/// of `reach` and more ask for nothing, nor does a corner as far as it is closed.
std::vector<SizeSource> narrow_sources(const cad::Model& model, const cad::Facets& facets,
                                       std::span<const EdgePair> closed_corners, const SizingOptions& options,
                                       double reach);

/// Whether elements of some size see the corner at less than 30 degrees.
bool may_be_sharp(const cad::Model& model, const cad::FaceCorner& corner);

/// Whether elements of some size see the corner so sharp that it is closed (closed_corners.hpp).
bool is_closed_corner(const cad::Model& model, const cad::FaceCorner& corner);

/// Sources behind a sharp corner of a face. One triangle fills the corner; it is about as large as `reach`,
/// the size there without these sources. Behind it elements must fit between the two edges, down to
/// smallest_feature_size(). A closed corner asks for nothing as far as it is closed.
std::vector<SizeSource> corner_sources(const cad::Model& model, const cad::FaceCorner& corner, double reach,
                                       const SizingOptions& options);

/// Sources along an edge: by its curvature, and one in its middle by its length. The latter keeps elements no
/// larger than the edge, down to smallest_feature_size().
std::vector<SizeSource> edge_sources(const cad::Model& model, cad::EdgeId edge, bool far_field,
                                     const SizingOptions& options);

}  // namespace aeroloom::sizing
