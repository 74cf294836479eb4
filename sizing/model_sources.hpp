/// What a model asks for: sources on its faces and edges.
#pragma once

#include "sizing/sources.hpp"

#include <vector>

namespace aeroloom::sizing {

/// Degrees an element may turn on the far field where curvature_angle asks for less: enough to stay round.
inline constexpr double far_field_angle = 20;
/// Short edges, narrow faces and sharp corners may ask for sizes down to this part of the minimum.
inline constexpr double least_part_of_minimum = 0.05;

/// Whether each face bounds the far field: as the model says or, in a model that flags none, a planar face on
/// the box around everything (the side of a wind tunnel).
std::vector<bool> find_far_field(const geometry::Model& model);

/// The triangulation of a face that samples and predictions start from.
geometry::Facets sampling_facets(const geometry::Model& model, geometry::FaceId face, bool far_field);

/// Sources that cover the face about as densely as the sizes they ask for: curvature, surface_maximum off the
/// far field, and the width where opposite edges come close. Nowhere the maximum or more. Throws CadError.
std::vector<SizeSource> face_sources(const geometry::Model& model, geometry::FaceId face,
                                     const geometry::Facets& facets, bool far_field,
                                     const SizingOptions& options);

/// The part of face_sources that comes from narrow strips: between two edges of the face that share no
/// vertex, elements are at most as large as the distance; down to a small part of the minimum.
std::vector<SizeSource> strip_sources(const geometry::Model& model, const geometry::Facets& facets,
                                      const SizingOptions& options);

/// The part of face_sources that comes from sharp corners: behind the one triangle that fills the corner, as
/// far from it as the minimum, elements fit between the two edges; down to the same part of the minimum.
std::vector<SizeSource> corner_sources(const geometry::Model& model, geometry::FaceId face,
                                       const SizingOptions& options);

/// Sources along the edge: its curvature, and its own length at its middle, so that no edge is shorter than
/// the elements around it; the latter down to a small part of the minimum.
std::vector<SizeSource> edge_sources(const geometry::Model& model, geometry::EdgeId edge, bool far_field,
                                     const SizingOptions& options);

}  // namespace aeroloom::sizing
