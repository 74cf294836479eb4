/// Cusps of CAD faces: tips between two curves that leave a CAD vertex in one direction.
///
/// A face has a cusp where a fillet runs out on an edge, or where a cylinder touches a plane. Triangles there
/// have angles of hundredths of a degree, smaller for finer meshes, and tetrahedra on them are useless. So
/// the cusp is closed where the two curves are nearer to each other than triangles on a curved face are to
/// their surface. Opposite vertices are merged half-way, the triangles between them are removed, and the
/// faces on either side become neighbours.
#pragma once

#include "cad/model/model.hpp"
#include "mesh/data/distributed_mesh.hpp"
#include "surface/curves/curves.hpp"
#include "surface/surface_report.hpp"

#include <vector>

namespace aeroloom::surface {

/// The i-th vertices of both curves from the CAD vertex are merged where curves and vertices are nearer than
/// this fraction of the segments beside them. So triangles on either side keep their shape. Chosen, not
/// measured.
inline constexpr double closing_width = 0.3;

/// Closes cusps of a surface that was meshed on these curves, where the curves are nearer than `widest`.
/// `surface`: as PiecePool::assemble() makes it. Merged vertices lie on several curves; they are classified
/// on the CAD vertex. A cusp stays open where vertices lie between its curves, or where other faces join
/// these. The result is by face, the same on every rank. Collective.
std::vector<ClosedCusp> close_cusps(const cad::Model& model, const CurveMesh& curves, double widest,
                                    mesh::DistributedMesh& surface);

}  // namespace aeroloom::surface
