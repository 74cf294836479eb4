/// Remeshes planar faces whose boundaries have moved: symmetry planes, slip walls, inlets and outlets beside
/// boundary layers.
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
  std::vector<cad::FaceId> faces;  ///< planar, ascending, the same on every rank
  SurfaceOptions options = {};     ///< as the surface was meshed with
};

/// The vertices that prevent planes from being meshed, by key, ascending; the same on every rank.
struct PlaneConflicts {
  std::vector<mesh::SharedVertexKey> vertices;
  std::string message;  ///< about the first plane; empty: none
  bool empty() const { return vertices.empty(); }
};

/// Meshes planar faces of a surface anew under the field, within the boundaries of their present pieces.
/// Vertices on curves may have moved within the plane; on an axis-aligned plane they have its coordinate
/// exactly. They keep their keys, places, and the classification that other pieces give them. Only on curves
/// that no other face has, and whose ends have moved, are vertices placed anew
/// (surface/curves/free_curves.hpp).
///
/// Pieces of other faces stay the same, keep their order and come first. New pieces follow, by face, then in
/// the order of its division. Where boundaries cross or touch, the surface stays as it was and the vertices
/// of the edges at fault are returned. Those of them that had moved must move less.
///
/// Collective. Throws SurfaceError or CollectiveError, the same on all ranks.
PlaneConflicts remesh_planes(const cad::Model& model, const sizing::SizeField& field,
                             const PlanesToRemesh& planes, mesh::DistributedMesh& surface);

}  // namespace aeroloom::surface
