/// Smoothing for the average where pieces meet: mean_ratio_smoothing.hpp for the vertices that several pieces
/// know.
#pragma once

#include "mesh/data/distributed_mesh.hpp"
#include "mesh/exchange/shared_vertices.hpp"
#include "mesh/quality/tet_quality.hpp"

#include <cstdint>

namespace aeroloom::improve {

/// Moves vertices inside the volume that pieces share, as MeanRatioSmoothing moves the others: along the
/// gradient of the sum of inverse mean ratios around them, where the mean ratio is below
/// MeanRatioSmoothing::good_enough on average, and so that the worst TetQuality around a vertex does not
/// fall. No cell changes its piece: each piece adds up what it knows of a vertex's tetrahedra, and the sums
/// are added in the order of pieces, so the result does not depend on the ranks. Vertices move in two groups,
/// chosen by their names, each at once (Jacobi); those of a tetrahedron that would fall below what each of
/// them allows stay. `passes` is how often each group moves. `shared` are those of the mesh, and stay so.
/// Returns the number of moves in the whole mesh. Collective.
std::int64_t smooth_borders(mesh::DistributedMesh& mesh, const mesh::SharedVertices& shared,
                            const mesh::TetQuality& measure, int passes);

}  // namespace aeroloom::improve
