#include "surface/curves/border_vertices.hpp"

#include "mesh/data/shared_vertex_keys.hpp"

namespace aeroloom::surface {

void classify_border_vertex(cad::FaceId face, mesh::SharedVertexKey vertex_key, mesh::Piece& piece) {
  const cad::EdgeId edge = mesh::edge_of_vertex_key(vertex_key);
  const bool on_cut = mesh::is_cut_vertex_key(vertex_key), on_edge = edge != cad::no_entity;
  piece.vertex_dimension.push_back(on_cut    ? mesh::CadDimension::face
                                   : on_edge ? mesh::CadDimension::edge
                                             : mesh::CadDimension::vertex);
  piece.vertex_entity.push_back(on_cut ? face : on_edge ? edge : static_cast<std::int32_t>(vertex_key));
}

}  // namespace aeroloom::surface
