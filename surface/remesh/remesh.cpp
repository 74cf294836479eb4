#include "surface/remesh/remesh.hpp"

#include "surface/remesh/face_remesher.hpp"

namespace aeroloom::surface {

std::vector<geometry::HalfEdge> open_half_edges(const FaceMesh& mesh) {
  std::vector<geometry::HalfEdge> twins = geometry::match_half_edges(mesh.triangles);
  if (mesh.slits.empty()) return twins;
  for (geometry::HalfEdge h = 0; h < static_cast<geometry::HalfEdge>(twins.size()); ++h) {
    const auto& triangle = mesh.triangles[h / 3];
    if (mesh.is_slit(triangle[h % 3], triangle[geometry::next_half_edge(h) % 3])) twins[h] = -1;
  }
  return twins;
}

void remesh_interior(const cad::Model& model, const sizing::SizeField& field, const Remeshing& options,
                     FaceMesh& mesh) {
  FaceRemesher remesher(model, field, mesh);
  for (int sweep = 0; sweep < options.sweeps; ++sweep) {
    if (options.resizes) {
      remesher.contract_short_edges();
      remesher.divide_long_edges();
    }
    remesher.flip_edges();
    remesher.smooth();
    remesher.flip_edges();
    remesher.end_sweep();
  }
  if (options.resizes) remesher.widen_sharp_triangles();
  remesher.finish();
}

}  // namespace aeroloom::surface
