#include "mesh/data/boundary_mesh.hpp"

#include "geometry/runs.hpp"
#include "mesh/data/shared_vertex_keys.hpp"

#include <algorithm>
#include <numeric>

namespace aeroloom::mesh {
namespace {

/// Builds the surface piece of some triangles of a tetrahedral piece.
class SkinPiece {
public:
  SkinPiece(const Piece& volume, const std::vector<GlobalIndex>& names)
      : _volume(volume), _names(names), _local(volume.vertex_count(), -1) {}

  Piece build(PieceId id, std::span<const LocalIndex> triangles) {
    Piece skin;
    skin.id = id;
    skin.kind = CellKind::triangle;
    _used.clear();
    for (const LocalIndex t : triangles) {
      for (int k = 0; k < 3; ++k) {
        const LocalIndex v = _volume.boundary_triangle(t)[k];
        if (_local[v] < 0) {
          _local[v] = static_cast<LocalIndex>(_used.size());
          _used.push_back(v);
        }
        skin.cells.push_back(_local[v]);
      }
      skin.triangle_face.push_back(_volume.triangle_face[t]);
      skin.triangle_patch.push_back(_volume.triangle_patch[t]);
    }
    for (std::size_t i = 0; i < _used.size(); ++i) {
      const LocalIndex v = _used[i];
      const geometry::Vec3 p = _volume.point(v);
      skin.coordinates.insert(skin.coordinates.end(), {p.x, p.y, p.z});
      skin.vertex_dimension.push_back(_volume.vertex_dimension[v]);
      skin.vertex_entity.push_back(_volume.vertex_entity[v]);
      skin.shared_vertices.push_back(static_cast<LocalIndex>(i));
      skin.shared_keys.push_back(running_key(_names[v]));
      _local[v] = -1;
    }
    return skin;
  }

private:
  const Piece& _volume;
  const std::vector<GlobalIndex>& _names;
  std::vector<LocalIndex> _local;  // number in the surface piece
  std::vector<LocalIndex> _used;
};

}  // namespace

std::vector<LocalIndex> triangles_by_face(const Piece& piece) {
  std::vector<LocalIndex> order(piece.boundary_count());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](LocalIndex a, LocalIndex b) {
    return piece.triangle_face[a] < piece.triangle_face[b];
  });
  return order;
}

DistributedMesh boundary_mesh(const NumberedMesh& volume) {
  const parallel::Communicator& communicator = volume.communicator;
  DistributedMesh surface(communicator);
  surface.kind = CellKind::triangle;
  surface.patches = volume.patches;
  surface.faces = volume.faces;
  surface.sides = volume.sides;
  surface.regions = volume.regions;
  std::vector<PieceId> owners;  // the tetrahedral piece of each surface piece
  for (std::size_t i = 0; i < volume.pieces.size(); ++i) {
    const Piece& piece = volume.pieces[i];
    const std::vector<LocalIndex> order = triangles_by_face(piece);
    SkinPiece skin(piece, volume.numbering.vertices[i]);
    const auto same_face = [&](LocalIndex a, LocalIndex b) {
      return piece.triangle_face[a] == piece.triangle_face[b];
    };
    geometry::for_each_run(
        std::span<const LocalIndex>(order), same_face, [&](std::size_t begin, std::size_t end) {
          surface.pieces.push_back(skin.build(0, std::span(order).subspan(begin, end - begin)));
          owners.push_back(piece.id);
        });
  }
  // Ids run by tetrahedral piece, then by face.
  std::vector<PieceId> all = communicator.gather_sorted(owners);
  surface.piece_count = static_cast<PieceId>(all.size());
  for (std::size_t i = 0, run = 0; i < owners.size(); ++i) {
    run = i > 0 && owners[i] == owners[i - 1] ? run + 1 : 0;
    const auto first = std::lower_bound(all.begin(), all.end(), owners[i]) - all.begin();
    surface.pieces[i].id = static_cast<PieceId>(first + static_cast<std::ptrdiff_t>(run));
  }
  return surface;
}

DistributedMesh part_of_surface(const DistributedMesh& surface, SurfacePart which) {
  DistributedMesh part = surface;
  for (Piece& piece : part.pieces) {
    const bool is_inner = surface.sides_of(piece.common_face()).is_inner();
    if (is_inner == (which == SurfacePart::between_regions)) continue;
    Piece empty;
    empty.id = piece.id;
    empty.kind = piece.kind;
    piece = std::move(empty);
  }
  return part;
}

}  // namespace aeroloom::mesh
