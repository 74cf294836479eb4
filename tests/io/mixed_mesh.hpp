/// The hand-made mesh of tests/meshes/mixed_mesh.hpp as writers take it.
#pragma once

#include "io/file_mesh.hpp"
#include "tests/meshes/mixed_mesh.hpp"

#include <utility>

namespace aeroloom::io::examples {

using mesh::examples::MixedMesh;
using mesh::examples::WholeCell;
using mesh::examples::WholeFace;

inline FileMesh distribute(const parallel::Communicator& communicator, const MixedMesh& whole, int parts) {
  return file_mesh_of(mesh::number_mesh(mesh::examples::distribute(communicator, whole, parts)));
}

/// The mesh with `squares` along each side.
inline FileMesh mixed_mesh(const parallel::Communicator& communicator, int squares = 4, int parts = 3) {
  return examples::distribute(communicator, MixedMesh(squares, parts), parts);
}

}  // namespace aeroloom::io::examples
