#include "pipeline/region_contacts.hpp"

namespace aeroloom::pipeline {

RegionContacts::RegionContacts(const geometry::Model& model)
    : _vertices(model.vertex_count()), _edges(model.edge_count()), _faces(model.face_count(), 0) {
  for (geometry::FaceId f = 0; f < model.face_count(); ++f) {
    const geometry::Face& face = model.face(f);
    _faces[f] = face.back != geometry::no_entity;
    for (const auto& loop : face.loops) {
      for (const geometry::EdgeUse& use : loop) {
        for (const geometry::RegionId region : {face.front, face.back}) {
          touch(_edges[use.edge], region);
          touch(_vertices[model.edge(use.edge).first], region);
          touch(_vertices[model.edge(use.edge).last], region);
        }
      }
    }
  }
}

bool RegionContacts::shared(std::int8_t dimension, std::int32_t entity) const {
  if (dimension == 0) return _vertices[entity].several;
  if (dimension == 1) return _edges[entity].several;
  return dimension == 2 && _faces[entity];
}

void RegionContacts::touch(Contact& contact, geometry::RegionId region) {
  if (region == geometry::no_entity) return;
  if (contact.first == geometry::no_entity) contact.first = region;
  contact.several = contact.several || contact.first != region;
}

}  // namespace aeroloom::pipeline
