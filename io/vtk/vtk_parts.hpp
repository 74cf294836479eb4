/// How a mesh becomes part files: fixed groups of consecutive parts, written by all ranks (file_plan.hpp).
#pragma once

#include "io/file_mesh.hpp"
#include "parallel/communication/communicator.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace aeroloom::io {

/// One part as a writer needs it: views of a part that lives here, or of one that was brought, without
/// `owned`. The surface of a DistributedMesh comes as faces without runs.
struct PartPiece {
  FilePart part;
  std::span<const std::int32_t> triangle_face;   ///< (k) of such a surface, else empty
  std::span<const std::int32_t> triangle_patch;  ///< (k) of such a surface, else empty
};

/// The parts on this rank.
std::vector<PartPiece> pieces_of(const FileMesh& mesh);

/// The items of a part that go into the files.
enum class PartContent { cells, faces };

/// Number of a point within its file.
using PointIndex = std::int32_t;

/// The points of a file: those its cells (or faces) use, each once, in the order of parts and of their
/// vertices.
struct PartPoints {
  std::vector<mesh::GlobalIndex> numbers;
  std::vector<double> coordinates;                ///< (n,3)
  std::vector<std::vector<PointIndex>> of_piece;  ///< per part of the file, per local vertex; -1 unused
};
PartPoints merge_points(const std::vector<PartPiece>& pieces, PartContent content);

/// The files of one mesh.
struct PartFiles {
  parallel::Communicator communicator;  ///< of the ranks that write them
  std::string directory;                ///< of the index
  std::string name;                     ///< of the index, and of the folder of the parts
  std::string index_extension;          ///< "pvtu"
  std::string part_extension;           ///< "vtu"

  std::string index_path() const;
  /// Relative to the index.
  std::string part_source(std::size_t part) const;
  std::vector<std::string> part_sources(std::size_t parts) const;
  std::string part_path(std::size_t part) const;
};

/// Writes one file to `path`; throws when it cannot.
using PartWriter = std::function<void(const std::vector<PartPiece>& pieces, const std::string& path)>;

/// Makes the folders, removes index and parts of an earlier run, and writes the files: consecutive parts
/// together until they have `items_per_file` cells (or faces), as plan_files() says. Only parts that live
/// elsewhere travel, in rounds. `mine` are the parts on this rank, ascending; ids run from 0 over all ranks.
/// Returns the number of files. Collective; throws CollectiveError when anything cannot be written.
std::size_t write_parts(std::span<const PartPiece> mine, PartContent content,
                        mesh::GlobalIndex items_per_file, const PartFiles& files, const PartWriter& write);

/// Writes the index, a small text, on rank 0, whole or not at all. Collective; throws CollectiveError when it
/// cannot be written.
void write_index(const PartFiles& files, const std::string& text);

}  // namespace aeroloom::io
