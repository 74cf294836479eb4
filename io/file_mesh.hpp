/// The layout of a mesh in files: its pieces as parts, boundary faces by patch, cells by region, and the
/// place of each among all.
///
/// Writers see every mesh this way and never gather it. A part is written by the rank that holds the piece;
/// the place of all it has in a file follows from counts, which every rank knows or finds here. Files depend
/// on the pieces, never on ranks.
#pragma once

#include "geometry/vec.hpp"
#include "mesh/data/distributed_mesh.hpp"
#include "mesh/data/patch.hpp"
#include "mesh/data/shapes.hpp"
#include "mesh/transfer/repartition.hpp"
#include "parallel/communication/communicator.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <tuple>
#include <vector>

namespace aeroloom::io {

using mesh::cell_shape_count;
using mesh::cell_shapes;
using mesh::CellFace;
using mesh::CellShape;
using mesh::corners_of;
using mesh::face_shape_count;
using mesh::face_shapes;
using mesh::faces_of;
using mesh::FaceShape;

/// Consecutive cells of one region, or faces of one patch.
struct Run {
  std::int32_t id = 0;                  ///< of the region or patch
  mesh::LocalIndex begin = 0, end = 0;  ///< in the part, among those of this shape
  mesh::GlobalIndex before = 0;         ///< of this shape and id, in parts of lower id

  static constexpr auto fields() { return std::tuple(&Run::id, &Run::begin, &Run::end, &Run::before); }
};

/// The cells or faces of one shape in a part.
struct Block {
  int corners = 0;
  std::span<const mesh::LocalIndex> connectivity;  ///< (m, corners), vertices of the piece, in its order
  std::vector<Run> runs;                           ///< ascending id, together all of the block
  mesh::GlobalIndex before = 0;                    ///< of this shape, in parts of lower id
  std::vector<mesh::LocalIndex> order;             ///< (m) the place in the piece of each; empty: its own

  mesh::LocalIndex count() const {
    return corners == 0
               ? 0
               : static_cast<mesh::LocalIndex>(connectivity.size() / static_cast<std::size_t>(corners));
  }
  const mesh::LocalIndex* item(mesh::LocalIndex i) const {
    const mesh::LocalIndex at = order.empty() ? i : order[static_cast<std::size_t>(i)];
    return connectivity.data() + static_cast<std::size_t>(at) * static_cast<std::size_t>(corners);
  }
};

/// One part: n vertices, cells, and the boundary faces of these cells (of the front region's cell, of a face
/// between regions). The vertices that it owns have consecutive numbers, in their order; each vertex of
/// the mesh has one owner, and numbers ascend with the id of the owning part.
struct FilePart {
  std::int32_t id = 0;
  std::span<const double> coordinates;         ///< (n,3)
  std::span<const mesh::GlobalIndex> numbers;  ///< (n) of the whole mesh, from 0
  std::span<const std::uint8_t> owned;         ///< (n) 1 where this part owns the vertex
  mesh::GlobalIndex first_owned = 0;           ///< the number of the first vertex that it owns
  mesh::LocalIndex owned_count = 0;
  std::array<Block, cell_shape_count> cells;
  std::array<Block, face_shape_count> faces;

  std::span<const std::int16_t> layers;  ///< of the cells (mesh::Piece::layers), or empty

  const mesh::Piece* piece = nullptr;  ///< what the part looks into; none of what came from another rank

  mesh::LocalIndex vertex_count() const { return static_cast<mesh::LocalIndex>(numbers.size()); }
  mesh::LocalIndex cell_count() const { return cells[0].count() + cells[1].count() + cells[2].count(); }
  mesh::LocalIndex face_count() const { return faces[0].count() + faces[1].count(); }
  geometry::Vec3 point(mesh::LocalIndex v) const {
    const double* p = coordinates.data() + 3 * static_cast<std::size_t>(v);
    return {p[0], p[1], p[2]};
  }
};

/// How much there is of a mesh, or of a file.
struct ShapeCounts {
  mesh::GlobalIndex vertices = 0;
  std::array<mesh::GlobalIndex, face_shape_count> faces{};
  std::array<mesh::GlobalIndex, cell_shape_count> cells{};
};
/// Of all patches, or of those that are not interior.
enum class CountedFaces { all, boundary };

/// The parts of one mesh that are on this rank: views of its pieces, no coordinates or cells are copied.
struct FileMesh {
  const mesh::NumberedMesh* pieces = nullptr;      ///< what the parts look into, and must live on unchanged
  std::shared_ptr<const mesh::NumberedMesh> held;  ///< the same, where nobody else holds it

  std::int32_t part_count = 0;         ///< of the whole mesh
  std::vector<FilePart> parts;         ///< on this rank, ascending id
  mesh::GlobalIndex vertex_count = 0;  ///< of the whole mesh, as all below; the same on every rank
  std::vector<mesh::Patch> patches;    ///< patches between regions are `interior`, and only they
  std::vector<std::string> regions;    ///< one at least
  bool has_layers = false;             ///< whether any cell is of a boundary layer
  std::vector<std::array<mesh::GlobalIndex, cell_shape_count>> region_cells;  ///< by region and shape
  std::vector<std::array<mesh::GlobalIndex, face_shape_count>> patch_faces;   ///< by patch and shape

  mesh::GlobalIndex cell_count(CellShape shape) const;
  mesh::GlobalIndex cell_count() const;
  /// Of patches that are not interior.
  mesh::GlobalIndex boundary_count(FaceShape shape) const;
  mesh::GlobalIndex face_count(FaceShape shape) const;
  ShapeCounts counts(CountedFaces faces) const;
};

/// The layout of a mesh, a part each piece. A patch with faces between regions and others becomes two, the
/// former called NAME_interior. `mesh` must outlive the result, which holds it where it is given away. Throws
/// CollectiveError (bug) where the arrays of a piece do not fit together, or owned vertices are not numbered
/// one after another. Collective.
FileMesh file_mesh_of(const mesh::NumberedMesh& mesh);
FileMesh file_mesh_of(mesh::NumberedMesh&& mesh);

/// A mesh of a file in `parts` parts (mesh/transfer/repartition.hpp). Collective.
FileMesh repartition(const FileMesh& mesh, std::int32_t parts,
                     mesh::PieceRegions regions = mesh::PieceRegions::several);

}  // namespace aeroloom::io
