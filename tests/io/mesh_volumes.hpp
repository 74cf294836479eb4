/// Volumes of cells as tests expect them: by the divergence integral over their faces.
#pragma once

#include "io/file_mesh.hpp"
#include "parallel/communication/communicator.hpp"

#include <array>
#include <cstddef>

namespace aeroloom::io::examples {

/// Quadrilaterals count as two triangles.
inline double volume_of(const MeshPart& part, CellShape shape, mesh::LocalIndex cell) {
  const mesh::LocalIndex* v = part.cells[static_cast<std::size_t>(shape)].item(cell);
  const auto p = [&](int k) { return part.point(v[k]) - part.point(v[0]); };
  double volume = 0;
  for (const CellFace& face : faces_of(shape)) {
    volume += dot(p(face[0]), cross(p(face[1]), p(face[2]))) / 6;
    if (face[3] >= 0) volume += dot(p(face[0]), cross(p(face[2]), p(face[3]))) / 6;
  }
  return volume;
}

/// Of all cells of each shape. Collective.
inline std::array<double, cell_shape_count> volumes_of(const FileMesh& mesh) {
  const parallel::Communicator& communicator = mesh.pieces->communicator;
  std::array<double, cell_shape_count> volumes{};
  for (const MeshPart& part : mesh.parts) {
    for (const CellShape shape : cell_shapes) {
      const auto s = static_cast<std::size_t>(shape);
      for (mesh::LocalIndex c = 0; c < part.cells[s].count(); ++c) volumes[s] += volume_of(part, shape, c);
    }
  }
  for (double& volume : volumes) volume = communicator.sum(volume);
  return volumes;
}

}  // namespace aeroloom::io::examples
