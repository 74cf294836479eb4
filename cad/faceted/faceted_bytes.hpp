/// Writes faceted geometry to a model's bytes and adds it to the model's entities. Internal to cad/faceted/
/// and cad/model/.
#pragma once

#include "cad/faceted/faceted_geometry.hpp"
#include "cad/model/evaluation/face_integrals.hpp"
#include "cad/model/model_bytes.hpp"

#include <memory>

namespace aeroloom::cad {

void put_faceted(const FacetedGeometry* faceted, ByteWriter& writer);  ///< null: no faceted geometry
std::shared_ptr<const FacetedGeometry> get_faceted(ByteReader& reader);

/// Appends the vertices, edges and faces of data.faceted to those of the CAD shape.
void number_facets(Model::Data& data);

/// As integrate_face, but exact.
FaceIntegrals integrate_facets(const FacetedGeometry& faceted, FaceId face, Vec3 reference);

}  // namespace aeroloom::cad
