/// Smoothing for the average where pieces meet: relaxation.hpp for the vertices that several pieces know.
#pragma once

#include "improve/tet_quality.hpp"
#include "mesh/distributed_mesh.hpp"
#include "mesh/shared_vertices.hpp"
#include "parallel/communicator.hpp"

#include <cstdint>

namespace aeroloom::improve {

/// Moves vertices inside the volume that pieces share, as Relaxation moves the others: along the gradient of
/// the sum of inverse mean ratios around them, where the mean ratio is below Relaxation::good_enough on
/// average, and so that the worst TetQuality around a vertex does not fall. No cell changes its piece: each
/// piece adds up what it knows of a vertex's tetrahedra, and the sums are added in the order of pieces, so
/// the result does not depend on the ranks. Vertices move in two groups, chosen by their names, each at once
/// (Jacobi); those of a tetrahedron that would fall below what each of them allows stay. `passes` is how
/// often each group moves. `shared` are those of the mesh, and stay so. Returns the number of moves in the
/// whole mesh. Collective.
std::int64_t relax_borders(const parallel::Communicator& communicator, mesh::DistributedMesh& mesh,
                           const mesh::SharedVertices& shared, const TetQuality& measure, int passes);

}  // namespace aeroloom::improve
