/// Writes a mesh as an index file and several data files. Each holds consecutive parts (file_plan.hpp).
#pragma once

#include "io/file_mesh.hpp"
#include "parallel/communication/communicator.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace aeroloom::io {

/// A part as the writer of a file needs it: views of a part of this rank, or of one that another rank has
/// sent (without `owned`). The triangles of a surface mesh are faces without runs.
struct WrittenPart {
  MeshPart part;
  std::span<const std::int32_t> triangle_face;   ///< (k) of such a surface, else empty
  std::span<const std::int32_t> triangle_patch;  ///< (k) of such a surface, else empty
};

/// The parts on this rank.
std::vector<WrittenPart> parts_of(const FileMesh& mesh);

/// The items of a part that are written.
enum class FileContent { cells, faces };

/// The index of a point in its file.
using PointIndex = std::int32_t;

/// The points that the cells (or faces) of a file use, each once, by part and vertex.
struct FilePoints {
  std::vector<mesh::GlobalIndex> numbers;
  std::vector<double> coordinates;               ///< (n,3)
  std::vector<std::vector<PointIndex>> of_part;  ///< by part of the file and local vertex; -1: not used
};
FilePoints merge_points(const std::vector<WrittenPart>& parts, FileContent content);

/// The files of one mesh: an index, and data files in a folder beside it.
struct IndexedFiles {
  parallel::Communicator communicator;  ///< of the ranks that write them
  std::string directory;                ///< of the index
  std::string name;                     ///< of the index, and of the folder of the data files
  std::string index_extension;          ///< "pvtu"
  std::string file_extension;           ///< "vtu"

  std::string index_path() const;
  /// The path relative to the index.
  std::string file_source(std::size_t file) const;
  std::vector<std::string> file_sources(std::size_t files) const;
  std::string file_path(std::size_t file) const;
};

/// Writes one file to `path`, or throws.
using FileWriter = std::function<void(const std::vector<WrittenPart>& parts, const std::string& path)>;

/// Makes the folders, removes index and data files of an earlier run, and writes the data files as
/// plan_files() distributes the parts. Only parts that the writer lacks are sent, in rounds. `mine`: the
/// parts on this rank, by ascending id; ids run from 0 over all ranks. Returns the number of files.
/// Collective; throws CollectiveError where a file cannot be written.
std::size_t write_files(std::span<const WrittenPart> mine, FileContent content,
                        mesh::GlobalIndex items_per_file, const IndexedFiles& files, const FileWriter& write);

/// Rank 0 writes the index, whole or not at all. Collective; throws CollectiveError where it cannot be
/// written.
void write_index(const IndexedFiles& files, const std::string& text);

}  // namespace aeroloom::io
