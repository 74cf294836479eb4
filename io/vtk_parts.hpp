/// How a mesh becomes part files: fixed groups of consecutive pieces, each brought to the rank that writes
/// it.
#pragma once

#include "mesh/distributed_mesh.hpp"
#include "parallel/communicator.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace aeroloom::io {

/// What a writer needs of one piece.
struct PartPiece {
  mesh::PieceId id = 0;
  std::int32_t region = 0;
  std::vector<double> coordinates;           ///< (n,3)
  std::vector<mesh::GlobalIndex> numbers;    ///< (n) global vertex numbers
  std::vector<mesh::LocalIndex> cells;       ///< (m,3) or (m,4)
  std::vector<std::int32_t> triangle_face;   ///< (m) of triangles, else empty
  std::vector<std::int32_t> triangle_patch;  ///< (m) of triangles, else empty
};

/// The points of a part: those its cells use, each once, ascending by global number.
struct PartPoints {
  std::vector<mesh::GlobalIndex> numbers;
  std::vector<double> coordinates;                  ///< (n,3)
  std::vector<std::vector<std::int64_t>> of_piece;  ///< per piece of the part, per local vertex; -1 unused
};
PartPoints merge_points(const std::vector<PartPiece>& pieces);

/// The files of one mesh.
struct PartFiles {
  std::string directory;        ///< of the index
  std::string name;             ///< of the index, and of the folder of the parts
  std::string index_extension;  ///< "pvtu"
  std::string part_extension;   ///< "vtu"

  std::string index_path() const;
  /// Relative to the index.
  std::string part_source(std::size_t part) const;
  std::string part_path(std::size_t part) const;
};

/// Writes one part to `path`; throws when it cannot.
using PartWriter = std::function<void(const std::vector<PartPiece>& pieces, const std::string& path)>;

/// Makes the folders, removes index and parts of an earlier run, and writes the parts: part i on rank i
/// modulo the number of ranks, pieces together until they have `cells_per_part` cells. Each rank holds one
/// part at a time. Returns the number of parts. Collective; throws CollectiveError when anything cannot be
/// written.
std::size_t write_parts(const parallel::Communicator& communicator, const mesh::DistributedMesh& mesh,
                        const mesh::Numbering& numbering, mesh::GlobalIndex cells_per_part,
                        const PartFiles& files, const PartWriter& write);

/// Writes a small text file on rank 0. Collective; throws CollectiveError when it cannot be written.
void write_index(const parallel::Communicator& communicator, const std::string& path,
                 const std::string& text);

}  // namespace aeroloom::io
