/// The lattice as a rank sees it: all that its points are a function of.
#pragma once

#include "mesh/data/shared_vertex_keys.hpp"
#include "sizing/field/size_field.hpp"
#include "volume/lattice/lattice_frame.hpp"
#include "volume/lattice/lattice_tree.hpp"
#include "volume/lattice/near_surface.hpp"
#include "volume/lattice/surface_near_blocks.hpp"
#include "volume/volume_options.hpp"

#include <memory>
#include <vector>

namespace aeroloom::volume {

struct VolumeInput;

/// A rank's own blocks, the ghosts that these need, and the surface there. Frame, tree and table are the same
/// on every rank as far as it has the blocks. Immutable once it is made. Refers to the field.
struct Lattice {
  const sizing::SizeField& field;
  VolumeOptions options;
  LatticeFrame frame;
  LatticeTree tree;
  SurfaceTable table;
  std::vector<SurfaceTriangle> triangles;  ///< that meet this rank's blocks, by number
  mesh::GlobalIndex surface_vertices = 0;
  SearchRadii radii;                    ///< of this rank's blocks; nothing on one rank
  std::vector<mesh::RegionId> regions;  ///< of this rank's blocks, see find_block_regions

  Leaf leaf_at(geometry::Vec3 place) const {
    const sizing::GridPoint cell = frame.cell_at(frame.to_grid(place));
    const BlockIndex b = tree.block_at(cell);
    return {b, tree.child_at(b, cell)};
  }
  /// Of a point of the lattice, by its running number: behind those of the surface.
  mesh::SharedVertexKey vertex_key(std::int64_t number) const {
    return mesh::running_key(surface_vertices + number);
  }
};

/// Tree, ghosts and table, where `box` holds the surface. Search radii and regions are still to be found.
/// Collective.
Lattice grow_lattice(const VolumeInput& input, const geometry::Box& box);

/// The surface near this rank's blocks, as their points need it: search radii wide. Collective.
std::unique_ptr<const NearSurface> gather_near_surface(const Lattice& lattice);

}  // namespace aeroloom::volume
