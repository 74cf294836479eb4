/// Sources on the faces and edges of a model.
#pragma once

#include "cad/model/evaluation/face_corners.hpp"
#include "sizing/field/sources.hpp"

#include <span>
#include <utility>
#include <vector>

namespace aeroloom::sizing {

/// Whether each face bounds the far field: as the model says or, in a model that flags none, a planar face on
/// the box around everything (the side of a wind tunnel).
std::vector<bool> find_far_field(const cad::Model& model);

/// The triangulation of a face that samples and predictions start from.
cad::Facets sampling_facets(const cad::Model& model, cad::FaceId face, bool far_field);

/// Two edges of a face, the lower one first.
using EdgePair = std::pair<cad::EdgeId, cad::EdgeId>;

/// A part of a line along a narrow strip of a face, and the distances to the line opposite at its ends.
struct StripPart {
  geometry::Vec3 first, last;
  double first_width, last_width;  ///< from `reach` on they do not matter
};

/// The narrow strips of a face, part by part, none longer than strip_size(), as strip_sources() looks for
/// them.
std::vector<StripPart> strip_parts(const cad::Model& model, const cad::Facets& facets,
                                   std::span<const EdgePair> closed_corners, const SizingOptions& options,
                                   double reach);

/// Sources of narrow strips of a face: between two edges of the face that share no vertex, between parts of
/// one edge, or between edges that end in a closed corner (is_closed_corner()), elements are at most as large
/// as strip_size() of the nearest distance. Distances from `reach` on ask for nothing, nor does a corner as
/// far as it is closed.
std::vector<SizeSource> strip_sources(const cad::Model& model, const cad::Facets& facets,
                                      std::span<const EdgePair> closed_corners, const SizingOptions& options,
                                      double reach);

/// Whether elements of some size see the corner below 30 degrees.
bool may_be_sharp(const cad::Model& model, const cad::FaceCorner& corner);

/// Whether elements of some size see it so sharp that it is closed (closed_corners.hpp).
bool is_closed_corner(const cad::Model& model, const cad::FaceCorner& corner);

/// Sources behind sharp corners of faces. One triangle fills such a corner, about as large as `reach`, the
/// size at the corner without these sources; behind it elements fit between the two edges, down to
/// smallest_feature_size(). A corner that is closed asks for nothing as far as it is.
std::vector<SizeSource> corner_sources(const cad::Model& model, const cad::FaceCorner& corner, double reach,
                                       const SizingOptions& options);

/// Sources along the edge: its curvature, and its own length at its middle, so that no edge is shorter than
/// the elements around it; the latter down to smallest_feature_size().
std::vector<SizeSource> edge_sources(const cad::Model& model, cad::EdgeId edge, bool far_field,
                                     const SizingOptions& options);

}  // namespace aeroloom::sizing
