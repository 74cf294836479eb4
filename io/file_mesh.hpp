/// A mesh as files have it: parts with cells of several shapes, boundary faces by patch, cells by region.
///
/// Writers see every mesh this way and never gather it. A part is written by the rank that holds it; the
/// place of all it has in a file follows from counts, which every rank knows or finds here. Files depend on
/// the parts, never on ranks.
#pragma once

#include "geometry/vec.hpp"
#include "mesh/distributed_mesh.hpp"
#include "mesh/patch.hpp"
#include "parallel/communicator.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <tuple>
#include <vector>

namespace aeroloom::io {

/// Corners in the order that CGNS, Gmsh and Medit share; all have positive volume. Tetrahedron: as in
/// mesh/piece.hpp. Pyramid: base 0, 1, 2, 3 counter-clockwise seen from its apex 4. Prism: triangle 0, 1, 2
/// counter-clockwise seen from the triangle 3, 4, 5 opposite, 3 opposite 0 (VTK has it the other way round,
/// see to_vtk in io/vtk_order.hpp).
enum class CellShape : std::uint8_t { tetrahedron, pyramid, prism };
inline constexpr int cell_shape_count = 3;
inline constexpr std::array<CellShape, cell_shape_count> cell_shapes = {CellShape::tetrahedron,
                                                                        CellShape::pyramid, CellShape::prism};
inline constexpr int corners_of(CellShape shape) {
  return static_cast<int>(shape) + 4;
}

/// Counter-clockwise seen from outside the fluid (from the front region, of faces between two): what a normal
/// out of the fluid sees.
enum class FaceShape : std::uint8_t { triangle, quadrilateral };
inline constexpr int face_shape_count = 2;
inline constexpr std::array<FaceShape, face_shape_count> face_shapes = {FaceShape::triangle,
                                                                        FaceShape::quadrilateral};
inline constexpr int corners_of(FaceShape shape) {
  return static_cast<int>(shape) + 3;
}

/// A face of a cell by its corners, counter-clockwise seen from outside the cell; a triangle's fourth is -1.
using CellFace = std::array<std::int8_t, 4>;
/// The faces of a cell: 4, 5 and 5.
std::span<const CellFace> faces_of(CellShape shape);

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
  std::span<const mesh::LocalIndex> connectivity;  ///< (m, corners), vertices of the part
  std::vector<Run> runs;                           ///< ascending id, together all of the block
  mesh::GlobalIndex before = 0;                    ///< of this shape, in parts of lower id

  mesh::LocalIndex count() const {
    return corners == 0
               ? 0
               : static_cast<mesh::LocalIndex>(connectivity.size() / static_cast<std::size_t>(corners));
  }
  const mesh::LocalIndex* item(mesh::LocalIndex i) const {
    return connectivity.data() + static_cast<std::size_t>(i) * static_cast<std::size_t>(corners);
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

  mesh::LocalIndex vertex_count() const { return static_cast<mesh::LocalIndex>(numbers.size()); }
  mesh::LocalIndex cell_count() const { return cells[0].count() + cells[1].count() + cells[2].count(); }
  mesh::LocalIndex face_count() const { return faces[0].count() + faces[1].count(); }
  geometry::Vec3 point(mesh::LocalIndex v) const {
    const double* p = coordinates.data() + 3 * static_cast<std::size_t>(v);
    return {p[0], p[1], p[2]};
  }
};

/// The arrays behind a part, where they are nobody else's.
struct PartArrays {
  std::vector<double> coordinates;
  std::vector<mesh::GlobalIndex> numbers;
  std::vector<std::uint8_t> owned;
  std::array<std::vector<mesh::LocalIndex>, cell_shape_count> cells;
  std::array<std::vector<std::int32_t>, cell_shape_count> cell_regions;  ///< ascending
  std::array<std::vector<mesh::LocalIndex>, face_shape_count> faces;
  std::array<std::vector<std::int32_t>, face_shape_count> face_patches;  ///< ascending
};

/// The parts of one mesh that are on this rank. Moves, does not copy: parts look into arrays that it holds,
/// or into the mesh it was made from, which must live on unchanged.
struct FileMesh {
  FileMesh() = default;
  FileMesh(FileMesh&&) = default;
  FileMesh& operator=(FileMesh&&) = default;
  FileMesh(const FileMesh&) = delete;
  FileMesh& operator=(const FileMesh&) = delete;
  ~FileMesh() = default;

  std::int32_t part_count = 0;         ///< of the whole mesh
  std::vector<FilePart> parts;         ///< on this rank, ascending id
  mesh::GlobalIndex vertex_count = 0;  ///< of the whole mesh, as all below; the same on every rank
  std::vector<mesh::Patch> patches;    ///< patches between regions are `interior`, and only they
  std::vector<std::string> regions;    ///< one at least
  std::vector<std::array<mesh::GlobalIndex, cell_shape_count>> region_cells;  ///< by region and shape
  std::vector<std::array<mesh::GlobalIndex, face_shape_count>> patch_faces;   ///< by patch and shape
  std::vector<std::unique_ptr<PartArrays>> storage;                           ///< behind the parts

  mesh::GlobalIndex cell_count(CellShape shape) const;
  mesh::GlobalIndex cell_count() const;
  /// Of patches that are not interior.
  mesh::GlobalIndex boundary_count(FaceShape shape) const;
  mesh::GlobalIndex face_count(FaceShape shape) const;
};

/// Views of the pieces of a mesh, one part each; no coordinates or cells are copied. A patch with triangles
/// between regions and others becomes two, the former called NAME_interior. `mesh` and `numbering` must
/// outlive the result. Collective.
FileMesh file_mesh_of(const parallel::Communicator& communicator, const mesh::DistributedMesh& mesh,
                      const mesh::Numbering& numbering);

/// A mesh from arrays: `parts` are those of this rank (ids ascending, each id of 0 .. part_count - 1 on one
/// rank). Finds runs, offsets and totals. Throws CollectiveError (bug) where arrays break what FilePart and
/// PartArrays promise. Collective.
struct OwnedPart {
  std::int32_t id = 0;
  std::unique_ptr<PartArrays> arrays;
};
FileMesh make_file_mesh(const parallel::Communicator& communicator, std::int32_t part_count,
                        std::vector<OwnedPart> parts, std::vector<mesh::Patch> patches,
                        std::vector<std::string> regions);

/// The same mesh in `parts` parts of nearly equal numbers of cells, cut along a space-filling curve (Hilbert,
/// doi:10.1007/BF01199431) through the middles of the cells, whatever parts it had; parts of one region each
/// where `by_region`. Vertices are numbered anew by the lowest part that knows them. Collective; the same for
/// any number of ranks.
FileMesh repartition(const parallel::Communicator& communicator, const FileMesh& mesh, std::int32_t parts,
                     bool by_region = false);

}  // namespace aeroloom::io
