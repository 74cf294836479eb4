/// Planar faces meshed again within boundaries that have moved: planes of symmetry, slip walls, inlets and
/// outlets behind boundary layers.
#pragma once

#include "cad/model/model.hpp"
#include "mesh/data/distributed_mesh.hpp"
#include "sizing/field/size_field.hpp"
#include "surface/surface_error.hpp"
#include "surface/surface_options.hpp"

#include <string>
#include <vector>

namespace aeroloom::surface {

struct PlanesToRemesh {
  std::vector<cad::FaceId> faces;  ///< planar ones, ascending, the same on every rank
  SurfaceOptions options = {};     ///< those that the surface was meshed with
};

/// The vertices to blame where planes cannot be meshed again, by name, ascending; the same on every rank.
struct PlaneConflicts {
  std::vector<mesh::SharedVertexKey> vertices;
  std::string message;  ///< about the first plane; empty: none
  bool empty() const { return vertices.empty(); }
};

/// Meshes planar faces of a surface anew under the field. Their boundaries are those that their pieces have:
/// vertices on curves may have moved within the plane (on an axis-aligned one they have its coordinate
/// exactly); what lies inside does not matter. Vertices on curves keep their names, places and, where other
/// pieces know them, the classification that they have there. Only on curves that no other faces have, and
/// whose ends have moved, do they find new places (surface/curves/free_curves.hpp).
///
/// Pieces of other faces stay what they are, keep their order, and come first; the new ones follow, by face,
/// then as the face was cut. Where boundaries cross or touch themselves or each other, the surface stays as
/// it was, and the vertices of the edges at fault are returned: those of them that moved must move less.
///
/// Collective. Throws SurfaceError or CollectiveError, the same on all ranks.
PlaneConflicts remesh_planes(const cad::Model& model, const sizing::SizeField& field,
                             const PlanesToRemesh& planes, mesh::DistributedMesh& surface);

}  // namespace aeroloom::surface
