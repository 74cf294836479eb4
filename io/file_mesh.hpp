/// The layout of a distributed mesh in files: what all writers use.
///
/// Each piece of the mesh is a part: a subdomain in the file. Its cells are ordered by region, and its
/// boundary faces by patch. The rank that holds a piece writes its part. The place of every item in a file
/// follows from counts, so no rank gathers the mesh. Files depend on the parts, never on the number of ranks.
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

/// Consecutive cells of one region, or faces of one patch, all of one shape, in a part.
struct Run {
  std::int32_t id = 0;                  ///< region or patch
  mesh::LocalIndex begin = 0, end = 0;  ///< among the items of this shape in the part
  mesh::GlobalIndex before = 0;         ///< number of items of this shape and id in the parts before
};

/// The cells or faces of one shape in a part.
struct Block {
  int corners = 0;
  std::span<const mesh::LocalIndex> connectivity;  ///< (m, corners) vertices of the piece, in its order
  std::vector<Run> runs;                           ///< by ascending id; they cover the block
  mesh::GlobalIndex before = 0;                    ///< number of items of this shape in the parts before
  std::vector<mesh::LocalIndex> order;             ///< (m) index of each item in the piece; empty: the same

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

/// A part: n vertices, cells, and boundary faces of these cells. A face between two regions is in the part of
/// the front region's cell. Each vertex of the mesh has one owner among the parts. Owned vertices have
/// consecutive numbers, which ascend with the id of the part.
struct MeshPart {
  std::int32_t id = 0;
  std::span<const double> coordinates;         ///< (n,3)
  std::span<const mesh::GlobalIndex> numbers;  ///< (n) numbers in the whole mesh, from 0
  std::span<const std::uint8_t> owned;         ///< (n) 1 where this part owns the vertex
  mesh::GlobalIndex first_owned = 0;           ///< number of the first owned vertex
  mesh::LocalIndex owned_count = 0;
  std::array<Block, cell_shape_count> cells;
  std::array<Block, face_shape_count> faces;

  std::span<const std::int16_t> layers;  ///< boundary layer of each cell (mesh::Piece::layers), or empty

  const mesh::Piece* piece = nullptr;  ///< the piece; null for a part that another rank has sent

  mesh::LocalIndex vertex_count() const { return static_cast<mesh::LocalIndex>(numbers.size()); }
  mesh::LocalIndex cell_count() const {
    mesh::LocalIndex count = 0;
    for (const Block& block : cells) count += block.count();
    return count;
  }
  mesh::LocalIndex face_count() const { return faces[0].count() + faces[1].count(); }
  geometry::Vec3 point(mesh::LocalIndex v) const {
    const double* p = coordinates.data() + 3 * static_cast<std::size_t>(v);
    return {p[0], p[1], p[2]};
  }
};

/// The counts of a mesh, or of a file.
struct ShapeCounts {
  mesh::GlobalIndex vertices = 0;
  std::array<mesh::GlobalIndex, face_shape_count> faces{};
  std::array<mesh::GlobalIndex, cell_shape_count> cells{};
};
/// Whether faces of all patches count, or only those on the boundary (not interior).
enum class CountedFaces { all, boundary };

/// The flow that a mesh is for, as settings of solvers beside it need it.
struct FlowReference {
  double reynolds = 0;        ///< of the free stream, over the length; 0: unknown
  double length = 0;          ///< in the unit of the mesh
  std::string unit = {};      ///< of lengths: "mm", ...; empty: unknown
  double unit_in_metres = 1;  ///< 1 where it is unknown
};

/// A mesh as writers see it, and the parts on this rank. Parts are views: no coordinates or cells are copied.
struct FileMesh {
  const mesh::NumberedMesh* pieces = nullptr;      ///< the viewed mesh; must exist unchanged as long as this
  std::shared_ptr<const mesh::NumberedMesh> held;  ///< owns the mesh, or is null

  std::int32_t part_count = 0;         ///< of the whole mesh
  std::vector<MeshPart> parts;         ///< on this rank, by ascending id
  mesh::GlobalIndex vertex_count = 0;  ///< of the whole mesh, as all members below
  std::vector<mesh::Patch> patches;    ///< `interior` if and only if between regions
  std::vector<std::string> regions;    ///< at least one
  FlowReference flow = {};
  bool has_layers = false;  ///< whether any cell belongs to a boundary layer
  std::vector<std::array<mesh::GlobalIndex, cell_shape_count>> region_cells;  ///< by region and shape
  std::vector<std::array<mesh::GlobalIndex, face_shape_count>> patch_faces;   ///< by patch and shape

  const parallel::Communicator& communicator() const { return pieces->communicator; }
  mesh::GlobalIndex cell_count(CellShape shape) const;
  mesh::GlobalIndex cell_count() const;
  /// The faces of patches that are not interior.
  mesh::GlobalIndex boundary_count(FaceShape shape) const;
  ShapeCounts counts(CountedFaces faces) const;
};

/// The layout of a mesh, with a part for each piece. A patch with boundary faces and faces between regions is
/// split; the latter become NAME_interior. `mesh` must outlive the result; the second form keeps the mesh
/// itself. Throws CollectiveError (bug) where arrays of a piece contradict each other, or numbers of owned
/// vertices are not consecutive. Collective.
FileMesh file_mesh_of(const mesh::NumberedMesh& mesh);
FileMesh file_mesh_of(mesh::NumberedMesh&& mesh);

/// The mesh in `parts` parts (mesh/transfer/repartition.hpp). Collective.
FileMesh repartition(const FileMesh& mesh, std::int32_t parts,
                     mesh::PieceRegions regions = mesh::PieceRegions::several);

}  // namespace aeroloom::io
