/// The files that a run leaves.
#pragma once

#include "mesh/data/distributed_mesh.hpp"
#include "parallel/communication/communicator.hpp"
#include "pipeline/case/case.hpp"

#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace aeroloom::pipeline {

/// Writes the volume as `mesh` with its extension to the output directory, in all formats of the case one
/// after another, each streamed from the pieces; OpenFOAM's case gets a folder `openfoam`. With VTK files:
/// surface.pvtp, the boundary of the domain, and interfaces.pvtp with what lies between regions where there
/// is any, of `surface`, or else of the volume. All appear together, or none does. Collective; throws
/// CollectiveError.
void write_outputs(const mesh::NumberedMesh& volume, const mesh::NumberedMesh* surface,
                   const cases::OutputOptions& output);

/// Files of meshes as runs name them, of any format, that are in the output directory now. Rank 0 calls it.
class EarlierFiles {
public:
  explicit EarlierFiles(const cases::OutputOptions& output);
  /// Files that are still as they were, and not of a mesh with this hash as far as the report beside them
  /// tells: not of this run.
  std::vector<std::string> left(const std::string& hash = {}) const;

private:
  std::string _hash;                 // of the mesh that the report beside them tells of
  std::set<std::string> _of_others;  // that it names as older
  std::vector<std::pair<std::filesystem::path, std::filesystem::file_time_type>> _files;
};

bool wants_vtk(const cases::OutputOptions& output);
/// Where the mesh is in this format.
std::string path_of(const cases::OutputOptions& output, io::FileFormat format);

}  // namespace aeroloom::pipeline
