/// A surface mesh with its sizes: what surface meshing returns and volume meshing starts from.
#pragma once

#include "mesh/data/distributed_mesh.hpp"
#include "sizing/field/size_field.hpp"

namespace aeroloom::sizing {

/// A surface mesh, its global numbers, and the size field that the volume follows.
struct SizedSurface : mesh::NumberedMesh {
  SizeField field;
};

}  // namespace aeroloom::sizing
