#include "cad/faceted/faceted_bytes.hpp"
#include "cad/model/evaluation/face_cache.hpp"
#include "cad/model/model_data.hpp"
#include "cad/model/topology/closed_edges_data.hpp"

#include <memory>
#include <utility>
#include <vector>

namespace aeroloom::cad {

Model without_facets(const Model& model) {
  auto data = std::make_shared<Model::Data>(model.data());
  data->faceted = nullptr;
  data->vertices.resize(data->first_faceted_vertex), data->vertex_snaps.resize(data->first_faceted_vertex);
  data->edges.resize(data->first_faceted_edge), data->edge_snaps.resize(data->first_faceted_edge);
  data->faces.resize(data->first_faceted_face), data->face_snaps.resize(data->first_faceted_face);
  data->far_field.resize(data->first_faceted_face);
  return Model(std::move(data));
}

Model with_facets_of(const Model& before, const Model& closed) {
  auto data = std::make_shared<Model::Data>(closed.data());
  const Model::Data& from = before.data();
  data->faceted = from.faceted;
  std::vector<FaceId> numbers = data->closed->base_faces;
  const auto first = static_cast<FaceId>(data->faces.size());
  number_facets(*data);
  for (FaceId f = first; f < static_cast<FaceId>(data->faces.size()); ++f) {
    const FaceId base = from.first_faceted_face + f - first;
    const Face& as_before = from.faces[base];
    Face& face = data->faces[f];
    face.name = as_before.name, face.number = as_before.number;
    face.part = as_before.part, face.layer = as_before.layer, face.colour = as_before.colour;
    face.patch = patch_number(data->patches, from.patches[as_before.patch]);
    data->far_field.push_back(from.far_field[base]);
    numbers.push_back(base);
  }
  data->cache = std::make_shared<FaceCache>(*from.cache, numbers);
  return Model(std::move(data));
}

}  // namespace aeroloom::cad
