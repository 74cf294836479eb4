#include "volume/lattice/lattice.hpp"

#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/timers.hpp"
#include "volume/lattice/fetch_ghosts.hpp"
#include "volume/volume_mesher.hpp"

#include <utility>

namespace aeroloom::volume {

namespace {

/// The Morton keys of the finest cubes that contain the centres of this rank's triangles.
std::vector<std::uint64_t> keys_of(const LatticeFrame& frame, const mesh::DistributedMesh& surface) {
  std::vector<std::uint64_t> keys;
  for (const mesh::Piece& piece : surface.pieces) {
    for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const mesh::LocalIndex* v = piece.cell(t);
      const geometry::Vec3 centre = (1.0 / 3.0) * (piece.point(v[0]) + piece.point(v[1]) + piece.point(v[2]));
      keys.push_back(sizing::morton_key(frame.cell_at(frame.to_grid(centre))));
    }
  }
  return keys;
}

/// Adds ghosts to tree and table.
void add_ghosts(std::vector<GhostBlock> ghosts, LatticeTree& tree, SurfaceTable& table) {
  std::vector<PackedBlock> blocks;
  blocks.reserve(ghosts.size());
  for (const GhostBlock& ghost : ghosts) blocks.push_back(ghost.block);
  for (BlockIndex b = tree.first(); b < tree.last(); ++b)
    ghosts.push_back({tree.packed(b), table.longest_edge[b]});
  tree.add(std::move(blocks));
  table.longest_edge.assign(tree.block_count(), 0);
  for (const GhostBlock& ghost : ghosts)
    table.longest_edge[tree.index(ghost.block.number)] = ghost.longest_edge;
  table.note_levels_met(tree);
}

}  // namespace

Lattice grow_lattice(const VolumeInput& input, const geometry::Box& box) {
  const LatticeFrame frame(input.surface.field, box);
  LatticeTree tree(input.surface.communicator, frame, input.surface.field, box,
                   keys_of(frame, input.surface));
  std::vector<SurfaceTriangle> triangles = deliver_surface(frame, tree, input.surface);
  const parallel::ScopedCpu task(parallel::ScopedCpu::As::task);
  SurfaceTable table = tabulate_surface(frame, tree, triangles);
  Lattice lattice{input.surface.field,
                  input.options,
                  frame,
                  std::move(tree),
                  std::move(table),
                  std::move(triangles),
                  input.surface.numbering.vertex_count,
                  {},
                  {}};
  std::vector<GhostBlock> ghosts = fetch_ghosts(lattice);
  const std::vector<GhostBlock> finer = fetch_finer_ghosts(lattice);
  ghosts.insert(ghosts.end(), finer.begin(), finer.end());
  if (lattice.tree.communicator().size() > 1) add_ghosts(std::move(ghosts), lattice.tree, lattice.table);
  return lattice;
}

std::unique_ptr<const LocalSurface> gather_local_surface(const Lattice& lattice) {
  const std::vector<SurfaceTriangle> near =
      add_ghost_triangles(lattice.frame, lattice.tree, lattice.radii, lattice.triangles);
  std::unique_ptr<const LocalSurface> surface;
  parallel::collectively(lattice.tree.communicator(), parallel::ScopedCpu::As::task,
                         [&] { surface = std::make_unique<LocalSurface>(near); });
  return surface;
}

}  // namespace aeroloom::volume
