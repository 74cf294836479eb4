/// The classification of vertices on the CAD model.
#pragma once

#include <cstdint>

namespace aeroloom::mesh {

/// The dimension of the CAD entity of least dimension that a vertex lies on. Vertices of meshes from files,
/// which know no CAD model, lie on a face where they are on the boundary, else in a region.
enum class CadDimension : std::int8_t { vertex = 0, edge = 1, face = 2, region = 3 };

/// On a CAD edge, or at a CAD vertex that ends one.
constexpr bool is_on_curve(CadDimension d) {
  return d <= CadDimension::edge;
}
/// On the surface: a face, an edge or a vertex of the CAD model.
constexpr bool is_on_boundary(CadDimension d) {
  return d < CadDimension::region;
}

}  // namespace aeroloom::mesh
