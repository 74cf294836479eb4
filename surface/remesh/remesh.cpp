#include "surface/remesh/remesh.hpp"

#include "surface/remesh/face_remesher.hpp"

namespace aeroloom::surface {

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
