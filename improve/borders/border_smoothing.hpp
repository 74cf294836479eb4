/// Smoothing of the vertices that several pieces share, for better average quality.
#pragma once

#include "mesh/data/distributed_mesh.hpp"
#include "mesh/exchange/shared_vertices.hpp"
#include "mesh/quality/tet_quality.hpp"

#include <cstdint>

namespace aeroloom::improve {

/// Moves the shared interior vertices by the rule of MeanRatioSmoothing, along the gradient of the sum of
/// inverse mean ratios. A vertex moves if the average mean ratio is below MeanRatioSmoothing::good_enough,
/// unless the worst TetQuality around it would fall. Each piece sums over its own tetrahedra at a vertex. The
/// sums are added in the order of pieces, so the result does not depend on ranks. Vertices move in two groups
/// chosen by their keys, each at once (Jacobi). If a tetrahedron would get worse than its moving vertices
/// allow, these stay. `passes`: moves of each group. `shared` must belong to the mesh and stays valid.
/// Returns the number of moves in the whole mesh. Collective.
std::int64_t smooth_borders(mesh::DistributedMesh& mesh, const mesh::SharedVertices& shared,
                            const mesh::TetQuality& measure, int passes);

}  // namespace aeroloom::improve
