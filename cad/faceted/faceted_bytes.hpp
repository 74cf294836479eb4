/// Facets in a model's bytes and among its entities. Seen by this folder and model/ only.
#pragma once

#include "cad/faceted/faceted_geometry.hpp"
#include "cad/model/evaluation/face_integrals.hpp"
#include "cad/model/model_bytes.hpp"

#include <memory>

namespace aeroloom::cad {

void put_faceted(const FacetedGeometry* faceted, ByteWriter& writer);  ///< null: there is none
std::shared_ptr<const FacetedGeometry> get_faceted(ByteReader& reader);

/// Appends the vertices, edges and faces of data.faceted to those of the shape.
void number_facets(Model::Data& data);

/// As integrate_face, exactly.
FaceIntegrals integrate_facets(const FacetedGeometry& faceted, FaceId face, Vec3 reference);

}  // namespace aeroloom::cad
