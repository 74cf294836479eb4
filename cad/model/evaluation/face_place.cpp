#include "cad/model/evaluation/face_place.hpp"

#include "cad/faceted/faceted_part.hpp"
#include "cad/model/model_data.hpp"
#include "cad/model/occ_guard.hpp"
#include "cad/model/topology/sheets.hpp"

#include <BRepGProp.hxx>
#include <GProp_GProps.hxx>
#include <TopoDS_Face.hxx>

namespace aeroloom::cad {

FacePlace place_of(const TopoDS_Face& face) {
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(face, properties, area_precision);
  const gp_Pnt centre = properties.CentreOfMass();
  return {properties.Mass(), {centre.X(), centre.Y(), centre.Z()}, tight_box(face)};
}

FacePlace Model::face_place(FaceId id) const {
  if (const JoinedModel* joined = _data->joined.get()) {
    FacePlace whole;
    Vec3 moment;
    for (const Sheet& sheet : joined->faces.at(id).sheets) {
      const FacePlace place = joined->base.face_place(sheet.face);
      whole.area += place.area;
      moment = moment + place.area * place.centre;
      whole.box.add(place.box.low);
      whole.box.add(place.box.high);
    }
    whole.centre = 1 / whole.area * moment;
    return whole;
  }
  if (const FacetedPart* part = _data->faceted_face(id))
    return part->face_place(id - _data->first_faceted_face);
  return guarded("looking where " + _data->describe_face(id) + " is",
                 [&] { return place_of(_data->face_evaluators.at(id).shape); });
}

}  // namespace aeroloom::cad
