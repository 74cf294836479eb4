/// Volumes of cells and of their neighbours. Internal to io/.
#pragma once

#include "io/face_links.hpp"
#include "io/file_mesh.hpp"

#include <vector>

namespace aeroloom::io {

/// By part of this rank, by cell.
struct NeighbourVolumes {
  std::vector<std::vector<double>> volumes;
  /// The largest ratio to a neighbour at a face, larger over smaller; 0 where there is no neighbour.
  std::vector<std::vector<double>> ratios;
};

/// Collective.
NeighbourVolumes compare_volumes(const parallel::Communicator& communicator, const FileMesh& mesh,
                                 const FaceLinks& links);

/// The corners of a cell; returns how many.
int corners_of_cell(const FilePart& part, CellOfPart cell, geometry::Vec3* corners);

}  // namespace aeroloom::io
