/// How a mesh becomes part files: fixed groups of consecutive pieces, each written by the rank that holds
/// most of it.
#pragma once

#include "mesh/distributed_mesh.hpp"
#include "parallel/communicator.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace aeroloom::io {

/// What a writer needs of one piece: arrays of a piece that lives here, or of one that was brought.
struct PartPiece {
  mesh::PieceId id = 0;
  std::int32_t region = 0;
  std::span<const double> coordinates;           ///< (n,3)
  std::span<const mesh::GlobalIndex> numbers;    ///< (n) global vertex numbers
  std::span<const mesh::LocalIndex> cells;       ///< (m,3) or (m,4)
  std::span<const std::int32_t> triangle_face;   ///< (m) of triangles, else empty
  std::span<const std::int32_t> triangle_patch;  ///< (m) of triangles, else empty

  geometry::Vec3 point(mesh::LocalIndex v) const {
    const double* p = coordinates.data() + 3 * static_cast<std::size_t>(v);
    return {p[0], p[1], p[2]};
  }
};

/// Number of a point within its part.
using PartIndex = std::int32_t;

/// The points of a part: those its cells use, each once, in the order of pieces and of their vertices.
struct PartPoints {
  std::vector<mesh::GlobalIndex> numbers;
  std::vector<double> coordinates;               ///< (n,3)
  std::vector<std::vector<PartIndex>> of_piece;  ///< per piece of the part, per local vertex; -1 unused
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

/// Makes the folders, removes index and parts of an earlier run, and writes the parts: consecutive pieces
/// together until they have `cells_per_part` cells, each part by the rank that holds most of its cells.
/// Only pieces that live elsewhere travel, and each rank holds those of one part at a time. Returns the
/// number of parts. Collective; throws CollectiveError when anything cannot be written.
std::size_t write_parts(const parallel::Communicator& communicator, const mesh::DistributedMesh& mesh,
                        const mesh::Numbering& numbering, mesh::GlobalIndex cells_per_part,
                        const PartFiles& files, const PartWriter& write);

/// Writes a small text file on rank 0. Collective; throws CollectiveError when it cannot be written.
void write_index(const parallel::Communicator& communicator, const std::string& path,
                 const std::string& text);

}  // namespace aeroloom::io
