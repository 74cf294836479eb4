/// Cells of the distributed fine surface and their rims.
#pragma once

#include "mesh/distributed_mesh.hpp"
#include "parallel/communicator.hpp"
#include "partition/coarse_surface.hpp"
#include "partition/surface_cells.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::pipeline {

/// The cells of the surface pieces on this rank; kept up to date as cells are cut.
class SurfaceCells {
public:
  /// Collective.
  SurfaceCells(const parallel::Communicator& communicator, const mesh::DistributedMesh& surface,
               const mesh::Numbering& numbering, const partition::CellOptions& options);

  /// Cuts the given cells (global numbers, ascending, the same on every rank) in two. Collective.
  void cut(const std::vector<std::int32_t>& cells);

  /// The rims of all cells, on rank 0.
  struct Rims {
    std::vector<partition::RimEdge> edges;
    std::vector<partition::FineVertex> vertices;
    std::vector<partition::Cell> cells;  ///< by id
  };
  /// Collective.
  Rims gather() const;

  /// Global numbers of cells, per local surface piece, per triangle. They run by piece, then by triangle.
  const std::vector<std::vector<std::int32_t>>& cell_of_triangle() const { return _cell; }

private:
  void number();

  const parallel::Communicator& _communicator;
  const mesh::DistributedMesh& _surface;
  const mesh::Numbering& _numbering;
  std::vector<std::vector<std::int32_t>> _local;  // per local piece, per triangle: cells of the piece
  std::vector<std::int32_t> _count;               // cells per local piece
  std::vector<std::vector<std::int32_t>> _cell;
};

}  // namespace aeroloom::pipeline
