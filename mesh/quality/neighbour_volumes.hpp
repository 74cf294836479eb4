/// Volumes of cells and of their neighbours.
#pragma once

#include "mesh/quality/face_links.hpp"

#include <vector>

namespace aeroloom::mesh {

/// By piece of this rank, by cell.
struct NeighbourVolumes {
  std::vector<std::vector<double>> volumes;
  /// The largest ratio to a neighbour at a face, larger over smaller; 0 where there is no neighbour.
  std::vector<std::vector<double>> ratios;
  /// The volume of the largest neighbour over that of the cell; 0 where no neighbour is larger.
  std::vector<std::vector<double>> jumps;
};

/// Collective.
NeighbourVolumes compare_volumes(const DistributedMesh& mesh, const FaceLinks& links);

}  // namespace aeroloom::mesh
