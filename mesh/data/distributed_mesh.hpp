/// The distributed mesh: pieces spread over ranks.
#pragma once

#include "mesh/data/patch.hpp"
#include "mesh/data/piece.hpp"
#include "parallel/communication/communicator.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace aeroloom::mesh {

/// The regions on either side of a CAD face: the one its triangles are seen from outside of, and the one
/// beyond, which an inner face alone has. They are the same on a baffle, which lies inside of a region.
struct FaceSides {
  RegionId front = 0, back = no_region;
  bool is_inner() const { return back != no_region; }
};

/// Facts about a mesh that are the same on every rank.
struct MeshFacts {
  CellKind kind = CellKind::tetrahedron;
  PieceId piece_count = 0;             ///< of the whole mesh; ids run from 0
  std::vector<std::string> patches;    ///< names by patch index
  std::vector<PatchType> patch_types;  ///< by patch index; those left out are walls
  std::vector<std::string> faces;      ///< CAD face names by face id
  std::vector<FaceSides> sides;        ///< by face id; empty: all faces bound region 0
  std::vector<std::string> regions;    ///< names by region id; empty: one, unnamed
  std::int32_t cavity_rounds = 0;      ///< that changed the pieces so far (improve/borders/rounds.hpp)
};

/// The pieces of one mesh that live on this rank, and the ranks that have all of them. Data and queries;
/// algorithms are free functions, collective over the ranks of the mesh where they say "Collective.".
struct DistributedMesh : MeshFacts {
  /// Of no ranks: only to be assigned to.
  DistributedMesh() = default;
  explicit DistributedMesh(parallel::Communicator ranks, MeshFacts facts = {})
      : MeshFacts(std::move(facts)), communicator(std::move(ranks)) {}

  parallel::Communicator communicator;  ///< the ranks that have the pieces
  std::vector<Piece> pieces;            ///< on this rank, ascending id

  RegionId region_count() const { return regions.empty() ? 1 : static_cast<RegionId>(regions.size()); }
  FaceSides sides_of(std::int32_t face) const {
    return face >= 0 && static_cast<std::size_t>(face) < sides.size() ? sides[face] : FaceSides{};
  }
  PatchType type_of_patch(std::int32_t patch) const {
    return static_cast<std::size_t>(patch) < patch_types.size() ? patch_types[patch] : PatchType::wall;
  }
  bool has_inner_faces() const {
    return std::any_of(sides.begin(), sides.end(), [](const FaceSides& s) { return s.is_inner(); });
  }
};

/// Global numbers, a function of pieces and shared-vertex keys alone: vertices run by the id of the owning
/// piece (the lowest that knows the vertex), then by local order; cells by piece id, then local order. A mesh
/// from a file may come with the file's numbers instead; those of vertices that a piece owns ascend by one.
struct Numbering {
  std::vector<std::vector<GlobalIndex>>
      vertices;                                  ///< per local piece (order of mesh.pieces), per local vertex
  std::vector<std::vector<std::uint8_t>> owned;  ///< same shape: 1 where this piece owns the vertex
  std::vector<GlobalIndex> first_cell;           ///< per local piece
  GlobalIndex vertex_count = 0, cell_count = 0;  ///< of the whole mesh
};

/// A mesh and its global numbers.
struct NumberedMesh : DistributedMesh {
  Numbering numbering;
};

class SharedVertices;
/// The mesh with global numbers. Pieces that share a shared-vertex key must agree on its coordinates bit for
/// bit; a mismatch throws on all ranks. Collective.
NumberedMesh number_mesh(DistributedMesh mesh);
/// The numbers alone; `shared` are the shared vertices of the mesh (mesh/exchange/shared_vertices.hpp).
Numbering find_numbers(const DistributedMesh& mesh, const SharedVertices& shared);

/// The number of each local piece's first cell, and of all cells. Collective.
void number_cells(const DistributedMesh& mesh, Numbering& numbering);

/// Moves pieces so that piece p lives on rank owner[p]; `owner` is the same on every rank. Collective.
void migrate(DistributedMesh& mesh, const std::vector<parallel::Rank>& owner);

/// Counts of the whole mesh: cells of all shapes, boundary triangles and quadrilaterals of the domain, and
/// those of faces between two regions.
struct MeshCounts {
  GlobalIndex vertices = 0, cells = 0, boundary_triangles = 0, inner_triangles = 0;
  GlobalIndex pyramids = 0, prisms = 0, hexahedra = 0, boundary_quads = 0, inner_quads = 0;

  bool has_other_shapes() const { return pyramids + prisms + hexahedra > 0; }
  /// The cells of a shape.
  GlobalIndex of(CellShape shape) const {
    switch (shape) {
      case CellShape::pyramid:
        return pyramids;
      case CellShape::prism:
        return prisms;
      case CellShape::hexahedron:
        return hexahedra;
      default:
        return cells - pyramids - prisms - hexahedra;
    }
  }
};
/// Collective.
MeshCounts count_mesh(const NumberedMesh& mesh);

/// The 128-bit hash of the mesh as 32 hexadecimal digits: coordinate bits, cells, classification, patches and
/// boundary faces in global numbering, regions. Independent of ranks; flipping any one bit changes it.
/// Collective.
std::string hash_mesh(const NumberedMesh& mesh);

}  // namespace aeroloom::mesh
