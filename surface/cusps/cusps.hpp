/// Cusps of CAD faces between two curves that leave a CAD vertex along each other.
///
/// Where a round runs out on an edge, or a cylinder touches a plane, a face ends in a cusp whose sides are
/// tangent to each other. Triangles there have angles of hundredths of a degree, the smaller the finer the
/// mesh, and no tetrahedra of use stand on them. As far as the two curves are nearer to each other than
/// triangles on a curved face are to their surface, the cusp is closed: vertices that face each other become
/// one, half-way, the triangles between them vanish, and the faces on either side meet.
#pragma once

#include "cad/model/model.hpp"
#include "mesh/data/distributed_mesh.hpp"
#include "surface/curves/curves.hpp"
#include "surface/surface_report.hpp"

#include <vector>

namespace aeroloom::surface {

/// Vertices with the same number from the CAD vertex on become one where the two curves are apart by less
/// than this fraction of the segments beside them, and they themselves by less than that. So triangles on
/// either side keep their shape. Chosen, not measured.
inline constexpr double closing_width = 0.3;

/// Closes the cusps of the surface that the pieces, as the pool assembles them, make on these curves, as far
/// as the curves are apart by less than `widest`. A vertex on several curves counts as part of the CAD
/// vertex. A cusp stays that has vertices between its curves, or whose curves other faces join. By
/// face, the same on every rank. Collective.
std::vector<ClosedCusp> close_cusps(const cad::Model& model, const CurveMesh& curves, double widest,
                                    mesh::DistributedMesh& surface);

}  // namespace aeroloom::surface
