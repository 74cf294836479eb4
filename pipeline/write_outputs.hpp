/// Writes the mesh files of a run.
#pragma once

#include "io/file_mesh.hpp"
#include "mesh/data/distributed_mesh.hpp"
#include "pipeline/case/case.hpp"

#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace aeroloom::pipeline {

/// Writes `mesh` with its extension in each format of the case, streamed from the pieces. OpenFOAM has a
/// folder `openfoam`. With VTK files also surface.pvtp (boundary of the domain) and, if regions share faces,
/// interfaces.pvtp; both from `surface`, or from the volume if that is null. Either all files appear or none.
/// `flow`: for settings of solvers. Collective; throws CollectiveError.
void write_outputs(const mesh::NumberedMesh& volume, const mesh::NumberedMesh* surface,
                   const cases::OutputOptions& output, const io::FlowReference& flow);

/// Throws std::filesystem::filesystem_error where something is in the way of what a run writes, before hours
/// of work: a file named as a folder, a folder named as a file. Rank 0 calls it.
void require_free_places(const cases::OutputOptions& output);

/// Mesh files of any format in the output directory before the run. Used on rank 0.
class EarlierFiles {
public:
  explicit EarlierFiles(const cases::OutputOptions& output);
  /// Files unchanged since then and not part of a mesh with this hash according to the report beside them:
  /// files of other runs.
  std::vector<std::string> left(const std::string& hash = {}) const;

private:
  std::string _hash;                 // of the mesh in the earlier report
  std::set<std::string> _of_others;  // files that the earlier report lists as older
  std::vector<std::pair<std::filesystem::path, std::filesystem::file_time_type>> _files;
};

bool wants_vtk(const cases::OutputOptions& output);
/// Path of the mesh in this format.
std::string path_of(const cases::OutputOptions& output, io::FileFormat format);

}  // namespace aeroloom::pipeline
